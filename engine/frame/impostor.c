// impostor.c -- see impostor.h.
#include "frame/impostor.h"
#include "base/hash.h"
#include "passes/impostor/impostor.h"
#include "passes/impostor_camera/impostor_camera.h"
#include "passes/raymarch/raymarch.h"
#include <math.h>
#include <string.h>

static bool marches(const tyn_job *job)
{
    bool found = false;
    for (uint32_t i = 0; job->method->passes[i]; i++) {
        found = found || job->method->passes[i] == &tyn_pass_raymarch;
    }
    return found;
}

static bool allows(const tyn_job *job)
{
    const uint32_t seen = TYN_OUTPUT_DEPTH | TYN_OUTPUT_SINGLE | TYN_OUTPUT_MULTIPLE;
    const uint32_t read = job->outputs | tyn_job_hooks_read(job);
    return job->outputs & TYN_PICTURE_OUTPUTS && !(read & seen) && !job->frame->num_triangles &&
           !job->frame->empty && !job->refs.depth.resource && !tyn_is_periodic(job->frame) &&
           marches(job);
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// The camera at the same place that sees the ball around the box, and how far away its middle is, m. False: it is too near.
static bool face(const struct camera_block *from, const float extent[3], struct camera_block *to,
                 double *away)
{
    double way[3], radius2 = 0, side[3], up[3];
    for (int a = 0; a < 3; a++) {
        way[a] = 0.5 * (double)extent[a] - (double)from->origin[a];
        radius2 += 0.25 * (double)extent[a] * (double)extent[a];
    }
    const double radius = sqrt(radius2), distance2 = dot(way, way);
    *to = *from;
    *away = from->orthographic ? 2 * radius : sqrt(distance2);
    if (!(*away > 1.2 * radius)) {
        return false;
    }
    for (int a = 0; a < 3; a++) {
        way[a] = from->orthographic ? (double)from->forward[a] : way[a] / *away;
    }
    // Upright as the view is, unless it looks aside.
    const float *like = fabs((double)from->right[0] * way[0] + (double)from->right[1] * way[1] +
                             (double)from->right[2] * way[2]) < 0.9
                            ? from->right
                            : from->forward;
    const double right[3] = {(double)like[0], (double)like[1], (double)like[2]};
    for (int a = 0; a < 3; a++) {
        side[a] = right[a] - dot(right, way) * way[a];
    }
    const double length = sqrt(dot(side, side));
    for (int a = 0; a < 3; a++) {
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        up[a] = (side[b] * way[c] - side[c] * way[b]) / length;
    }
    for (int a = 0; a < 3; a++) {
        to->forward[a] = (float)way[a];
        to->right[a] = (float)(side[a] / length);
        to->up[a] = (float)up[a];
        if (from->orthographic) {
            to->origin[a] = (float)(0.5 * (double)extent[a] - *away * way[a]);
        }
    }
    to->half_width = to->half_height =
        (float)(from->orthographic ? radius : radius / sqrt(distance2 - radius2));
    to->shift[0] = to->shift[1] = 0;
    memset(to->corner, 0, sizeof to->corner);
    memset(to->beyond, 0, sizeof to->beyond);
    return true;
}

// The same for views whose directions to the media differ by no more than `angle`, and their distances by no more than a part
// of `distance`: they are sorted into cells of these sizes.
static uint64_t key_of(const struct camera_block *c, double away, const float extent[3],
                       const tyn_impostor_params *p)
{
    const double cell = (double)p->angle * 3.14159265358979 / 180 / sqrt(2.0);
    int most = 0;
    for (int a = 1; a < 3; a++) {
        most = fabsf(c->forward[a]) > fabsf(c->forward[most]) ? a : most;
    }
    int32_t cells[5] = {most, c->forward[most] > 0, 0, 0, 0};
    for (int k = 0; k < 2; k++) {
        const float along = c->forward[(most + 1 + k) % 3] / c->forward[most];
        cells[2 + k] = (int32_t)floor(atan((double)along) / cell);
    }
    cells[4] = c->orthographic ? 0 : (int32_t)floor(log(away) / log(1 + (double)p->distance));
    uint64_t key = tyn_hash_bytes(TYN_HASH_SEED, cells, sizeof cells);
    key = tyn_hash_bytes(key, extent, 3 * sizeof *extent);
    key = tyn_hash_bytes(key, &c->orthographic, sizeof c->orthographic);
    key = tyn_hash_bytes(key, c->size, sizeof c->size);
    return key ? key : 1;
}

void tyn_frame_impostor(tyn_context *ctx, tyn_job *job)
{
    tyn_impostor_params params;
    double away;
    const float *extent = job->frame->medium.extent;
    if (!allows(job)) {
        return;
    }
    tyn_settings_params(job->settings, &tyn_pass_impostor, &params);
    if (!params.on || !face(&job->frame->camera, extent, &ctx->impostor, &away)) {
        return;
    }
    const uint64_t key = key_of(&ctx->impostor, away, extent, &params);
    const tyn_impostor_camera_params held = {
        .size = {job->view->width, job->view->height},
        .hold = {.key = key, .frames = UINT32_MAX},
    };
    tyn_ref refs[TYN_MAX_PORTS] = {
        [IMPOSTOR_CAMERA_PORT_CAMERA] = tyn_graph_upload_buffer(
            ctx->graph, "impostor_view", &ctx->impostor, sizeof ctx->impostor, 0),
        [IMPOSTOR_CAMERA_PORT_TAKEN] =
            tyn_graph_history_buffer(ctx->graph, "impostor_taken", sizeof ctx->impostor, key),
    };
    tyn_graph_add(ctx->graph, &tyn_pass_impostor_camera, &held, refs);
    job->refs.shown_camera = job->refs.camera;
    job->refs.camera = refs[IMPOSTOR_CAMERA_PORT_TAKEN];
}
