// projection.h -- where a frame is seen from: the one place that turns a camera or matrices into rays and depths.
#pragma once
#include <tyndall/context.h>

// Pixel (x, y) of the whole picture, width x height, row 0 on top, is at s = 2 (x + 0.5) / width - 1,
// t = 1 - 2 (y + 0.5) / height. Its ray: perspective from `origin` along forward + (s + shift[0]) half[0] right +
// (t + shift[1]) half[1] up; orthographic along `forward`, from origin + the same across. Vectors are unit and at right
// angles, `right` and `up` in either sense.
typedef struct tyn_frame_projection {
    double origin[3], right[3], up[3], forward[3]; // world, m
    double half[2];                                // at 1 m (perspective) or in m (orthographic)
    double shift[2];                               // half sizes; jitter included
    bool orthographic;
    // Of the host's depth: (depth[0] z + depth[1]) / (depth[2] z + depth[3]) at z = -distance along `forward` from `origin`.
    float depth[4];
} tyn_frame_projection;

// Has the view pixels that are a part of `whole`, from `corner` on?
bool tyn_frame_is_part(const tyn_view *view);
// What of the frame is not fit is one log line and TYN_ERR_PARAMS.
tyn_result tyn_frame_projection_find(tyn_frame_projection *out, const tyn_frame *frame,
                                     const tyn_log *log);
