// rooms_args.h -- push constants of the kernels of the pass rooms. Included by C and GLSL.
#include "shaders/common/shared.h"

struct rooms_args {
    tyn_vec3 extent; // of the medium, m
    tyn_uvec3 dims;  // cells
};

#define ROOMS_GROUP 64
