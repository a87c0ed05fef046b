// shadow_cull.h -- which triangles a view of the surfaces may show.
#pragma once
#include <tyndall/scene.h>
#include "shaders/surfaces/surface_args.h"

// What was found for views of frames before: lights seldom move. All zero at first, as for other surfaces.
enum { TYN_VIEWS_SEEN = 1024 }; // shadow maps and reflective ones of all lights
typedef struct tyn_views_seen {
    struct tyn_view_seen {
        tyn_vec4 clip[4];
        struct surface_range drawn[TYN_SURFACE_RANGES];
        bool known;
    } views[TYN_VIEWS_SEEN];
} tyn_views_seen;

// Of every node of the hierarchy the range that holds the triangles below it; NULL without a hierarchy or
// memory. Freed by the caller.
struct surface_range *tyn_views_prepare(const tyn_surfaces *surfaces);

// All triangles in the frustum of `clip` (rows, world -> clip space, 0 <= z <= w), and some others. `below` is
// what tyn_views_prepare gave; NULL: all triangles.
void tyn_view_cull(const tyn_surfaces *surfaces, const struct surface_range *below,
                   const tyn_vec4 clip[4], struct surface_range drawn[TYN_SURFACE_RANGES]);

// The same; found anew only if `clip` is not that of this view, view < TYN_VIEWS_SEEN, at the last call.
void tyn_view_cull_seen(tyn_views_seen *seen, uint32_t view, const tyn_surfaces *surfaces,
                        const struct surface_range *below, const tyn_vec4 clip[4],
                        struct surface_range drawn[TYN_SURFACE_RANGES]);
