// wall_light_args.h -- push constants of the kernels of the pass wall_light. Included by C and GLSL.
#ifndef TYN_WALL_LIGHT_ARGS_H
#define TYN_WALL_LIGHT_ARGS_H
#include "shared.h"

struct wall_light_args {
    tyn_vec3 extent; // of the medium, m
    tyn_uvec3 dims;  // cells
    tyn_uint num_suns;
};

#endif
