// radial_beam_args.h -- push constants of radial_beam. Included by C and GLSL; scalar layout.
#include "shaders/common/shared.h"

#define RADIAL_CLASSES                                                                             \
    3 // lamps that are marched, further lamps, VPLs: each with its own size of grid

struct radial_class {
    tyn_uint first_light;
    tyn_uint count;
    tyn_uint cells; // of the map along each side
    tyn_uint shells;
    tyn_uint per_row;     // tiles side by side along x, and along y
    tyn_uint first_layer; // of the textures
    tyn_uint patches;     // workgroups per light along each side
};

struct radial_beam_args {
    tyn_uint num_lamps;
    tyn_uint max_vpls;
    tyn_uvec3 size; // of the textures
    TYN_STRUCT(radial_class) classes[RADIAL_CLASSES];
};
TYN_ASSERT_SIZE(radial_beam_args, 104);

#define RADIAL_GROUP 8 // threads of a workgroup along each side of a map
