// propagate_args.h -- grids of the six-neighbour propagation. Included by C and GLSL; scalar layout.
//
// All grids are stacked along z in one image, channel by channel: cell (i, j, k) of channel c of light n
// is texel (i, j, (n channels + c) cells + k), and first_layer = n channels cells. One channel if the
// medium is the same in all: light of another colour is the same light times a colour.
#ifndef TYN_PROPAGATE_ARGS_H
#define TYN_PROPAGATE_ARGS_H
#include "shared.h"

// Readings of the paper where its text leaves a choice.
#define TYN_PROPAGATE_INIT_ENTRY 0           // first layer only, unattenuated
#define TYN_PROPAGATE_INIT_TRANSMITTANCE 1   // every cell, attenuated by sigma_t
#define TYN_PROPAGATE_INIT_ABSORPTION 2      // every cell, attenuated by sigma_a
#define TYN_PROPAGATE_INIT_FIRST_COLLISION 3 // every cell, what scatters there for the first time
#define TYN_PROPAGATE_RATE_PAPER 0           // a' = a g^(sigma_s t)
#define TYN_PROPAGATE_RATE_EXACT 1           // a' = a exp(-(1 - g) sigma_s t)
#define TYN_PROPAGATE_SOURCE_SCATTERED 0     // source = sigma_s L_acc
#define TYN_PROPAGATE_SOURCE_ACCUMULATED 1   // source = L_acc

struct propagate_grid {   // element of storage buffer "grids", one per directional light
    tyn_vec3 origin;      // M position of the corner of cell (0, 0, 0), m
    float cell;           // edge of the cubic cells, m
    tyn_vec3 across_u;    // M, unit: x axis of the grid
    tyn_uint first_layer; // z of layer 0 in the stacked images
    tyn_vec3 across_v;    // M, unit: y axis
    tyn_uint light;       // index into "lights"
    tyn_vec3 direction;   // M, unit: z axis, the light's direction of travel
    tyn_uint channels;   // 1 or 3
    tyn_vec3 irradiance; // of the light, W/m^2: what the grid's light is in units of
    tyn_uvec3 size;      // cells; texels beyond are not part of the grid
};
TYN_ASSERT_SIZE(propagate_grid, 88);

#endif
