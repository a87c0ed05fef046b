// walls_beyond_args.h -- push constants of walls_beyond. Included by C and GLSL; scalar layout.
#include "shaders/common/shared.h"

struct walls_beyond_args {
    tyn_vec3 extent; // of the medium, m
    float reach;     // m beyond the lattice's faces
    tyn_uvec3 dims;  // cells
    tyn_uint shining;
};
TYN_ASSERT_SIZE(walls_beyond_args, 32);
