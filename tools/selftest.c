// selftest.c -- what the checks of `tyndall selftest` share: a check's line, a frame, a mean.
#include "selftest.h"
#include "scene_setup.h"
#include <math.h>
#include <stdio.h>

static void add_json(selftest *t, const char *name, const char *state, const char *source,
                     cJSON **check)
{
    *check = cJSON_CreateObject();
    cJSON_AddStringToObject(*check, "name", name);
    cJSON_AddStringToObject(*check, "state", state);
    cJSON_AddStringToObject(*check, "source", source);
    cJSON_AddItemToArray(t->checks, *check);
}

void selftest_check(selftest *t, const char *name, double value, double expected, double tolerance,
                    const char *source)
{
    const bool ok = fabs(value - expected) <= tolerance; // false for NaN
    t->num_checks++;
    t->num_failed += !ok;
    if (!t->json) {
        printf("%-7s %-50s %11.6g, expected %.6g +- %.2g (%s)\n", ok ? "ok" : "FAILED", name, value,
               expected, tolerance, source);
        fflush(stdout);
        return;
    }
    cJSON *check;
    add_json(t, name, ok ? "ok" : "failed", source, &check);
    cJSON_AddBoolToObject(check, "ok", ok);
    cJSON_AddItemToObject(check, "value",
                          isfinite(value) ? cJSON_CreateNumber(value) : cJSON_CreateNull());
    cJSON_AddNumberToObject(check, "expected", expected);
    cJSON_AddNumberToObject(check, "tolerance", tolerance);
}

void selftest_skip(selftest *t, const char *name, const char *why)
{
    t->num_skipped++;
    if (!t->json) {
        printf("%-7s %s: %s\n", "skipped", name, why);
        return;
    }
    cJSON *check;
    add_json(t, name, "skipped", why, &check);
}

bool selftest_next(uint32_t *index, tyn_method_info *info, const tyn_promise **promise)
{
    for (*promise = NULL; *index < tyn_num_methods() && !*promise; ++*index) {
        tyn_method_at(*index, info);
        *promise = info->promise;
    }
    return *promise != NULL;
}

int selftest_render(selftest *t, const char *name, tyn_scene *scene, const tyn_view *view,
                    renderer *r)
{
    method m = {0};
    *r = (renderer){0};
    int code = method_open(t->a, &(method_options){.method = name}, &m);
    if (code == EXIT_DONE) {
        code = scene_prepare(t->a, &m.info, scene);
    }
    if (code == EXIT_DONE) {
        code = renderer_open(t->a, t->device, &m, r);
    }
    if (code == EXIT_DONE) {
        code = renderer_frame(t->a, r, scene, view, false, name);
    }
    method_finish(&m);
    if (code != EXIT_DONE) {
        renderer_close(r);
    }
    return code;
}

tyn_view selftest_picture(uint32_t outputs)
{
    return (tyn_view){.width = SELFTEST_SIZE,
                      .height = SELFTEST_SIZE,
                      .outputs = outputs,
                      .num_samples = SELFTEST_SAMPLES};
}

int selftest_render_cube(selftest *t, const char *name, uint32_t samples, renderer *r)
{
    tyn_view view = selftest_picture(TYN_OUTPUT_RADIANCE);
    view.num_samples = samples;
    selftest_camera(&view.camera, -0.5f, -0.7f, -0.4f, 0.9f);
    tyn_scene scene;
    selftest_cube(&scene, 0.5f, false);
    int code = selftest_render(t, name, &scene, &view, r);
    tyn_scene_finish(&scene);
    return code;
}

double selftest_mean(const float *pixels, const float *errors, double *se)
{
    enum { PIXELS = SELFTEST_SIZE * SELFTEST_SIZE };
    double sum = 0, variance = 0;
    for (int i = 0; i < PIXELS; i++) {
        for (int c = 0; c < 3; c++) {
            sum += pixels[4 * i + c];
            variance += errors ? (double)errors[4 * i + c] * errors[4 * i + c] : 0;
        }
    }
    // Channels of one path are not independent: as if they were one and the same.
    *se = sqrt(3 * variance) / (3 * PIXELS);
    return sum / (3 * PIXELS);
}
