// diffusion_args.h -- push constants of the diffusion kernels. Included by C and GLSL.
#ifndef DIFFUSION_ARGS_H
#define DIFFUSION_ARGS_H
#include "shaders/common/shared.h"

struct diffusion_args {
    tyn_uvec3 dims;    // cells
    tyn_uint channels; // stacked along z
    tyn_vec3 tint;     // of the one channel
    float dx;          // edge of a cell, m
    float least;       // what sigma_tr is taken for at least, 1/m
    float omega;       // relax: over-relaxation
    tyn_uint colour;   // relax: cells whose indices have this sum, modulo 2
    tyn_uint lit;      // setup: light comes in from all sides
    tyn_uint first;    // setup: there is no fluence yet
};
TYN_ASSERT_SIZE(diffusion_args, 52);

#endif
