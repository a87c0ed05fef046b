// importance_args.h -- the camera's grid and the map of directions. Included by C and GLSL.
#include "shaders/common/shared.h"

#define TYN_IMPORTANCE_WIDTH 32 // of the map of directions, texels
#define TYN_IMPORTANCE_HEIGHT 16
#define TYN_IMPORTANCE_TEXELS (TYN_IMPORTANCE_WIDTH * TYN_IMPORTANCE_HEIGHT)
#define TYN_IMPORTANCE_GROUP 256 // threads of the kernel that makes the map
#define TYN_IMPORTANCE_RAYS 6    // along each side of the box, per direction of the map
#define TYN_IMPORTANCE_STEPS 12  // of a ray through the box

// The grid is the part of the camera's pyramid that holds the medium: column (i, j) is a pencil of the
// camera's rays, layer k a range of depths. Positions in it are (s, t, z): depth z along `forward`;
// s, t along `right` and `up`, divided by z if the camera is perspective.
struct importance_grid {
    tyn_vec3 origin; // M, m: the camera
    float near;      // depths, m
    tyn_vec3 right;  // M, unit
    float far;
    tyn_vec3 up;
    tyn_uint orthographic;
    tyn_vec3 forward;
    tyn_uint empty; // 1: no medium in front of the camera
    tyn_vec2 low;   // (s, t) of the grid
    tyn_vec2 high;
    tyn_vec2 window_low; // of the picture
    tyn_vec2 window_high;
    float octaves; // log2 of far / near, perspective
};
TYN_ASSERT_SIZE(importance_grid, 100);

struct importance_cell { // the medium in a cell; the mean over the channels
    float sigma_s;       // 1/m, of the last scattering: delta-scaled where the method wants it
    float sigma_t;
    float g;
    float volume;       // m^3
    float along;        // length of the cell in its column, m
    float across;       // width, m
    tyn_vec2 hop_along; // what half a cell does: part of the power left, loss of the mean cosine
    tyn_vec2 hop_across;
};
TYN_ASSERT_SIZE(importance_cell, 40);

struct importance_light { // importance on its way out of a cell, half a hop done
    // Power to the neighbour in front, each of the four beside, the one behind.
    float ahead, side, behind;
    float spread_along;  // 1 - mean cosine of what goes ahead or back
    float spread_across; // ... and to the sides
};
TYN_ASSERT_SIZE(importance_light, 20);

struct importance_history { // from frame to frame; zeros at the start
    tyn_uint frames;        // 0 = nothing is known yet
    float map[TYN_IMPORTANCE_TEXELS];
};
TYN_ASSERT_SIZE(importance_history, 2052);

struct importance_args {
    tyn_uint cells; // along each side of the grid
    tyn_uint scaled;
    float smoothing;
    float floor;
};
TYN_ASSERT_SIZE(importance_args, 16);
