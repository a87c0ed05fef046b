// refine_points.h -- where the field is asked for in which paths end: the middles of the cells of a grid over the media's box.
#pragma once
#include <tyndall/pass.h>
#include "refine_points_args.h"

typedef struct refine_grid_args tyn_refine_points_params;

// clang-format off
#define REFINE_POINTS_PORTS(X) \
    X(REFINE_POINTS, POINTS, points, OUT, BUFFER, "vec3[], M, m, x fastest")
// clang-format on
TYN_PASS(REFINE_POINTS, refine_points);
