// lattice.h -- the light that has scattered: one solve on a lattice of cubic cells for all lights.
//
// Five passes, so that what does not change is not done again:
//   lattice_cells   the medium averaged over the cells         (again when the medium changes)
//   lattice_source  unscattered sunlight per cell              (... or a sun changes)
//   lattice_ordinates  light of the sky's principal ordinates (... or the environment)
//   lattice_lamps   unscattered light of lamps and surfaces    (... or a lamp)
//   lattice         fluence and flux of the scattered light    (... or the environment changes)
// and two around the last for sequences: lattice_recall brings the last frame's solution to this
// frame's cells, lattice_keep puts this frame's away.
// None of them depends on the camera.
//
// Coefficients are those of delta scaling: f = g^2 for g > 0, else 0; g' = (g - f) / (1 - f),
// sigma_s' = (1 - f) sigma_s, sigma_t' = sigma_a + sigma_s'. Light scattered into the forward peak
// f counts as not scattered (Joseph, Wiscombe and Weinman 1976).
#pragma once
#include <tyndall/pass.h>
#include "bundles.h"
#include "scene_args.h"

// Cells along the longest side, and of all: long and flat media may have more along it than others.
enum { TYN_LATTICE_MAX_CELLS = 256, TYN_LATTICE_MAX_ALL = 64 * 64 * 64, TYN_LATTICE_MAX_SUNS = 4 };

// What all passes of a lattice have in common; a method fills it once.
typedef struct tyn_lattice_shape {
    float extent[3];    // medium_block.extent, m
    int32_t cells;      // along the longest side: the param "lattice.cells"
    uint32_t channels;  // 1 or 3 that are solved
    float tint[3];      // of the one channel (see tyn_lattice_tint), else 1, 1, 1
    uint32_t repeat[3]; // medium_block.repeat; not all three. Such sides are whole numbers of cells
} tyn_lattice_shape;

// Cells along each axis: cubes of longest side / cells; the box they fill holds the medium's.
tyn_extent tyn_lattice_dims(const float extent[3], int32_t cells);

// The most cells along the longest side, up to `cells`, with which the sides that repeat are whole numbers of
// cells and there are not more than TYN_LATTICE_MAX_ALL; 0: none.
int32_t tyn_lattice_fit(const float extent[3], const uint32_t repeat[3], int32_t cells);

// True if `n` colours (lights, emission, mean of the environment) are multiples of one colour, its
// `tint` with a largest component of 1. With a grey medium one channel is then enough: shaders
// solve for dot(color, tint) / dot(tint, tint), and merge and probe multiply by the tint. Else (1,
// 1, 1).
bool tyn_lattice_tint(const float (*colors)[3], uint32_t n, float tint[3]);

// ---- lattice_cells ----------------------------------------------------------------------------

typedef struct tyn_lattice_cells_params {
    tyn_lattice_shape shape;
    uint32_t mode; // TYN_MEDIUM_*
} tyn_lattice_cells_params;

enum {
    TYN_MEDIUM(TYN_BUNDLE_ENUM, LATTICE_CELLS), // IN
    LATTICE_CELLS_PORT_CELLS, // OUT 3D RGBA32F, channels stacked along z: sigma_s', sigma_a, g', emission
    LATTICE_CELLS_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_lattice_cells;

// ---- lattice_source ---------------------------------------------------------------------------

typedef struct tyn_lattice_source_params {
    tyn_lattice_shape shape;
    uint32_t mode;     // TYN_MEDIUM_*
    uint32_t num_suns; // 0..4; 0: the pass need not be added
} tyn_lattice_source_params;

enum {
    TYN_MEDIUM(TYN_BUNDLE_ENUM, LATTICE_SOURCE),  // IN
    LATTICE_SOURCE_PORT_LIGHTS,                   // IN buffer struct light_block[]
    LATTICE_SOURCE_PORT_CELLS,                    // IN 3D
    TYN_BEAMS(TYN_BUNDLE_ENUM, LATTICE_SOURCE),   // IN
    TYN_WALLS(TYN_BUNDLE_ENUM, LATTICE_SOURCE),   // IN optional
    TYN_SHADOWS(TYN_BUNDLE_ENUM, LATTICE_SOURCE), // IN optional
    LATTICE_SOURCE_PORT_SOURCE, // OUT 3D RGBA32F, stacked: sum E T' over the suns, sum E T' direction (W/m^2)
    LATTICE_SOURCE_PORT_POWER, // OUT buffer: per sun the power that enters and that its beam loses, for balance
    LATTICE_SOURCE_PORT_SUNLIT, // SCRATCH
    LATTICE_SOURCE_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_lattice_source;

// ---- lattice_ordinates ------------------------------------------------------------------------

typedef struct tyn_lattice_ordinates_params {
    tyn_lattice_shape shape;
    uint32_t mode;  // TYN_MEDIUM_*
    uint32_t grey;  // 1: sigma_s, sigma_a and g are the same in all channels
    uint32_t count; // tyn_columns_params.count
} tyn_lattice_ordinates_params;

enum {
    LATTICE_ORDINATES_PORT_MEDIUM,                   // IN buffer struct medium_block
    TYN_COLUMNS(TYN_BUNDLE_ENUM, LATTICE_ORDINATES), // IN
    LATTICE_ORDINATES_PORT_CELLS,                    // IN 3D, of lattice_cells
    LATTICE_ORDINATES_PORT_SUNLIGHT, // IN optional 3D: `source` of lattice_source, which is added to
    LATTICE_ORDINATES_PORT_SOURCE, // OUT 3D RGBA32F, stacked: sum E T', sum a E T' direction (W/m^2)
    LATTICE_ORDINATES_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_lattice_ordinates;

// ---- lattice_lamps ----------------------------------------------------------------------------

typedef struct tyn_lattice_lamps_params {
    tyn_lattice_shape shape;
    uint32_t mode;     // TYN_MEDIUM_*
    uint32_t num_fine; // lamps whose power is balanced one by one, 0 to 4: the first of `radials`
    uint32_t num_lamps;
    uint32_t vpls; // 1: there may be VPLs
} tyn_lattice_lamps_params;

enum {
    TYN_MEDIUM(TYN_BUNDLE_ENUM, LATTICE_LAMPS),  // IN
    LATTICE_LAMPS_PORT_CELLS,                    // IN 3D, of lattice_cells
    TYN_RADIALS(TYN_BUNDLE_ENUM, LATTICE_LAMPS), // IN
    TYN_WALLS(TYN_BUNDLE_ENUM, LATTICE_LAMPS),   // IN optional
    TYN_SHADOWS(TYN_BUNDLE_ENUM, LATTICE_LAMPS), // IN optional
    LATTICE_LAMPS_PORT_VPL_DISTANCES,            // IN optional 2D, of vpl
    LATTICE_LAMPS_PORT_ROOMS,  // IN optional buffer, rooms.h: with walls and maps of VPLs
    LATTICE_LAMPS_PORT_OTHERS, // IN optional 3D: `source` of suns and ordinates, which is added to
    LATTICE_LAMPS_PORT_SOURCE, // OUT 3D RGBA32F, stacked: fluence and flux of unscattered light, W/m^2
    LATTICE_LAMPS_PORT_VPL_LIGHT, // OUT 3D RGBA32F, only with `vpls`: what of it is theirs
    LATTICE_LAMPS_PORT_POWER,     // OUT buffer struct lattice_lamp_power per group and channel
    LATTICE_LAMPS_PORT_LIT,       // SCRATCH, as the next
    LATTICE_LAMPS_PORT_UNSHADOWED,
    LATTICE_LAMPS_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_lattice_lamps;

// ---- lattice ----------------------------------------------------------------------------------

typedef struct tyn_lattice_params {
    tyn_lattice_shape shape; // shape.cells is the user's "lattice.cells"
    int32_t sweeps;          // 1..256
    int32_t cycles;          // V-cycles of the diffusion correction after each sweep, 0..8
    uint32_t anderson;       // 1: mix the last three sweeps
    uint32_t warm;           // for the method: 1 = add lattice_recall and lattice_keep
} tyn_lattice_params;

enum {
    LATTICE_PORT_CELLS,       // IN 3D, of lattice_cells
    LATTICE_PORT_SOURCE,      // IN optional 3D, of the last of lattice_source, _ordinates, _lamps
    LATTICE_PORT_ENVIRONMENT, // IN optional buffer struct env_block: `sky` enters from all sides
    LATTICE_PORT_GUESS,       // IN optional buffer, of lattice_recall: where the solve starts
    TYN_WALLS(TYN_BUNDLE_ENUM, LATTICE), // IN optional
    LATTICE_PORT_WALL_LIGHT, // IN optional buffer vec3[cell]: radiance that a cell's walls send out beside
                             // what they reflect of the lattice's light, RGB, W/(m^2 sr)
    LATTICE_PORT_MOMENTS, // OUT 3D RGBA32F, stacked: fluence phi and net flux (x, y, z) of the light that
                          // has scattered, came from the environment or was emitted, W/m^2
    LATTICE_PORT_COUNTERS, // OUT buffer struct counters_block
    LATTICE_PORT_LEAKS,    // OUT buffer: what left the box in the last sweep, for balance
    LATTICE_PORT_WALL_POWER, // OUT buffer vec2[channel][cell], with walls: power that the walls of a cell
    // absorb of the light that is in `moments`, and that `wall_light` brings, W
    LATTICE_PORT_FIRST_SCRATCH,
};
extern const tyn_pass_desc tyn_pass_lattice;

// ---- lattice_recall, lattice_keep ---------------------------------------------------------------

typedef struct tyn_lattice_recall_params { // of both
    tyn_lattice_shape shape;
    float world[3][4]; // rows of the matrix from M to the world
} tyn_lattice_recall_params;

enum {
    LATTICE_RECALL_PORT_MEMORY,      // IN buffer, a history of tyn_lattice_memory_size bytes
    LATTICE_RECALL_PORT_CELLS,       // IN 3D, as lattice has it, and the two below
    LATTICE_RECALL_PORT_SOURCE,      // IN optional 3D
    LATTICE_RECALL_PORT_ENVIRONMENT, // IN optional buffer
    LATTICE_RECALL_PORT_GUESS, // OUT buffer vec4[]: moments by cell. The last frame's where it had any, by
                               // the place in the world, scaled by what light puts in now over what
                               // it did then; elsewhere the environment as if unhindered
    LATTICE_RECALL_PORT_POWER, // OUT buffer vec3: what light puts in
    LATTICE_RECALL_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_lattice_recall;

enum {
    LATTICE_KEEP_PORT_MOMENTS, // IN 3D, of lattice
    LATTICE_KEEP_PORT_POWER,   // IN buffer, of lattice_recall
    LATTICE_KEEP_PORT_MEMORY,  // INOUT buffer, the history
    LATTICE_KEEP_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_lattice_keep;

// Bytes that hold any lattice of so many cells along its longest side: the same for a medium whose
// box changes from frame to frame.
uint64_t tyn_lattice_memory_size(int32_t cells, uint32_t channels);
