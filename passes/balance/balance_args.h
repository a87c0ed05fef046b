// balance_args.h -- push constants and buffers of the balance kernels. Included by C and GLSL.
#include "shaders/common/shared.h"

struct balance_args {
    tyn_vec3 tint;
    tyn_uint channels;
    tyn_uint num_suns;
    tyn_uint num_leaks;    // per channel
    tyn_uint num_groups;   // of local lights
    tyn_uint vpls;         // 1: the last of them are virtual point lights
    tyn_uint emitters;     // 1: there are surfaces that emit
    tyn_uint num_followed; // groups of balance_lights; 0: there are none
    tyn_uint sky;          // 1: the sky is one of them
};

struct balance_lights_args {
    tyn_vec3 lo; // M: of the box around media, surfaces and lamps
    tyn_uint num_suns;
    tyn_vec3 hi;
    tyn_uint locals; // 1: there are lamps or VPLs
    tyn_uint sky_parts;
    tyn_uint channels; // of the cells
};
TYN_ASSERT_SIZE(balance_lights_args, 40);

// Of one part of a sun or of the sky, of one lamp or VPL: W.
struct balance_light {
    tyn_vec3 entering;
    tyn_vec3 emitted;
    tyn_vec3 kept; // by surfaces that its light meets
    tyn_vec3 escaped;
};
TYN_ASSERT_SIZE(balance_light, 48);

#define BALANCE_GROUP 256
#define BALANCE_SUN_PARTS 16 // groups that share the rays of a sun
#define BALANCE_SKY_PARTS 64 // and of the sky
