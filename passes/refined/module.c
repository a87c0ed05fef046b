// module.c -- what the module refined brings.
#include <tyndall/extend/plugin.h>
#include "refine/refine.h"
#include "refine_camera/refine_camera.h"

extern const tyn_method tyn_method_refined;
static const tyn_pass_desc *const passes[] = {&tyn_pass_refine, &tyn_pass_refine_camera, NULL};
static const tyn_method *const methods[] = {&tyn_method_refined, NULL};

TYN_PLUGIN("refined", "pop's picture corrected by a few paths, fitted on its layers", passes,
           methods, NULL)
