// wall_light_args.h -- push constants of the kernels of the pass wall_light. Included by C and GLSL.
#ifndef TYN_WALL_LIGHT_ARGS_H
#define TYN_WALL_LIGHT_ARGS_H
#include "shared.h"

struct wall_light_args {
    tyn_vec3 extent; // of the medium, m
    tyn_uvec3 dims;  // cells
    tyn_uint num_suns;
};

// Cells of a workgroup that goes through the list of those that have walls.
#define WALL_LIGHT_GROUP 64

// The list's head, then per cell of the lattice which links are cut, bit 13 + dx + 3 dy + 9 dz for the one to the
// neighbour that is (dx, dy, dz) away, then the indices of the cells with walls; their order does not matter.
struct wall_light_list {
    tyn_uvec3 groups; // workgroups
    tyn_uint count;
};
TYN_ASSERT_SIZE(wall_light_list, 16);

#define WALL_LIGHT_SUM_GROUP 256
#define WALL_LIGHT_VPLS 256 // as many as there may be (TYN_RADIAL_VPLS_MAX)

// What virtual point lights send to walls, W, and the factor that makes the walls of all cells get it.
struct wall_light_power {
    tyn_vec3 scale;
    float pad;
    tyn_vec3 expected[WALL_LIGHT_VPLS];
};
TYN_ASSERT_SIZE(wall_light_power, 3088);

#endif
