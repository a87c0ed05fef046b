// projection.c -- see projection.h.
#include "frame/projection.h"
#include "base/fault.h"
#include "scene/check.h"
#include "scene/matrix.h"
#include <math.h>
#include <string.h>

// Smaller than this, against what it is made of, is what rounding of floats leaves of 0.
static const double TINY = 1e-6, ASKEW = 1e-4;

// Where a . p = -a[3] for each of three rows; false: nowhere or not in one point.
static bool meet(const double a[4], const double b[4], const double c[4], double p[3])
{
    double across[3][3];
    const double det = mat_cofactors(across, a, b, c);
    const double size = vec_length(a) * vec_length(b) * vec_length(c);
    for (int i = 0; i < 3; i++) {
        p[i] = -(a[3] * across[0][i] + b[3] * across[1][i] + c[3] * across[2][i]) / det;
    }
    return fabs(det) > TINY * size;
}

// Clip x, y, z and w as linear functions of a world position, and the view's z.
typedef struct clip_rows {
    double x[4], y[4], z[4], w[4], view_z[4];
} clip_rows;

static clip_rows rows_of(const tyn_frame *frame)
{
    clip_rows rows;
    double *clip[4] = {rows.x, rows.y, rows.z, rows.w};
    for (int column = 0; column < 4; column++) {
        const float *v = frame->world_to_view + 4 * column;
        for (int row = 0; row < 4; row++) {
            double sum = 0;
            for (int k = 0; k < 4; k++) {
                sum += (double)frame->view_to_clip[4 * k + row] * (double)v[k];
            }
            clip[row][column] = sum;
        }
        rows.view_z[column] = (double)v[2];
    }
    return rows;
}

// From the edges of the picture per unit of clip x / w and y / w, `x` and `y` (y runs down), and the way to its middle.
static tyn_result set_picture(tyn_frame_projection *out, const double x[3], const double y[3],
                              const double middle[3], const tyn_log *log)
{
    out->half[0] = vec_length(x);
    out->half[1] = vec_length(y);
    for (int a = 0; a < 3; a++) {
        out->right[a] = x[a] / out->half[0];
        out->up[a] = -y[a] / out->half[1];
    }
    if (fabs(vec_dot(out->right, out->up)) > ASKEW) {
        FAULT("view_to_clip x world_to_view: the picture's sides must be at right angles (the "
              "cosine between them is %g)",
              vec_dot(out->right, out->up));
    }
    out->shift[0] = vec_dot(middle, out->right) / out->half[0];
    out->shift[1] = vec_dot(middle, out->up) / out->half[1];
    return TYN_OK;
}

static tyn_result from_perspective(tyn_frame_projection *out, const clip_rows *r,
                                   const tyn_log *log)
{
    double x[3], y[3], middle[3];
    vec_cross(x, r->y, r->w);
    vec_cross(y, r->w, r->x);
    vec_cross(middle, r->x, r->y);
    const double length = vec_length(r->w), det = vec_dot(r->w, middle);
    if (!meet(r->x, r->y, r->w, out->origin)) {
        FAULT("view_to_clip x world_to_view is singular: its rows x, y and w must meet in one eye");
    }
    // In front of the eye w > 0; the ray to (s, t) is (x - s w) x (y - t w), here 1 m far along `forward`.
    for (int a = 0; a < 3; a++) {
        out->forward[a] = r->w[a] / length;
        x[a] *= length / det;
        y[a] *= length / det;
        middle[a] *= length / det;
    }
    return set_picture(out, x, y, middle, log);
}

static tyn_result from_orthographic(tyn_frame_projection *out, const clip_rows *r,
                                    const tyn_log *log)
{
    double x[3], y[3], across[3];
    const double w = r->w[3], none[3] = {0, 0, 0};
    vec_cross(across, r->x, r->y);
    const double length = vec_length(across);
    if (w == 0 || !(length > TINY * vec_length(r->x) * vec_length(r->y)) ||
        !meet(r->x, r->y, r->view_z, out->origin)) {
        FAULT("view_to_clip x world_to_view is singular: parallel rays need rows x, y and view z "
              "that are independent, and "
              "a w that is not 0 (it is %g)",
              w);
    }
    const double sign = vec_dot(across, r->view_z) < 0 ? 1 : -1; // views look along -z
    for (int a = 0; a < 3; a++) {
        out->forward[a] = sign * across[a] / length;
    }
    vec_cross(x, r->y, out->forward);
    vec_cross(y, out->forward, r->x);
    const double scale = w / (sign * length); // w / det(x, y, forward)
    for (int a = 0; a < 3; a++) {
        x[a] *= scale;
        y[a] *= scale;
    }
    out->orthographic = true;
    return set_picture(out, x, y, none, log);
}

static tyn_result set_depth(tyn_frame_projection *out, const clip_rows *r, bool wanted,
                            const tyn_log *log)
{
    const double w = out->orthographic ? r->w[3] : vec_length(r->w),
                 along = vec_dot(r->z, out->forward);
    const double at_origin = vec_dot(r->z, out->origin) + r->z[3];
    double aside = 0;
    for (int a = 0; a < 3; a++) {
        aside = fmax(aside, fabs(r->z[a] - along * out->forward[a]));
    }
    out->depth[0] = (float)(-along / w);
    out->depth[1] = (float)(at_origin / w);
    out->depth[2] = out->orthographic ? 0 : -1;
    out->depth[3] = out->orthographic ? 1 : 0;
    if (wanted && aside > ASKEW * vec_length(r->z)) {
        FAULT("view_to_clip: with `depth` clip z must change along the view alone; an oblique near "
              "plane is not understood");
    }
    return TYN_OK;
}

static tyn_result from_matrices(tyn_frame_projection *out, const tyn_frame *frame,
                                const tyn_log *log)
{
    const float *v = frame->world_to_view;
    if (!vec_finite(v, 16) || !vec_finite(frame->view_to_clip, 16)) {
        FAULT("world_to_view and view_to_clip must be finite");
    }
    if (v[3] != 0 || v[7] != 0 || v[11] != 0 || v[15] != 1) {
        FAULT("world_to_view: its last row is %g %g %g %g; it must be 0 0 0 1 (matrices are stored "
              "by columns)",
              v[3], v[7], v[11], v[15]);
    }
    const clip_rows rows = rows_of(frame);
    const double most = fmax(vec_length(rows.x), vec_length(rows.y));
    const bool parallel = vec_length(rows.w) <= TINY * most;
    const tyn_result result =
        parallel ? from_orthographic(out, &rows, log) : from_perspective(out, &rows, log);
    return result == TYN_OK ? set_depth(out, &rows, frame->depth != NULL, log) : result;
}

static tyn_result from_camera(tyn_frame_projection *out, const tyn_frame *frame, const tyn_log *log)
{
    const tyn_view *view = frame->view;
    const tyn_camera *camera = &view->camera;
    const float *m = frame->view_to_clip;
    TYN_TRY(tyn_camera_check(camera, 0, log));
    for (int a = 0; a < 3; a++) {
        out->origin[a] = (double)camera->position[a];
        out->right[a] = (double)camera->right[a];
        out->up[a] = (double)camera->up[a];
        out->forward[a] = -(double)camera->back[a];
    }
    out->orthographic = camera->projection == TYN_ORTHOGRAPHIC;
    const float half = out->orthographic ? camera->ymag : tanf(camera->yfov * 0.5f);
    out->half[1] = (double)half;
    const uint32_t *whole =
        view->whole[0] ? view->whole : (const uint32_t[2]){view->width, view->height};
    out->half[0] = (double)(half * (whole[1] ? (float)whole[0] / (float)whole[1] : 1));
    memcpy(out->depth, (const float[4]){m[10], m[14], m[11], m[15]}, sizeof out->depth);
    return TYN_OK;
}

bool tyn_frame_is_part(const tyn_view *view)
{
    const uint32_t size[2] = {view->width, view->height};
    bool part = true;
    for (int a = 0; a < 2; a++) {
        const uint32_t whole = view->whole[a];
        part = part && size[a] >= 1 && whole <= 65536 && size[a] <= whole &&
               view->corner[a] <= whole - size[a];
    }
    return part;
}

tyn_result tyn_frame_projection_find(tyn_frame_projection *out, const tyn_frame *frame,
                                     const tyn_log *log)
{
    static const float none[16] = {0};
    *out = (tyn_frame_projection){0};
    TYN_TRY(memcmp(frame->world_to_view, none, sizeof none) == 0 ? from_camera(out, frame, log)
                                                                 : from_matrices(out, frame, log));
    const tyn_view *view = frame->view;
    const bool part = view->whole[0] || view->whole[1];
    if (part && !tyn_frame_is_part(view)) {
        FAULT("view: %u x %u pixels from (%u, %u) on are no part of %u x %u (65536 at most)",
              view->width, view->height, view->corner[0], view->corner[1], view->whole[0],
              view->whole[1]);
    }
    if (!vec_finite(frame->jitter, 2)) {
        FAULT("jitter is %g, %g; it must be finite, pixels", frame->jitter[0], frame->jitter[1]);
    }
    out->shift[0] += 2 * (double)frame->jitter[0] / (part ? view->whole[0] : view->width);
    out->shift[1] -= 2 * (double)frame->jitter[1] / (part ? view->whole[1] : view->height);
    const float *d = out->depth;
    // z can be told from depth if that is no constant.
    if (frame->depth && (!vec_finite(frame->view_to_clip, 16) || d[0] * d[3] == d[1] * d[2])) {
        FAULT("view_to_clip: its third and fourth row must tell view z from depth (they are %g %g "
              "and %g %g in z and 1)",
              frame->view_to_clip[10], frame->view_to_clip[14], frame->view_to_clip[11],
              frame->view_to_clip[15]);
    }
    return TYN_OK;
}
