// propagate_radial.h -- light of each lamp in a radial grid of its own, moved cell by cell.
//
// Elek et al. 2014, section 6: octahedral maps of directions times shells around the light whose radii
// grow so that cells are about as deep as wide. What propagate_rect does along a direction happens here along
// the radius, and the four sides of the map are folded together. Rules that the paper leaves open:
//   - light starts in the ball around the lamp, as far as its directions meet the medium; those of a lamp
//     outside the medium's box start in their first cell with medium;
//   - what comes back into the ball crosses it and goes out on the other side; a is taken about the direction
//     in which it then goes, so that its sign is lost;
//   - a direction's cells end with the last that has medium; what goes on outwards, or sideways to
//     where there are no cells, has left.
//
// All grids take one dispatch an iteration; what does not fit a storage buffer of 128 MiB is done in
// batches of grids.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"
#include "../common/propagate_args.h"
#include "../common/propagate_radial_grid.h"

typedef struct tyn_propagate_radial_params {
    int32_t cells;       // of the octahedral map along a side, made even; 2..64
    int32_t shells;      // 1..64
    int32_t iterations;  // 1..256
    int32_t init;        // PROPAGATE_RADIAL_INIT_*
    int32_t scale;       // TYN_PROPAGATE_SCALE_*
    uint32_t narrowing;  // 1: lobes narrow on their way outwards, 1 - a ~ r^-2
    uint32_t last_event; // 1: the light is scattered once more towards the eye: hg(mu, g a)
    int32_t rate;        // TYN_PROPAGATE_RATE_*
    uint32_t prefilter;  // 1: lights that stand for a disc start with its mean cosine
    float beta;          // exponent of that
    int32_t
        vpl_cells; // cells and shells of the grids of VPLs, 2..32: for the method, which gives them a
                   // node of their own; no kernel reads it
    uint32_t num_lamps;    // set by the method, as all below
    uint32_t max_vpls;     // room for VPLs, 0 to TYN_RADIAL_VPLS_MAX
    uint32_t channels;     // 1 if the medium is the same in all channels, else 3
    uint32_t mode;         // TYN_MEDIUM_*
    uint32_t buffer_bytes; // largest storage buffer; 0 = 128 MiB
    uint32_t shadowed;     // 1: lamps have shadow maps, VPLs maps of what they see
    float extent[3];       // medium_block.extent, m
    uint32_t size[3];      // medium_block.size
    struct light_block lamps[TYN_RADIAL_LAMPS_MAX];
} tyn_propagate_radial_params;

// clang-format off
#define PROPAGATE_RADIAL_PORTS(X) \
    TYN_MEDIUM(X, PROPAGATE_RADIAL), \
    X(PROPAGATE_RADIAL, CAMERA, camera, IN, BUFFER, "struct camera_block"), \
    TYN_VPLS(X##_OPTIONAL, PROPAGATE_RADIAL), \
    TYN_SHADOWS(X##_OPTIONAL, PROPAGATE_RADIAL), \
    X(PROPAGATE_RADIAL, GRIDS, grids, OUT, BUFFER, "struct propagate_radial_grid[]: lamps, then VPLs"), \
    X(PROPAGATE_RADIAL, PLACES, places, OUT, BUFFER, "struct propagate_radial_place[]"), \
    X(PROPAGATE_RADIAL, SEEN, seen, OUT, IMAGE_3D, \
        "tiles of grids and channels: r^2 L_acc, sum over iterations of L towards the eye, in units of the " \
        "intensity, 1/sr", .format = VK_FORMAT_R32_SFLOAT), \
    X(PROPAGATE_RADIAL, MAP, map, OUT, BUFFER, "vec2[grids][cells^2]: power that starts there, sr; solid angle"), \
    X(PROPAGATE_RADIAL, CELLS, cells, OUT, BUFFER, \
        "vec4[grids][channels][layers][cells^2] of the last batch: optical depths of scattering and " \
        "absorption along the radius (of the ball: twice), g, cosine between the radius and the direction to " \
        "the eye (-2: not in the grid)"), \
    X(PROPAGATE_RADIAL, LIT, lit, OUT, BUFFER, \
        "float[grids][layers][cells^2] of the last batch: of light that goes straight on, the share that surfaces let " \
        "into a cell from the one before it; a number where nothing casts shadows"), \
    X(PROPAGATE_RADIAL, STATE, state, OUT, BUFFER, \
        "vec4[]: after the last iteration what leaves the cell outwards, to each side and inwards, sr, and " \
        "1 - a of it"), \
    X(PROPAGATE_RADIAL, SUM, sum, OUT, BUFFER, "r^2 L_acc of the last batch of grids"), \
    X(PROPAGATE_RADIAL, STATE_OTHER, state_other, SCRATCH, BUFFER, "state of every other iteration"), \
    X(PROPAGATE_RADIAL, LAMPS, lamps, SCRATCH, BUFFER, "struct light_block[]")
// clang-format on
TYN_PASS(PROPAGATE_RADIAL, propagate_radial);
