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
#include "shaders/beams/propagate_args.h"
#include "shaders/beams/propagate_radial_grid.h"

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
    float extent[3];       // medium_block.extent, m
    uint32_t size[3];      // medium_block.size
    struct radial_light lamps[TYN_RADIAL_LAMPS_MAX];
} tyn_propagate_radial_params;

enum {
    TYN_MEDIUM(TYN_BUNDLE_ENUM, PROPAGATE_RADIAL), // IN
    PROPAGATE_RADIAL_PORT_CAMERA,                  // IN buffer struct camera_block
    PROPAGATE_RADIAL_PORT_VPLS,                    // IN optional buffer struct radial_vpls
    PROPAGATE_RADIAL_PORT_GRIDS,  // OUT buffer struct propagate_radial_grid[]: lamps, then VPLs
    PROPAGATE_RADIAL_PORT_PLACES, // OUT buffer struct propagate_radial_place[], so
    PROPAGATE_RADIAL_PORT_SEEN, // OUT 3D R32F, tiles of grids and channels: r^2 L_acc, sum over iterations of
    // L towards the eye, in units of the intensity, 1/sr
    PROPAGATE_RADIAL_PORT_MAP, // OUT buffer, vec2[grids][cells^2]: power that starts there, sr; solid angle
    PROPAGATE_RADIAL_PORT_CELLS, // OUT buffer, vec4[grids][channels][layers][cells^2] of the last batch: optical
    // depths of scattering and absorption along the radius (of the ball: twice), g, cosine between the
    // radius and the direction to the eye (-2: not in the grid)
    PROPAGATE_RADIAL_PORT_STATE, // OUT buffer, vec4, so: after the last iteration what leaves the cell
    // outwards, to each side and inwards, sr, and 1 - a of it
    PROPAGATE_RADIAL_PORT_SUM,         // OUT buffer, float, so: r^2 L_acc
    PROPAGATE_RADIAL_PORT_STATE_OTHER, // SCRATCH, as the state
    PROPAGATE_RADIAL_PORT_LAMPS,       // SCRATCH buffer struct radial_light[]
    PROPAGATE_RADIAL_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_propagate_radial;
