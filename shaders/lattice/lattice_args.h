// lattice_args.h -- push constants and buffers of the lattice kernels. Included by C and GLSL.
#ifndef TYN_LATTICE_ARGS_H
#define TYN_LATTICE_ARGS_H
#include "shaders/common/shared.h"
#include "lattice_power.h"

struct lattice_cells_args {
    tyn_uvec3 dims; // cells
    tyn_uint channels;
    tyn_vec3 tint;
    tyn_uvec3 samples; // per cell along each axis
};

struct lattice_source_args {
    tyn_uvec3 dims;
    tyn_uint channels;
    tyn_vec3 tint;
    tyn_uint samples; // per cell along each axis
    tyn_uint num_suns;
    tyn_uint sun; // beam: the one
};

struct lattice_mean_args {
    tyn_uvec3 dims; // cells
    tyn_uint channels;
    tyn_vec3 tint;
    tyn_uint march; // axis along which the diagonals are marched
    float dx;       // edge of a cell, m
};

struct lattice_ordinates_args {
    tyn_uvec3 dims;
    tyn_uint channels;
    tyn_vec3 tint;
    tyn_uint count; // ordinates that the columns have room for
};

// Local lights go into the lattice in groups: each of the strongest lamps, the further lamps, the VPLs. A
// group's light is scaled so that the cells lose what its beams lose.
#define LATTICE_LAMPS_MAX_GROUPS 6

struct lattice_lamps_args {
    tyn_uvec3 dims;
    tyn_uint channels;
    tyn_vec3 tint;
    tyn_uint num_fine;   // lamps that are groups of their own
    tyn_uint num_lamps;  // all
    tyn_uint num_groups; // the VPLs, if there may be any, are the last
    tyn_uint samples;    // per cell along each axis: of the strongest lamps; others one less
};

struct lattice_args { // kernels on the whole lattice
    tyn_uvec3 dims;
    tyn_uint channels;
    tyn_vec3 tint;
    float dx;          // m
    tyn_uint lines;    // sweep: threads per direction and channel
    tyn_uint stride;   // cells of all levels of the diffusion grid
    tyn_uint history;  // residual, mix: earlier sweeps that there are, 0..2
    tyn_uint anderson; // residual: 1 = they are mixed in
    tyn_uint guess;    // start: 1 = from the guess
    // Vectors of the state per channel: cells, then the radiance of their walls by fours.
    tyn_uint elements;
    tyn_uint corrected; // collect, residual: 1 = there is a diffusion correction
    tyn_uvec3 repeat;   // sweep: periodic axes
    tyn_uint march;     // sweep: axis from whose planes diagonal lines start; not a periodic one
};

struct lattice_level_args { // kernels on one level of the diffusion grid
    tyn_uvec3 dims;         // of level 0
    tyn_uint level;
    tyn_uint levels; // how many there are
    tyn_uint stride; // cells of all
    tyn_uint channels;
    tyn_uint colour;       // relax: 0 or 1; coarse: the first of the first relaxation
    float dx;              // of level 0, m
    float least_transport; // that a cell's sigma_tr is taken for, 1/m
    tyn_uvec3 repeat;      // stencil: periodic axes
};

#define LATTICE_DIRECTIONS 14
#define LATTICE_MAX_CHANNELS 3
#define LATTICE_SWEEP_GROUP 64                   // threads of a workgroup: lines
#define LATTICE_GROUP 64                         // ... of kernels that reduce
#define LATTICE_GROUP_CELLS (16 * LATTICE_GROUP) // that it reduces
#define LATTICE_MIX_DOTS 5                       // dot products of Anderson mixing
#define LATTICE_NUM_DOTS 7                       // ... and of the last sweep
#define LATTICE_TILE 8 // edge of the blocks of cells in which two colours are relaxed at once; even
#define LATTICE_COARSE_CELLS 4096 // a level of at most so many cells is solved inside one workgroup
#define LATTICE_COARSE_FEW 2048   // ... with 16 KiB of shared memory: exactly as much
#define LATTICE_COARSE_GROUP 256
// Threads that share the VPLs of a block: at most 32 VPLs each, and a thread for each channel.
#define LATTICE_VPL_SLICES 8
#define LATTICE_SUN_GROUP 256
#define LATTICE_DEPTH_GROUP 256
#define LATTICE_MAX_LAUNCHES 64 // of a cycle

#endif
