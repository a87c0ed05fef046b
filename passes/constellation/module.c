// module.c -- what the module constellation brings.
#include <tyndall/extend/plugin.h>
#include "constellation/constellation.h"
#include "validity_mask/validity_mask.h"
#include "voxel_distance/voxel_distance.h"

extern const tyn_method tyn_method_constellation;
static const tyn_pass_desc *const passes[] = {&tyn_pass_constellation, &tyn_pass_validity_mask,
                                              &tyn_pass_voxel_distance, NULL};
static const tyn_method *const methods[] = {&tyn_method_constellation, NULL};

TYN_PLUGIN(
    "constellation",
    "one scattering under distant lights that stand for the environment, as published in 2008",
    passes, methods, NULL)
