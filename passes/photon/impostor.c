// impostor.c -- a hook that shows a march of some frames ago as another camera sees it, until the view has changed too much.
#include <tyndall/extend/hash.h>
#include "impostor/impostor.h"
#include "impostor_camera/impostor_camera.h"
#include <tyndall/extend/method.h>
#include <math.h>
#include <string.h>

static bool marches(const tyn_job *job)
{
    bool found = false;
    for (uint32_t i = 0; job->method->passes[i]; i++) {
        found = found || !strcmp(job->method->passes[i]->name, "raymarch");
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

static void prepare(tyn_graph *g, tyn_job *job)
{
    tyn_impostor_params params;
    tyn_impostor_camera_params held = {.size = {job->view->width, job->view->height},
                                       .hold = {.frames = UINT32_MAX}};
    double away;
    const float *extent = job->frame->medium.extent;
    if (!allows(job)) {
        return;
    }
    tyn_settings_params(job->settings, &tyn_pass_impostor, &params);
    if (!params.on || !face(&job->frame->camera, extent, &held.camera, &away)) {
        return;
    }
    held.hold.key = key_of(&held.camera, away, extent, &params);
    tyn_ref refs[TYN_MAX_PORTS] = {
        [IMPOSTOR_CAMERA_PORT_TAKEN] =
            tyn_graph_history_buffer(g, "impostor_taken", sizeof held.camera, held.hold.key),
    };
    tyn_graph_add(g, &tyn_pass_impostor_camera, &held, refs);
    job->refs.shown_camera = job->refs.camera;
    job->refs.camera = refs[IMPOSTOR_CAMERA_PORT_TAKEN];
}

static uint32_t reads(const tyn_job *job)
{
    return job->refs.shown_camera.resource ? TYN_OUTPUT_RADIANCE | TYN_OUTPUT_TRANSMITTANCE : 0;
}

// Over a host's picture only the medium is laid.
static bool is_background_seen(const tyn_job *job)
{
    const struct env_block *env = &job->frame->environment;
    return (env->has_map || tyn_is_lit(env->radiance)) && !job->view->no_background &&
           !(job->outputs & TYN_OUTPUT_COMPOSITE);
}

// The march as the view's camera sees it.
static void show(tyn_graph *g, const tyn_job *job, tyn_picture *picture)
{
    tyn_impostor_params params;
    tyn_settings_params(job->settings, &tyn_pass_impostor, &params);
    params.width = job->view->width;
    params.height = job->view->height;
    params.background = is_background_seen(job);
    tyn_ref refs[TYN_MAX_PORTS] = {
        [IMPOSTOR_PORT_MEDIUM] = job->refs.medium,
        [IMPOSTOR_PORT_TAKEN] = job->refs.camera,
        [IMPOSTOR_PORT_CAMERA] = job->refs.shown_camera,
        [IMPOSTOR_PORT_ENVIRONMENT] = job->refs.environment,
        [IMPOSTOR_PORT_ENV_MAP] = job->refs.env_map,
        [IMPOSTOR_PORT_MARCHED] = picture->radiance,
        [IMPOSTOR_PORT_LEFT] = picture->transmittance,
    };
    tyn_graph_add(g, &tyn_pass_impostor, &params, refs);
    picture->radiance = refs[IMPOSTOR_PORT_RADIANCE];
    picture->transmittance = refs[IMPOSTOR_PORT_TRANSMITTANCE];
}

static const char *const passes[] = {"impostor_camera", "impostor", NULL};
const tyn_picture_hook tyn_hook_impostor = {"impostor", reads, show, prepare, "composite", passes};
