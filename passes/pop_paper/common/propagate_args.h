// propagate_args.h -- grids of the six-neighbour propagation. Included by C and GLSL; scalar layout.
//
// Cells of a grid are numbered x fastest, within `cells` x `cells` across the light and `along` along it: as many, unless
// cells need not be cubes. Where a grid keeps one number a channel, grid n and channel c are stack n channels + c: one after the other in a buffer, tiles
// side by side in an image. One channel if the medium is the same in all: light of another colour is
// the same light times a colour.
#ifndef TYN_PROPAGATE_ARGS_H
#define TYN_PROPAGATE_ARGS_H
#include "shaders/light/ordinate_args.h"

// Readings of the paper where its text leaves a choice.
#define TYN_PROPAGATE_INIT_ENTRY 0           // first layer only, unattenuated
#define TYN_PROPAGATE_INIT_TRANSMITTANCE 1   // every cell, attenuated by sigma_t
#define TYN_PROPAGATE_INIT_ABSORPTION 2      // every cell, attenuated by sigma_a
#define TYN_PROPAGATE_INIT_FIRST_COLLISION 3 // every cell, what scatters there for the first time
#define TYN_PROPAGATE_RATE_PAPER 0           // a' = a g^(sigma_s t)
#define TYN_PROPAGATE_RATE_EXACT 1           // a' = a exp(-(1 - g) sigma_s t)
#define TYN_PROPAGATE_PREFILTER_OFF 0        // an ordinate's light starts as a beam: a = 1
#define TYN_PROPAGATE_PREFILTER_HEURISTIC 1 // a = (1 - w / N)^beta, w = share of the sphere times N
#define TYN_PROPAGATE_PREFILTER_EXACT 2     // a = mean cosine of the ordinate's region
// Where a cell is not a cube, the half angle of the cone whose light goes ahead:
#define TYN_PROPAGATE_CONES_PAPER 0 // 45 degrees, as Eq 3 has it
#define TYN_PROPAGATE_CONES_CELL 1  // that of the cell's end as seen from its middle

struct propagate_grid {  // element of storage buffer "grids", one per ordinate
    tyn_vec3 origin;     // M position of the corner of cell (0, 0, 0), m
    float cell;          // edge of the cells across the light, m
    tyn_vec3 across_u;   // M, unit: x axis of the grid
    tyn_uint channels;   // 1 or 3
    tyn_vec3 across_v;   // M, unit: y axis
    float mean_cosine;   // of the light as it enters, 1 = a beam
    tyn_vec3 direction;  // M, unit: z axis, the light's direction of travel
    float along;         // edge of the cells along the light, m; of cubes the same
    tyn_vec3 irradiance; // of the light, W/m^2: what the grid's light is in units of
    tyn_uvec3 size;      // cells; those beyond hold no light. (0, 0, 0): no light at all
    float cone;          // cosine of the half angle of the cone whose light goes ahead
};
TYN_ASSERT_SIZE(propagate_grid, 92);

// What the merge of all grids needs of one: element of uniform buffer "places", in the order of "grids".

struct propagate_place {
    // M -> cells of the grid: dot(rows[i].xyz, p) + rows[i].w; cell i spans [i, i + 1].
    tyn_vec4 rows[3];
    tyn_vec3 irradiance; // W/m^2
    tyn_uint size;       // cells: x | y << 8 | z << 16
};
TYN_ASSERT_SIZE(propagate_place, 64);

#endif
