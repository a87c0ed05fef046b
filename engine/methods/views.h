// views.h -- which triangles a view of the surfaces may show.
#pragma once
#include <tyndall/scene.h>
#include "surface_args.h"

// Of every node of the hierarchy the range that holds the triangles below it; NULL without a hierarchy or
// memory. Freed by the caller.
struct surface_range *tyn_views_prepare(const tyn_surfaces *surfaces);

// All triangles in the frustum of `clip` (rows, world -> clip space, 0 <= z <= w), and some others. `below` is
// what tyn_views_prepare gave; NULL: all triangles.
void tyn_view_cull(const tyn_surfaces *surfaces, const struct surface_range *below,
                   const tyn_vec4 clip[4], struct surface_range drawn[TYN_SURFACE_RANGES]);
