// wall_light_args.h -- push constants and buffers of the kernels of the pass wall_light. Included by C and GLSL.
#include "shaders/walls/wall_light_power.h"

struct wall_light_args {
    tyn_vec3 extent; // of the medium, m
    tyn_uvec3 dims;  // cells
    tyn_uint num_suns;
    tyn_uint num_parts; // sum, scale: of the lattice, 1..WALL_LIGHT_PARTS
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

#define WALL_LIGHT_SUM_GROUP 256 // threads
#define WALL_LIGHT_PART 1024     // cells that a part of the lattice has at least
#define WALL_LIGHT_PARTS 64      // of the lattice, at most; of a workgroup each

#define WALL_LIGHT_DARK 0xffffffffu // element of the buffer "first": no VPL shines there
