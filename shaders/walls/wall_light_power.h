// wall_light_power.h -- what the pass wall_light tells of the light that virtual point lights send to walls. Included by C
// and GLSL.
#ifndef TYN_WALL_LIGHT_POWER_H
#define TYN_WALL_LIGHT_POWER_H
#include "shaders/common/shared.h"

#define WALL_LIGHT_VPLS 256 // as many as there may be (TYN_RADIAL_VPLS_MAX)

// What virtual point lights (VPLs) send to walls, and the factors that make the walls of each room get it. A room goes by
// the first VPL that shines there; without rooms all are in one.
struct wall_light_power {
    tyn_uint rooms;    // that VPLs shine in, and whose walls get light
    float least, most; // factor
    float astray; // of all that is sent, what goes to rooms where no wall of the lattice gets any
    tyn_uint room[WALL_LIGHT_VPLS];     // rooms.h
    tyn_vec3 expected[WALL_LIGHT_VPLS]; // W
    tyn_vec3 scale[WALL_LIGHT_VPLS];    // of rooms
};
TYN_ASSERT_SIZE(wall_light_power, 7184);

#endif
