// cmd_selftest.c -- `tyndall selftest`: does this machine compute what is known to be right?
//
// Loads no files. The expected values are closed forms, or rows of reference tables that were computed
// for this project: the slab with DISORT 4.0.99 (128 streams, fluxes to 1e-6), the cube with pbrt-v3
// (standard error of an image mean below 0.1 %).
#include "devices.h"
#include "renderer.h"
#include "selftest_scenes.h"
#include "stats.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct selftest_args {
    machine_options machine;
    bool json;
} selftest_args;

enum {
    SIZE = 32,               // pixels
    PATH_SAMPLES = 64,       // a pixel
    PROBE_SAMPLES = 1 << 18, // a point
    BALANCE_SAMPLES = 256,   // of many thousand paths each
};

// One check is |value - expected| <= tolerance.
typedef struct selftest {
    app *a;
    const selftest_args *args;
    tyn_device *device;
    cJSON *checks;
    uint32_t num_failed;
} selftest;

static void report(selftest *t, const char *name, double value, double expected, double tolerance)
{
    bool ok = fabs(value - expected) <= tolerance; // false for NaN
    t->num_failed += !ok;
    if (!t->args->json) {
        printf("%-6s %-44s %12.6g, expected %.6g +- %.2g\n", ok ? "ok" : "FAILED", name, value,
               expected, tolerance);
        fflush(stdout);
        return;
    }
    cJSON *check = cJSON_CreateObject();
    cJSON_AddStringToObject(check, "name", name);
    cJSON_AddBoolToObject(check, "ok", ok);
    cJSON_AddNumberToObject(check, "value", value);
    cJSON_AddNumberToObject(check, "expected", expected);
    cJSON_AddNumberToObject(check, "tolerance", tolerance);
    cJSON_AddItemToArray(t->checks, check);
}

// Renders with a method; `r` is open afterwards if the exit code is EXIT_DONE.
static int compute(selftest *t, const char *name, const tyn_scene *scene, const tyn_view *view,
                   renderer *r)
{
    method m = {0};
    *r = (renderer){0};
    int code = method_open(t->a, &(method_options){.method = name}, &m);
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

static tyn_view picture(tyn_output outputs)
{
    return (tyn_view){
        .width = SIZE, .height = SIZE, .outputs = outputs, .num_samples = PATH_SAMPLES};
}

// Mean over pixels and channels, and its standard error if `errors` is there.
static double mean_of(const float *pixels, const float *errors, double *se)
{
    double sum = 0, variance = 0;
    for (int i = 0; i < SIZE * SIZE; i++) {
        for (int c = 0; c < 3; c++) {
            sum += pixels[4 * i + c];
            variance += errors ? (double)errors[4 * i + c] * errors[4 * i + c] : 0;
        }
    }
    // Channels of one path are not independent: as if they were one and the same.
    *se = sqrt(3 * variance) / (3 * SIZE * SIZE);
    return sum / (3 * SIZE * SIZE);
}

static double worst_of(const float *pixels, double expected)
{
    double worst = 0;
    for (int i = 0; i < SIZE * SIZE; i++) {
        for (int c = 0; c < 3; c++) {
            double off = fabs(pixels[4 * i + c] - expected);
            worst = off <= worst ? worst : off; // keeps NaN
        }
    }
    return worst;
}

// ---- the checks -------------------------------------------------------------------------------

// Nothing is absorbed and 1 comes from everywhere: 1 is seen everywhere.
static int check_furnace(selftest *t)
{
    static const float g[] = {0, 0.5f, 0.9f};
    renderer r;
    tyn_scene scene;
    int code = EXIT_DONE;
    for (size_t i = 0; i < ARRAY_SIZE(g) && code == EXIT_DONE; i++) {
        tyn_view view = picture(TYN_OUTPUT_RADIANCE);
        selftest_camera(&view.camera, -0.5f, -0.7f, -0.4f, 0.9f);
        selftest_cube(&scene, g[i], true);
        char name[64];
        snprintf(name, sizeof name, "furnace, pop, g %g: worst pixel off 1 by", g[i]);
        code = compute(t, "pop", &scene, &view, &r);
        if (code == EXIT_DONE) {
            report(t, name, worst_of(tyn_offline_output(r.offline, TYN_OUTPUT_RADIANCE), 1), 0,
                   0.005);
            renderer_close(&r);
            view.outputs |= TYN_OUTPUT_ERROR;
            code = compute(t, "path", &scene, &view, &r);
        }
        if (code == EXIT_DONE) {
            double se, mean = mean_of(tyn_offline_output(r.offline, TYN_OUTPUT_RADIANCE),
                                      tyn_offline_output(r.offline, TYN_OUTPUT_ERROR), &se);
            snprintf(name, sizeof name, "furnace, path, g %g: mean", g[i]);
            report(t, name, mean, 1, 4 * se + 1e-4);
            renderer_close(&r);
        }
        tyn_scene_finish(&scene);
    }
    return code;
}

// The cube's faces against reference images: their means.
static int check_cube(selftest *t)
{
    static const struct {
        const char *name;
        float x, y, z; // direction of view
        double g0, g5; // mean radiance at g 0 and 0.5
    } views[] = {
        {"side", 0, -1, 0, 0.0631537, 0.0623459},
        {"exit", -1, 0, 0, 0.0308069, 0.0972802},
        {"entry", 1, 0, 0, 0.108614, 0.0553141},
    };
    tyn_scene scene;
    renderer r;
    int code = EXIT_DONE;
    for (size_t i = 0; i < ARRAY_SIZE(views) && code == EXIT_DONE; i++) {
        double se, mean;
        char name[64];
        tyn_view view = picture(TYN_OUTPUT_RADIANCE);
        selftest_camera(&view.camera, views[i].x, views[i].y, views[i].z, 0.5f);
        selftest_cube(&scene, 0, false);
        code = compute(t, "pop", &scene, &view, &r);
        if (code == EXIT_DONE) {
            mean = mean_of(tyn_offline_output(r.offline, TYN_OUTPUT_RADIANCE), NULL, &se);
            snprintf(name, sizeof name, "cube, pop, g 0, %s view: mean", views[i].name);
            report(t, name, mean, views[i].g0, 0.03 * views[i].g0);
            renderer_close(&r);
        }
        tyn_scene_finish(&scene);
        selftest_cube(&scene, 0.5f, false);
        view.outputs |= TYN_OUTPUT_ERROR;
        code = code == EXIT_DONE ? compute(t, "path", &scene, &view, &r) : code;
        if (code == EXIT_DONE) {
            mean = mean_of(tyn_offline_output(r.offline, TYN_OUTPUT_RADIANCE),
                           tyn_offline_output(r.offline, TYN_OUTPUT_ERROR), &se);
            snprintf(name, sizeof name, "cube, path, g 0.5, %s view: mean", views[i].name);
            report(t, name, mean, views[i].g5, 4 * se + 0.001 * views[i].g5);
            renderer_close(&r);
        }
        tyn_scene_finish(&scene);
    }
    return code;
}

// A row of the slab table: flux up at the top, flux down at the bottom, fluence in the middle.
static int check_slab(selftest *t)
{
    static const double up = 0.12979328, down = 0.36787944 + 0.37121167, mean_middle = 0.10885558;
    const float points[3][3] = {{0.5f, 0.9999f, 0.5f}, {0.5f, 0.0001f, 0.5f}, {0.5f, 0.5f, 0.5f}};
    tyn_view view = {.width = 1,
                     .height = 1,
                     .outputs = TYN_OUTPUT_PROBE,
                     .num_samples = PROBE_SAMPLES,
                     .points = points,
                     .num_points = 3};
    selftest_camera(&view.camera, 0, 0, -1, 1);
    tyn_scene scene;
    selftest_slab(&scene);
    renderer r;
    int code = compute(t, "path", &scene, &view, &r);
    if (code == EXIT_DONE) {
        const tyn_probe_result *p = tyn_offline_output(r.offline, TYN_OUTPUT_PROBE);
        const double four_pi = 12.566370614359172;
        // y is the second axis, green the second channel
        report(t, "slab, path: net flux at the top", p[0].flux[4], up - 1,
               4 * p[0].flux_se[4] + 2e-4);
        report(t, "slab, path: net flux at the bottom", p[1].flux[4], -down,
               4 * p[1].flux_se[4] + 2e-4);
        report(t, "slab, path: fluence in the middle", p[2].fluence[1], four_pi * mean_middle,
               4 * p[2].fluence_se[1] + 1e-4);
        renderer_close(&r);
    }
    tyn_scene_finish(&scene);
    return code;
}

static int check_energy(selftest *t)
{
    static const char *const methods[] = {"pop", "path"};
    int code = EXIT_DONE;
    for (size_t i = 0; i < ARRAY_SIZE(methods) && code == EXIT_DONE; i++) {
        tyn_method_info info;
        if (!method_find(t->a, methods[i], &info)) {
            return EXIT_FAILED;
        }
        if (!(info.outputs & TYN_OUTPUT_BALANCE)) {
            continue;
        }
        tyn_view view = {
            .width = 1, .height = 1, .outputs = TYN_OUTPUT_BALANCE, .num_samples = BALANCE_SAMPLES};
        selftest_camera(&view.camera, 0, 0, -1, 1);
        tyn_scene scene;
        selftest_cube(&scene, 0.5f, false);
        renderer r;
        code = compute(t, methods[i], &scene, &view, &r);
        if (code == EXIT_DONE) {
            const tyn_balance *b = tyn_offline_output(r.offline, TYN_OUTPUT_BALANCE);
            char name[64];
            snprintf(name, sizeof name, "energy, %s: imbalance", methods[i]);
            report(t, name, b->imbalance[1], 0, 0.01);
            renderer_close(&r);
        }
        tyn_scene_finish(&scene);
    }
    return code;
}

// The same inputs give the same bytes.
static int check_repeats(selftest *t)
{
    static const char *const methods[] = {"pop", "path"};
    int code = EXIT_DONE;
    for (size_t i = 0; i < ARRAY_SIZE(methods) && code == EXIT_DONE; i++) {
        tyn_view view = picture(TYN_OUTPUT_RADIANCE);
        selftest_camera(&view.camera, -0.5f, -0.7f, -0.4f, 0.9f);
        tyn_scene scene;
        selftest_cube(&scene, 0.5f, false);
        uint64_t hash[2] = {0};
        for (int k = 0; k < 2 && code == EXIT_DONE; k++) {
            renderer r;
            code = compute(t, methods[i], &scene, &view, &r);
            if (code == EXIT_DONE) {
                hash[k] = text_hash(tyn_offline_output(r.offline, TYN_OUTPUT_RADIANCE),
                                    sizeof(float[4]) * SIZE * SIZE, 0);
                renderer_close(&r);
            }
        }
        tyn_scene_finish(&scene);
        if (code == EXIT_DONE) {
            char name[64];
            snprintf(name, sizeof name, "repeats, %s: differing pictures", methods[i]);
            report(t, name, hash[0] != hash[1], 0, 0);
        }
    }
    return code;
}

// A frame of each under the validation layers, where they are installed.
static int check_validation(selftest *t, const char *device)
{
    static const char *const methods[] = {"pop", "path"};
    tyn_device *own = t->device, *validating = NULL;
    tyn_result result =
        tyn_device_open(tyn_device_open_params(.select = device, .validation = true), &validating);
    if (result != TYN_OK) {
        if (!t->args->json) {
            printf("%-6s %s\n", "-", "validation: the layers are not installed");
        }
        return EXIT_DONE;
    }
    t->device = validating;
    int code = EXIT_DONE;
    for (size_t i = 0; i < ARRAY_SIZE(methods) && code == EXIT_DONE; i++) {
        tyn_view view = picture(TYN_OUTPUT_RADIANCE);
        view.num_samples = 1;
        selftest_camera(&view.camera, -0.5f, -0.7f, -0.4f, 0.9f);
        tyn_scene scene;
        selftest_cube(&scene, 0.5f, false);
        renderer r;
        code = compute(t, methods[i], &scene, &view, &r);
        if (code == EXIT_DONE) {
            renderer_close(&r);
        }
        tyn_scene_finish(&scene);
    }
    t->device = own;
    report(t, "validation, pop and path: messages", tyn_device_validation_messages(validating), 0,
           0);
    tyn_device_destroy(&validating);
    return code;
}

// The devices there are: what a report of a fault needs beside the checks.
static int report_devices(selftest *t, cJSON *list)
{
    devices d;
    int code = devices_list(t->a, &d);
    for (int i = 0; i < d.count; i++) {
        char *text = devices_describe(&d.infos[i]);
        if (t->args->json) {
            cJSON *device = cJSON_CreateObject();
            cJSON_AddStringToObject(device, "name", d.infos[i].name);
            cJSON_AddStringToObject(device, "about", text ? text : "");
            cJSON_AddItemToArray(list, device);
        } else {
            printf("device %d: %s, %s\n", i, d.infos[i].name, text ? text : "");
        }
        free(text);
    }
    devices_finish(&d);
    return code;
}

// ---- the command ------------------------------------------------------------------------------

static int run_checks(selftest *t, const char *device)
{
    int (*const checks[])(selftest *) = {check_furnace, check_cube, check_slab, check_energy,
                                         check_repeats};
    int code = EXIT_DONE;
    for (size_t i = 0; i < ARRAY_SIZE(checks) && code == EXIT_DONE; i++) {
        code = checks[i](t);
    }
    return code == EXIT_DONE ? check_validation(t, device) : code;
}

static int run_selftest(app *a, const void *arguments)
{
    const selftest_args *args = arguments;
    a->quiet = args->machine.quiet;
    cJSON *root = cJSON_CreateObject();
    selftest t = {.a = a, .args = args};
    cJSON_AddStringToObject(root, "tyndall", tyn_version_string());
    cJSON *list = cJSON_AddArrayToObject(root, "devices");
    machine mach = {0};
    double start = app_seconds();
    int code = report_devices(&t, list);
    if (code == EXIT_DONE) {
        code = machine_open(a, &args->machine, false, &mach);
    }
    if (code == EXIT_DONE) {
        t.device = mach.device;
        t.checks = cJSON_CreateArray();
        const char *name = tyn_device_name(mach.device), *driver = tyn_device_driver(mach.device);
        cJSON_AddStringToObject(root, "device", name);
        cJSON_AddStringToObject(root, "driver", driver);
        if (!args->json) {
            printf("tyndall %s on %s, %s\n", tyn_version_string(), name, driver);
        }
        code = run_checks(&t, args->machine.device);
        double seconds = app_seconds() - start;
        bool ok = code == EXIT_DONE && t.num_failed == 0;
        cJSON_AddBoolToObject(root, "ok", ok);
        json_add_float(root, "seconds", seconds);
        cJSON_AddItemToObject(root, "checks", t.checks);
        if (args->json) {
            json_write(a, cJSON_Duplicate(root, true), NULL);
        } else {
            printf("%s, %.0f s\n", ok ? "all right" : "NOT all right", seconds);
        }
        code = code == EXIT_DONE && !ok ? EXIT_FAILED : code;
    }
    cJSON_Delete(root);
    machine_close(&mach);
    return code;
}

#define AT(field) offsetof(selftest_args, field)
static const option selftest_table[] = {
    {0, "json", OPT_FLAG, AT(json), NULL, "print JSON"},
};
static const opt_group groups[] = {
    {"selftest", selftest_table, ARRAY_SIZE(selftest_table), 0},
    {"machine", machine_table, MACHINE_TABLE_SIZE, AT(machine)},
};

const command cmd_selftest = {
    .name = "selftest",
    .summary = "Furnace, energy, tables, device: what a bug report needs.",
    .groups = groups,
    .num_groups = ARRAY_SIZE(groups),
    .args_size = sizeof(selftest_args),
    .run = run_selftest,
};
