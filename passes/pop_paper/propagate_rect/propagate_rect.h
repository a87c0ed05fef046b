// propagate_rect.h -- light of each ordinate in its own aligned grid, moved cell by cell.
//
// Elek et al. 2014, sections 3-5.1, Eqs 1-8. The result depends on the view (Eq 8): a moved camera runs
// all iterations again, as in the paper. Defaults are the reading with the right energy: the first
// layer starts with the light's irradiance, and what reaches the eye has scattered a last time.
//
// Cells are cubes, or as long and as wide as the numbers of cells along and across the light make them (its Fig 17).
// Iterations may end where little light is left (section 5.4: epsilon_L): what is left is looked at on the device, and
// iterations behind that are skipped there.
//
// All grids take one dispatch an iteration. What does not fit a storage buffer of 128 MiB, which every
// device has, is done in several batches of grids, one after the other.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"
#include "../common/propagate_args.h"

typedef struct tyn_propagate_rect_params {
    int32_t
        cells; // along the longest side of the aligned box, or of those across the light, 2..128
    int32_t cells_along; // along the light, 0..128; 0 = as many as fit, of cubes
    int32_t cones;       // TYN_PROPAGATE_CONES_*
    int32_t iterations;  // 1..256
    float threshold; // of the largest irradiance: iterations end where no cell has more; 0 = never
    int32_t init;    // TYN_PROPAGATE_INIT_*
    uint32_t last_event;    // 1: the light is scattered once more towards the eye: hg(mu, g a)
    int32_t rate;           // TYN_PROPAGATE_RATE_*
    int32_t prefilter;      // TYN_PROPAGATE_PREFILTER_*
    float beta;             // exponent of the heuristic prefilter
    uint32_t num_ordinates; // set by the method, as all below: room for, 1..TYN_ORDINATES_MAX
    uint32_t channels;      // 1 if the medium is the same in all channels, else 3
    uint32_t mode;          // TYN_MEDIUM_*
    uint32_t buffer_bytes;  // largest storage buffer; 0 = 128 MiB
    uint32_t keep_light;    // 1: the port "light" exists
    uint32_t num_mapped;    // ordinates from the first on that are suns with shadow maps
    uint32_t num_triangles; // of the surfaces; 0: rays are not followed
    float extent[3];        // medium_block.extent, m
    uint32_t size[3];       // medium_block.size
} tyn_propagate_rect_params;

// clang-format off
#define PROPAGATE_RECT_PORTS(X) \
    TYN_MEDIUM(X, PROPAGATE_RECT), \
    X(PROPAGATE_RECT, ORDINATES, ordinates, IN, BUFFER, "struct ordinates_block"), \
    X(PROPAGATE_RECT, CAMERA, camera, IN, BUFFER, "struct camera_block"), \
    TYN_SHADOWS(X##_OPTIONAL, PROPAGATE_RECT), \
    TYN_GEOMETRY(X##_OPTIONAL, PROPAGATE_RECT), \
    X(PROPAGATE_RECT, GRIDS, grids, OUT, BUFFER, "struct propagate_grid[]"), \
    X(PROPAGATE_RECT, PLACES, places, OUT, BUFFER, "struct propagate_place[TYN_ORDINATES_MAX], <= 16 KiB"), \
    X(PROPAGATE_RECT, SEEN, seen, OUT, IMAGE_3D, \
        "tiles of grids and channels (propagate_args.h): L_acc, sum over iterations of L towards the eye, in " \
        "units of the irradiance, 1/sr", .format = VK_FORMAT_R32_SFLOAT), \
    X(PROPAGATE_RECT, LIGHT, light, OUT, IMAGE_3D, \
        "optional, tiles: L after the last iteration, in units of the irradiance", .format = VK_FORMAT_R32_SFLOAT), \
    X(PROPAGATE_RECT, CELLS, cells, OUT, BUFFER, \
        "vec4[grids][channels][cells] of the last batch: optical depths of scattering and absorption over " \
        "the edge of a cell along the light, g, cosine between the light and the direction to the eye (-2: not in the grid)"), \
    X(PROPAGATE_RECT, LIT, lit, OUT, BUFFER, \
        "float[grids][cells] of the last batch: of light that goes straight on, the share that surfaces let into " \
        "a cell from the one before it; a number where nothing casts shadows"), \
    X(PROPAGATE_RECT, STATE, state, OUT, BUFFER, \
        "vec4[]: after the last iteration what of L leaves the cell ahead, to each side and behind, and 1 -" \
        " a of it"), \
    X(PROPAGATE_RECT, SUM, sum, OUT, BUFFER, "L_acc of the last batch of grids"), \
    X(PROPAGATE_RECT, FLIGHT, flight, OUT, BUFFER, \
        "iterations that were run, and the brightest cells (propagate_rect_args.h); a number where none is skipped"), \
    X(PROPAGATE_RECT, LAUNCHES, launches, SCRATCH, BUFFER, "struct propagate_launches"), \
    X(PROPAGATE_RECT, STATE_OTHER, state_other, SCRATCH, BUFFER, "state of every other iteration"), \
    X(PROPAGATE_RECT, BESIDE, beside, SCRATCH, BUFFER, \
        "1 - a of what leaves a cell sideways; a number where cells are cubes"), \
    X(PROPAGATE_RECT, BESIDE_OTHER, beside_other, SCRATCH, BUFFER, "of every other iteration"), \
    X(PROPAGATE_RECT, SMALL, small, SCRATCH, IMAGE_3D, \
        "density or sigma_s at a resolution that suits the cells,", .format = VK_FORMAT_R32_SFLOAT), \
    X(PROPAGATE_RECT, SMALL_SIGMA_A, small_sigma_a, SCRATCH, RGBA_3D, \
        ".. if the medium's is more than twice as fine"), \
    X(PROPAGATE_RECT, SMALL_G, small_g, SCRATCH, RGBA_3D, "g, shrunk")
// clang-format on
TYN_PASS(PROPAGATE_RECT, propagate_rect);
