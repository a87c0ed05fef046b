// walls_pass_args.h -- push constants of the kernels of the pass walls. Included by C and GLSL.
#include "shaders/common/shared.h"

struct walls_pass_args {
    tyn_vec3 extent; // of the medium, m
    tyn_uvec3 dims;  // cells
    tyn_uint num_triangles;
    tyn_uint row;    // triangles in a row of workgroups
    tyn_uint slices; // workgroups for each
};

#define WALLS_GROUP 8   // threads that look at one triangle
#define WALLS_FEW 1024  // triangles: fewer are likely to be large ...
#define WALLS_SLICES 16 // and are looked at by so many workgroups
#define WALLS_SLOTS 6   // walls in a cell, one for each main direction of the normal
#define WALLS_ROW 32768 // workgroups along x
