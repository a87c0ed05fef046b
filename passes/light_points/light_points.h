// light_points.h -- where the texels of a light field are: the middles of the cells of a grid over the media's box.
#pragma once
#include <tyndall/pass.h>
#include "light_points_args.h"

typedef struct light_points_args tyn_light_points_params;

// clang-format off
#define LIGHT_POINTS_PORTS(X) \
    X(LIGHT_POINTS, MEDIUM, medium, IN, BUFFER, "struct medium_block"), \
    X(LIGHT_POINTS, POINTS, points, OUT, BUFFER, "vec3[], m, x fastest")
// clang-format on
TYN_PASS(LIGHT_POINTS, light_points);
