// timing.c -- medians of frame times: everything anew, or only what a change needs.
#include "timing.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double step_angle = 0.5 * 3.14159265358979323846 / 180; // each frame, about +Y

static const float step_share = 0.01f; // of the strength of what gets darker

static void turn(float v[3], double radians)
{
    const double c = cos(radians), s = sin(radians), x = v[0], z = v[2];
    v[0] = (float)(c * x + s * z);
    v[2] = (float)(c * z - s * x);
}

void timing_turn_camera(const tyn_scene *scene, tyn_camera *camera, double radians)
{
    float lo[3], hi[3], offset[3];
    tyn_scene_bounds(scene, lo, hi);
    for (int i = 0; i < 3; i++) {
        offset[i] = camera->position[i] - 0.5f * (lo[i] + hi[i]);
    }
    turn(offset, radians);
    turn(camera->right, radians);
    turn(camera->up, radians);
    turn(camera->back, radians);
    for (int i = 0; i < 3; i++) {
        camera->position[i] = offset[i] + 0.5f * (lo[i] + hi[i]);
    }
}

// The environment turns as well: its rotation q becomes that about +Y times q. Point lights look the same from all sides: they
// get darker.
static void step_lights(tyn_scene *scene)
{
    for (uint32_t i = 0; i < scene->num_lights; i++) {
        tyn_light *light = &scene->lights[i];
        turn(light->direction, step_angle);
        for (int c = 0; c < 3 && light->kind == TYN_LIGHT_POINT; c++) {
            light->color[c] *= 1 - step_share;
        }
    }
    float *q = scene->environment.rotation;
    const float w = q[0] == 0 && q[1] == 0 && q[2] == 0 && q[3] == 0 ? 1 : q[3];
    const float s = (float)sin(0.5 * step_angle), c = (float)cos(0.5 * step_angle);
    const float turned[4] = {c * q[0] + s * q[2], c * q[1] + s * w, c * q[2] - s * q[0],
                             c * w - s * q[1]};
    memcpy(q, turned, sizeof turned);
}

static bool can_change(const tyn_scene *scene, timing_change change)
{
    const tyn_environment *e = &scene->environment;
    return change == TIMING_LIGHT ? scene->num_lights || (e->present && e->size[0])
           : change == TIMING_SKY ? e->present
                                  : true;
}

static int by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double timing_median(double *values, uint32_t count)
{
    if (count == 0) {
        return NAN;
    }
    qsort(values, count, sizeof *values, by_value);
    return 0.5 * (values[(count - 1) / 2] + values[count / 2]);
}

// Changes what `change` says, by a step.
static void step(tyn_scene *scene, tyn_camera *camera, timing_change change)
{
    if (change == TIMING_CAMERA) {
        timing_turn_camera(scene, camera, step_angle);
    } else if (change == TIMING_LIGHT) {
        step_lights(scene);
    } else if (change == TIMING_SKY) {
        scene->environment.strength =
            tyn_environment_strength(&scene->environment) * (1 - step_share);
    }
}

// The first frame after a change is not timed: drivers compile in it what only such frames need. One sample does.
static int warm_up(app *a, renderer *r, tyn_scene *scene, tyn_view *view, timing_change change)
{
    if (change == TIMING_COLD || change == TIMING_UNCHANGED) {
        return EXIT_DONE;
    }
    step(scene, &view->camera, change);
    tyn_view single = *view;
    single.num_samples = 1;
    return renderer_frame(a, r, scene, &single, false, NULL);
}

int timing_run(app *a, renderer *r, tyn_scene *scene, const tyn_view *view, timing_change change,
               uint32_t frames, double *median_ms)
{
    if (!can_change(scene, change)) {
        app_warn(a, "there is no %s that could change", change == TIMING_SKY ? "sky" : "light");
    }
    double *values = calloc(frames, sizeof *values);
    int code = values ? EXIT_DONE : app_exit_code(a, TYN_ERR_MEMORY, false);
    tyn_view moving = *view;
    progress_start(&a->bar, "timing", a->quiet);
    code = code == EXIT_DONE ? warm_up(a, r, scene, &moving, change) : code;
    for (uint32_t i = 0; i < frames && code == EXIT_DONE; i++) {
        step(scene, &moving.camera, change);
        code = renderer_frame(a, r, scene, &moving, change == TIMING_COLD, NULL);
        if (code == EXIT_DONE) {
            values[i] = r->frame_ms;
            progress_update(&a->bar, (i + 1.0) / frames);
        }
    }
    progress_stop(&a->bar);
    if (code == EXIT_DONE) {
        *median_ms = timing_median(values, frames);
    }
    free(values);
    return code;
}
