// probe_args.h -- push constants of the probe and balance kernels. Included by C and GLSL.
#ifndef TYN_PROBE_ARGS_H
#define TYN_PROBE_ARGS_H
#include "shared.h"

struct probe_args {
    tyn_vec3 tint;
    tyn_uint channels;
    tyn_uint num_suns;
    tyn_uint num_ordinates;
    tyn_uint num_points;
    tyn_uint scattered_only;
    tyn_uint local_lights;
    tyn_uint cells; // 1: lattice_cells is there
    tyn_vec3 world[3];
};

struct probe_result { // tyn_probe_result
    float fluence[3];
    float flux[9]; // x_r x_g x_b y_r ...
    float fluence_se[3];
    float flux_se[9];
};
TYN_ASSERT_SIZE(probe_result, 96);

struct balance_args {
    tyn_vec3 tint;
    tyn_uint channels;
    tyn_uint num_suns;
    tyn_uint num_leaks;    // per channel
    tyn_uint num_groups;   // of local lights
    tyn_uint emitters;     // 1: there are surfaces that emit
    tyn_uint num_followed; // groups of balance_lights; 0: there are none
};

struct balance_lights_args {
    tyn_vec3 lo; // M: of the box around media, surfaces and lamps
    tyn_uint num_suns;
    tyn_vec3 hi;
    tyn_uint locals; // 1: there are lamps or VPLs
};
TYN_ASSERT_SIZE(balance_lights_args, 32);

// Of one part of a sun, of one lamp or VPL: W.
struct balance_light {
    tyn_vec3 entering;
    tyn_vec3 emitted;
    tyn_vec3 kept; // by surfaces that its light meets
    tyn_vec3 escaped;
};
TYN_ASSERT_SIZE(balance_light, 48);

#define BALANCE_GROUP 256
#define BALANCE_SUN_PARTS 16 // groups that share the rays of a sun

#endif
