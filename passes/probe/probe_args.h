// probe_args.h -- push constants of the probe kernel. Included by C and GLSL.
#include "shaders/common/shared.h"

struct probe_args {
    tyn_vec3 tint;
    tyn_uint channels;
    tyn_uint num_suns;
    tyn_uint num_ordinates;
    tyn_uint num_points;
    tyn_uint scattered_only;
    tyn_uint local_lights; // TYN_PROBE_LOCAL_*
    tyn_uint cells;        // 1: lattice_cells is there
    tyn_uint
        parts; // 1: means of all channels: of the lattice in the place of red, of all else in green's
    tyn_vec3 world[3];
};

struct probe_result { // tyn_probe_result
    float fluence[3];
    float flux[9]; // x_r x_g x_b y_r ...
    float fluence_se[3];
    float flux_se[9];
};
TYN_ASSERT_SIZE(probe_result, 96);
