// module.c -- what the module photon brings.
#include <tyndall/extend/plugin.h>
#include "impostor/impostor.h"
#include "impostor_camera/impostor_camera.h"
#include "photon_cache/photon_cache.h"
#include "photon_trace/photon_trace.h"
#include "photon_upsample/photon_upsample.h"
#include "photon_view/photon_view.h"

extern const tyn_method tyn_method_photon;
static const tyn_pass_desc *const passes[] = {&tyn_pass_impostor,
                                              &tyn_pass_impostor_camera,
                                              &tyn_pass_photon_cache,
                                              &tyn_pass_photon_trace,
                                              &tyn_pass_photon_upsample,
                                              &tyn_pass_photon_view,
                                              NULL};
static const tyn_method *const methods[] = {&tyn_method_photon, NULL};
extern const tyn_picture_hook tyn_hook_impostor;
static const tyn_picture_hook *const hooks[] = {&tyn_hook_impostor, NULL};

TYN_PLUGIN("photon", "photons in a coarse cache that is renewed from frame to frame", passes,
           methods, hooks)
