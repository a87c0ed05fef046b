// gradient_args.h -- push constants, lists and samples of the method gradient. Included by C and GLSL; scalar layout.
#include "shaders/common/shared.h"

#define GRADIENT_MAX_CELLS 64 // of the finest grid, along the longest side
#define GRADIENT_MAX_LEVELS 6 // 2 cells to 64

// Bits of the specialisation constant "features".
#define GRADIENT_SHADOWS (1u << 0) // surfaces stand before suns and lamps
#define GRADIENT_LAMPS (1u << 1)   // some lights are points
#define GRADIENT_MAPS (1u << 2)    // ... and before the environment: its directions have maps
#define GRADIENT_MULTIPLE                                                                          \
    (1u << 3) // samples read what has scattered more than once; all is delta scaled
#define GRADIENT_WALLS (1u << 4) // ... between walls of the lattice
#define GRADIENT_SOFT (1u << 5)  // shadows of suns and lamps have soft edges
#define GRADIENT_SKY (1u << 7)   // some lights stand for many directions
#define GRADIENT_ONE_CHANNEL                                                                       \
    (1u << 6) // what samples read has one channel, to be multiplied with `tint`

// Specialisation constant "interpolation".
#define GRADIENT_GRADIENT 0u
#define GRADIENT_RBF 1u
#define GRADIENT_VOXEL 2u

// Threads of a group of samples: one for each point at which a sample traces light.
#define GRADIENT_GROUP 64u
// Groups in a row of an indirect dispatch; a dispatch may have no more than 65535.
#define GRADIENT_ROW 32768u

struct gradient_args {
    // Points of the grid of each level along the axes: x, y << 8, z << 16.
    tyn_uint grids[GRADIENT_MAX_LEVELS];
    tyn_uint levels;
    tyn_uint level; // of the dispatch
    float longest;  // side of the medium's box, m
    float radius;   // of level 0's samples, m; half of it with each level
    float step;     // between densities along a ray, m
    float apart;    // of the two points of a central difference to the sample, m
    float nearest;  // lamps nearer to a cell than this count as so far away, m
    float epsilon;
    tyn_uint linear;  // 1: L + (x - x_j) grad L, else L e^((x - x_j) grad L / L)
    tyn_uint fading;  // 1: weights vanish at the valid radius
    float narrow;     // width of radial functions, of the valid radius
    float soft;       // across which edges of shadows are soft, m
    tyn_vec3 tint;    // of the one channel of what has scattered more than once
    tyn_uint x, y, z; // cells of the field
};
TYN_ASSERT_SIZE(gradient_args, 96);

// What is known of a level, for dispatches and the next one.
struct gradient_level_head {
    tyn_uvec3 groups; // of threads that sample
    tyn_uint count;   // points that are listed
    tyn_uvec3 split;  // groups that look which are split
    tyn_uint pad;
};
TYN_ASSERT_SIZE(gradient_level_head, 32);

struct gradient_head { // scratch buffer "heads"
    TYN_STRUCT(gradient_level_head) levels[GRADIENT_MAX_LEVELS];
    float reference; // light that level 0 sees scattered towards the eye: what errors are shares of
    tyn_uvec3 pad;
};
TYN_ASSERT_SIZE(gradient_head, 32 * GRADIENT_MAX_LEVELS + 16);

// A sample, at its point of the grid; rows of four words, read as texels.
struct gradient_sample {
    tyn_vec3 light; // towards the eye, per sigma_s, W/(m^2 sr)
    float error;    // Eq 6
    tyn_vec3 dx;    // its derivative along x, W/(m^3 sr)
    float seen;     // light scattered towards the eye and seen from there, in a volume of radius^3
    tyn_vec3 dy;
    float pad0;
    tyn_vec3 dz;
    float pad1;
};
TYN_ASSERT_SIZE(gradient_sample, 64);

// States of points of the grids: bits of "states".
#define GRADIENT_IS_LISTED 1u
#define GRADIENT_IS_SAMPLE 2u // and was not split
