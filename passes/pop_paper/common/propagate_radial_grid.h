// propagate_radial_grid.h -- grids of the six-neighbour propagation around local lights. Included by C and
// GLSL; scalar layout.
//
// An octahedral map of `cells` x `cells` directions times layers: layer 0 is the ball around the light,
// r < inner; layer k > 0 is the shell inner growth^(k - 1) <= r < inner growth^k. In buffers the cells of a
// stack (grid n, channel c: n channels + c) are numbered by map column, map row, layer; in the image `seen`
// each stack is a tile with one more texel around the map, of what lies beyond its folded edges.
#include "shaders/beams/radial_args.h"

// What becomes of light from shell to shell. Sideways, light is exchanged at the rate of the smaller cell but
// for SPACING.
#define TYN_PROPAGATE_SCALE_POWER 0 // power is kept both ways: radiance falls with the area, r^-2
// ... and inwards goes what the smaller cell would send outwards: light that is the same everywhere
// stays so.
#define TYN_PROPAGATE_SCALE_RECIPROCAL 1
#define TYN_PROPAGATE_SCALE_SPACING 2 // radiance falls with the spacing, r^-1, as the paper says

struct propagate_radial_grid { // element of storage buffer "grids"
    TYN_STRUCT(light_block) light;
    // Rows, orthogonal: M direction -> direction of the map. The last one is short where the light is far
    // away: the medium gets most of the map.
    tyn_vec3 to_map[3];
    float inner;       // radius of the ball, m
    float growth;      // of the radii from shell to shell
    tyn_uint layers;   // the ball and the shells in use; 0: no light
    float mean_cosine; // of the light as it starts, 1 = a beam
    tyn_uint inside;   // 1: the light is in the medium's box
};
TYN_ASSERT_SIZE(propagate_radial_grid, 120);

// What the merge needs of a grid: element of storage buffer "places".
struct propagate_radial_place {
    tyn_vec3 position; // M, m
    float per_inner;   // 1 / inner, 1/m
    tyn_vec3 to_map[3];
    float per_layer;    // 1 / ln growth
    tyn_vec3 intensity; // W/sr: what the grid's light is in units of
    tyn_uint layers;
};
TYN_ASSERT_SIZE(propagate_radial_place, 72);
