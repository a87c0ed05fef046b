// report_make.c -- writes a report with invented figures and its page into a folder: report_make DIR
//
// Three scenes. The second has blocks of 4x4 pixels, and markup for a name and in its warnings; the third has a run
// below the noise and a picture with a pixel that is not a number.
#include "bench/html.h"
#include <tyndall/io.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { SIZE = 96, NUM_SCENES = 3 };
#define HOSTILE "</script><script>window.harmed=1</script><b>\"'&amp;\\"

// A ball of light on black, `error` too bright on one side, with noise like that of so many samples.
static int write_picture(app *a, const char *path, double error, double noise, bool nan)
{
    static float data[3][SIZE * SIZE];
    uint32_t random = 1;
    for (int i = 0; i < SIZE * SIZE; i++) {
        const double x = (i % SIZE + 0.5) / SIZE * 2 - 1, y = (i / SIZE + 0.5) / SIZE * 2 - 1;
        const double inside = 1 - x * x - y * y,
                     light = inside > 0 ? sqrt(inside) * (0.6 + 0.5 * x - 0.3 * y) : 0;
        for (int c = 0; c < 3; c++) {
            random = random * 1664525u + 1013904223u;
            const double spread = noise * (random / 4294967296.0 - 0.5) * 3.4;
            const double value = light * (1 + error * x) * (1 + spread) * (1 - 0.2 * c) * 0.02;
            data[c][i] = (float)fmax(0, value);
        }
    }
    if (nan) {
        data[0][SIZE * 10 + 10] = NAN;
    }
    tyn_channel channels[3] = {{"R", data[0]}, {"G", data[1]}, {"B", data[2]}};
    tyn_image_file image = {SIZE, SIZE, 3, channels};
    return app_exit_code(a, tyn_exr_write(&image, path, true, &a->log), false);
}

static cJSON *error_entry(double block, double error, double n, double noise)
{
    const double whole = sqrt(error * error + n * n);
    cJSON *e = cJSON_CreateObject();
    cJSON_AddNumberToObject(e, "block", block);
    cJSON_AddNumberToObject(e, "error", error);
    cJSON_AddNumberToObject(e, "rel_l1", whole);
    cJSON_AddNumberToObject(e, "n", n);
    cJSON_AddNumberToObject(e, "rmse", 0.02 * whole);
    cJSON_AddNumberToObject(e, "rel_rmse", 1.2 * whole);
    cJSON_AddNumberToObject(e, "rel_mse", whole * whole);
    cJSON_AddNumberToObject(e, "smape", whole);
    cJSON_AddNumberToObject(e, "bias", noise > 0 ? 0.001 : -0.4 * error);
    cJSON_AddNumberToObject(e, "p95", 2.1 * whole);
    cJSON_AddNumberToObject(e, "nan", 0);
    return e;
}

// Of the blocks that errors of a scene are of.
static int block_of(int scene)
{
    return scene == 1 ? 4 : 8;
}

typedef struct made_run {
    const char *name, *method, *group, *setting;
    double amount, error, ms, noise;
    bool front;
} made_run;
static const made_run made[] = {
    {"pop, 8 cells", "pop", "pop", "lattice.cells", 8, 0.081, 34, 0, true},
    {"pop, 16 cells", "pop", "pop", "lattice.cells", 16, 0.048, 52, 0, true},
    {"pop, 32 cells", "pop", "pop", "lattice.cells", 32, 0.031, 118, 0, true},
    {"pop, 32 cells, march step 2", "pop", "pop", "raymarch.step", 2, 0.055, 84, 0, false},
    {"pop, 48 cells", "pop", "pop", "lattice.cells", 48, 0.027, 290, 0, true},
    {"path, 1 sample", "path", "path", "spp", 1, 0.31, 62, 0.31, false},
    {"path, 16 samples", "path", "path", "spp", 16, 0.078, 610, 0.078, false},
    {"path, 256 samples", "path", "path", "spp", 256, 0.0195, 9700, 0.0195, true},
    {"path, plain, 16 samples", "path", "path, plain", "spp", 16, 0.12, 590, 0.12, false},
    {"path, plain, 256 samples", "path", "path, plain", "spp", 256, 0.03, 9400, 0.03, false},
    {"pop-paper, 10 iterations", "pop-paper", "pop-paper", "iterations", 10, 0.36, 402, 0, false},
    {"pop-paper, 20 iterations", "pop-paper", "pop-paper", "iterations", 20, 0.29, 603, 0, false},
    {"single", "single", "single", NULL, 0, 0.52, 21, 0, true},
};

static cJSON *nodes(double ms)
{
    static const struct {
        const char *name, *ceiling;
        double share, fraction;
    } parts[] = {{"medium", NULL, 0.1, 0},
                 {"beam", "trilinear", 0.06, 0.41},
                 {"lattice_source", "copy", 0.07, 0.18},
                 {"lattice", "copy", 0.19, 0.36},
                 {"merge", "dispatch", 0.01, 0.93},
                 {"raymarch", "trilinear", 0.62, 0.58}};
    cJSON *list = cJSON_CreateArray();
    for (size_t i = 0; i < ARRAY_SIZE(parts); i++) {
        cJSON *n = cJSON_CreateObject();
        cJSON_AddStringToObject(n, "name", parts[i].name);
        cJSON_AddNumberToObject(n, "gpu_ms", ms * parts[i].share);
        cJSON_AddBoolToObject(n, "setup", i == 0);
        cJSON_AddItemToObject(n, "ceiling",
                              parts[i].ceiling ? cJSON_CreateString(parts[i].ceiling)
                                               : cJSON_CreateNull());
        cJSON_AddItemToObject(n, "fraction",
                              parts[i].ceiling ? cJSON_CreateNumber(parts[i].fraction)
                                               : cJSON_CreateNull());
        cJSON_AddItemToArray(list, n);
    }
    return list;
}

static cJSON *make_run(app *a, const char *dir, int scene, int index)
{
    const made_run *m = &made[index];
    const double harder = 1 + 0.6 * scene, slower = 1 + 1.7 * scene;
    const bool below = scene == 2 && index == 2, failed = scene == 1 && m->method[0] == 's';
    const double error = below ? 0 : fmin(m->error * harder, 0.9);
    cJSON *run = cJSON_CreateObject(), *errors, *frame, *memory, *settings, *inputs, *warnings;
    char text[256], path[4096];
    snprintf(text, sizeof text, "%016llx%08x",
             0x9e3779b97f4a7c15ull * (unsigned)(16 * scene + index + 1), (unsigned)index);
    cJSON_AddStringToObject(run, "key", text);
    cJSON_AddStringToObject(run, "name", m->name);
    cJSON_AddStringToObject(run, "method", m->method);
    cJSON_AddStringToObject(run, "group", m->group);
    cJSON_AddBoolToObject(run, "sampling", m->noise > 0);
    cJSON_AddBoolToObject(run, "baseline", m->noise > 0);
    cJSON_AddItemToObject(run, "preset",
                          index == 0 ? cJSON_CreateString("normal") : cJSON_CreateNull());
    settings = cJSON_AddObjectToObject(run, "settings");
    if (m->setting) {
        cJSON_AddNumberToObject(settings, m->setting, m->amount);
    }
    cJSON_AddNumberToObject(run, "seed", 0);
    cJSON_AddItemToObject(run, "failed",
                          failed ? cJSON_CreateString("'single' cannot do " HOSTILE)
                                 : cJSON_CreateNull());
    errors = cJSON_AddArrayToObject(run, "errors");
    warnings = cJSON_AddArrayToObject(run, "warnings");
    if (failed) {
        return run;
    }
    cJSON_AddItemToArray(errors, error_entry(block_of(scene), error, 0.006 * harder, m->noise));
    cJSON_AddItemToArray(
        errors, error_entry(1, m->noise > 0 ? 7 * error : 1.15 * error, 0.05 * harder, m->noise));
    cJSON *flip = cJSON_CreateObject();
    cJSON_AddNumberToObject(flip, "block", 0);
    cJSON_AddNumberToObject(flip, "error", 0.4 * error);
    cJSON_AddNumberToObject(flip, "n", 0.01);
    cJSON_AddItemToArray(errors, flip);
    cJSON_AddNumberToObject(run, "setup_ms", 180);
    frame = cJSON_AddObjectToObject(run, "frame_ms");
    cJSON_AddNumberToObject(frame, "animated_light", m->ms * slower);
    cJSON_AddNumberToObject(frame, "camera_moved", (m->noise > 0 ? 1 : 0.7) * m->ms * slower);
    cJSON_AddNumberToObject(frame, "unchanged", 0.07);
    frame = cJSON_AddObjectToObject(run, "frames");
    cJSON_AddNumberToObject(frame, "animated_light", 5);
    cJSON_AddNumberToObject(frame, "camera_moved", 8);
    cJSON_AddNumberToObject(frame, "unchanged", 5);
    memory = cJSON_AddObjectToObject(run, "memory");
    cJSON_AddNumberToObject(memory, "persistent", 12e6 + 3e5 * index);
    cJSON_AddNumberToObject(memory, "transient", 4e6);
    cJSON_AddItemToObject(run, "nodes", nodes(m->ms * slower));
    cJSON_AddItemToObject(run, "imbalance",
                          m->noise > 0
                              ? cJSON_CreateNull()
                              : cJSON_CreateDoubleArray((double[3]){0.004, -0.002, 0.001}, 3));
    cJSON_AddItemToObject(run, "flicker",
                          m->noise > 0 ? cJSON_CreateNull() : cJSON_CreateNumber(0.0024));
    cJSON_AddNumberToObject(run, "non_finite", scene == 2 && index == 11 ? 3 : 0);
    cJSON_AddNumberToObject(run, "negative", 0);
    if (index == 10 || scene == 1) {
        cJSON_AddItemToArray(
            warnings,
            cJSON_CreateString("the field has not converged after so few iterations" HOSTILE));
    }
    snprintf(text, sizeof text, "pictures/%d/%d.exr", scene, index);
    cJSON_AddStringToObject(run, "picture", text);
    snprintf(path, sizeof path, "%s/%s", dir, text);
    write_picture(a, path, m->noise > 0 ? 0 : error * 2, m->noise, scene == 2 && index == 11);
    inputs = cJSON_AddObjectToObject(run, "inputs");
    cJSON_AddStringToObject(inputs, "smoke.gltf", "5be0cd19137e2179");
    cJSON_AddStringToObject(run, "date", "2026-11-21T12:00:00Z");
    return run;
}

static cJSON *equal_entry(double error, const char *baseline, double ms, double baseline_ms)
{
    cJSON *e = cJSON_CreateObject();
    cJSON_AddNumberToObject(e, "block", 8);
    cJSON_AddNumberToObject(e, "error", error);
    cJSON_AddStringToObject(e, "method", "pop");
    cJSON_AddStringToObject(e, "baseline", baseline);
    const bool there = ms > 0;
    cJSON_AddItemToObject(e, "ms", there ? cJSON_CreateNumber(ms) : cJSON_CreateNull());
    cJSON_AddNumberToObject(e, "baseline_ms", baseline_ms);
    cJSON_AddItemToObject(e, "speedup",
                          there ? cJSON_CreateNumber(baseline_ms / ms) : cJSON_CreateNull());
    cJSON_AddBoolToObject(e, "measured", error > 0.04);
    return e;
}

// Of frames after the camera has moved: without the first of the cold front; as is promised everywhere.
static cJSON *make_moved(const cJSON *scene)
{
    cJSON *moved = cJSON_CreateObject(), *entry;
    for (const char *const *name = (const char *const[]){"fronts", "equal_error", "verdicts", NULL};
         *name; name++) {
        cJSON_AddItemToObject(
            moved, *name, cJSON_Duplicate(cJSON_GetObjectItemCaseSensitive(scene, *name), true));
    }
    cJSON_DeleteItemFromArray(
        cJSON_GetObjectItem(cJSON_GetArrayItem(cJSON_GetObjectItem(moved, "fronts"), 0), "runs"),
        0);
    cJSON_ArrayForEach(entry, cJSON_GetObjectItem(moved, "equal_error"))
    {
        cJSON *speedup = cJSON_GetObjectItem(entry, "speedup");
        if (cJSON_IsNumber(speedup)) {
            cJSON_SetNumberValue(speedup, speedup->valuedouble / 0.7);
        }
    }
    cJSON *promise = cJSON_AddObjectToObject(moved, "promise");
    cJSON_AddStringToObject(promise, "method", "pop");
    cJSON_AddNumberToObject(promise, "above", 0.03);
    cJSON_AddBoolToObject(promise, "holds", true);
    cJSON_AddStringToObject(promise, "text", "pop is on the front at all errors above 3.0 %");
    return moved;
}

// A renderer of others: a run that is on no front though nothing is as fast and as good, and its times beside `path`.
static void add_peer(cJSON *scene, cJSON *runs)
{
    static const char *const unknown[] = {"key",    "preset",  "failed",    "setup_ms",
                                          "memory", "flicker", "imbalance", "picture"};
    cJSON *run = cJSON_CreateObject(), *errors;
    cJSON_AddStringToObject(run, "name", "Cycles 0.0, 4 spp");
    cJSON_AddStringToObject(run, "method", "cycles");
    cJSON_AddStringToObject(run, "group", "cycles");
    cJSON_AddStringToObject(run, "device", "a processor of others");
    cJSON_AddBoolToObject(run, "peer", true);
    cJSON_AddBoolToObject(run, "sampling", true);
    cJSON_AddBoolToObject(run, "baseline", false);
    cJSON_AddNumberToObject(cJSON_AddObjectToObject(run, "settings"), "spp", 4);
    errors = cJSON_AddArrayToObject(run, "errors");
    cJSON_AddItemToArray(errors, error_entry(8, 0.02, 0.006, 0.02));
    cJSON_AddItemToArray(errors, error_entry(1, 0.15, 0.05, 0.15));
    cJSON_AddNumberToObject(cJSON_AddObjectToObject(run, "frame_ms"), "animated_light", 19);
    for (size_t i = 0; i < ARRAY_SIZE(unknown); i++) {
        cJSON_AddNullToObject(run, unknown[i]);
    }
    cJSON_AddArrayToObject(run, "nodes");
    cJSON_AddArrayToObject(run, "warnings");
    cJSON_AddItemToArray(runs, run);
    cJSON *peer = cJSON_Parse("[{\"peer\": \"cycles\", \"name\": \"Cycles 0.0\", \"mean\": "
                              "{\"bias\": -0.004, \"se\": 0.003, "
                              "\"reference_se\": 0.004, \"renderings\": 4, \"samples\": 21}, "
                              "\"equal_error\": [{\"block\": 8, "
                              "\"error\": 0.02, \"ms\": 19, \"measured\": true, \"baseline\": "
                              "\"path\", \"baseline_ms\": 9300, "
                              "\"baseline_measured\": false, \"method\": \"pop\", \"method_ms\": "
                              "null, \"why\": null}]}]");
    cJSON_AddItemToObject(scene, "peers", peer);
}

static cJSON *make_scene(app *a, const char *dir, int index)
{
    static const char *const names[NUM_SCENES] = {"smoke", HOSTILE, "milk"};
    char path[4096];
    cJSON *scene = cJSON_CreateObject();
    cJSON_AddStringToObject(scene, "name", names[index]);
    cJSON_AddStringToObject(scene, "hash", "6a09e667f3bcc908");
    cJSON_AddItemToObject(scene, "size", cJSON_CreateIntArray((int[2]){SIZE, SIZE}, 2));
    cJSON_AddNumberToObject(scene, "fill", 0.72);
    cJSON *regime = cJSON_AddObjectToObject(scene, "regime");
    cJSON_AddNumberToObject(regime, "optical_depth", 11 + 20 * index);
    cJSON_AddNumberToObject(regime, "albedo", 0.96);
    cJSON_AddNumberToObject(regime, "g", 0.7);
    cJSON_AddItemToObject(regime, "lights",
                          cJSON_CreateStringArray((const char *[2]){"sun", "sky"}, 2));
    cJSON *reference = cJSON_AddObjectToObject(scene, "reference");
    cJSON_AddStringToObject(reference, "method", "path");
    cJSON_AddNumberToObject(reference, "spp", 4096);
    cJSON_AddNumberToObject(reference, "seed", 1);
    cJSON_AddNumberToObject(reference, "seconds", 214);
    cJSON_AddStringToObject(reference, "key", "bb67ae8584caa73b");
    snprintf(path, sizeof path, "pictures/%d/reference.exr", index);
    cJSON_AddStringToObject(reference, "picture", path);
    snprintf(path, sizeof path, "%s/pictures/%d", dir, index);
    mkdir(path, 0777);
    snprintf(path, sizeof path, "%s/pictures/%d/reference.exr", dir, index);
    write_picture(a, path, 0, 0.02, false);
    cJSON *noise = cJSON_AddArrayToObject(reference, "noise");
    for (int i = 0; i < 2; i++) {
        cJSON *n = cJSON_CreateObject();
        cJSON_AddNumberToObject(n, "block", i ? 1 : block_of(index));
        cJSON_AddNumberToObject(n, "n", (i ? 0.05 : 0.006) * (1 + 0.6 * index));
        cJSON_AddItemToArray(noise, n);
    }
    cJSON *runs = cJSON_AddArrayToObject(scene, "runs"),
          *fronts = cJSON_AddArrayToObject(scene, "fronts");
    cJSON *front = cJSON_CreateObject(), *keys;
    cJSON_AddNumberToObject(front, "block", block_of(index));
    keys = cJSON_AddArrayToObject(front, "runs");
    cJSON_AddItemToArray(fronts, front);
    for (int i = 0; i < (int)ARRAY_SIZE(made); i++) {
        cJSON *run = make_run(a, dir, index, i);
        cJSON_AddItemToArray(runs, run);
        if (made[i].front && !(index == 2 && i > 2 && i < 12) &&
            !cJSON_IsString(cJSON_GetObjectItem(run, "failed"))) {
            cJSON_AddItemToArray(
                keys, cJSON_CreateString(cJSON_GetStringValue(cJSON_GetObjectItem(run, "key"))));
        }
    }
    if (index == 0) {
        add_peer(scene, runs);
    }
    cJSON *equal = cJSON_AddArrayToObject(scene, "equal_error");
    const double ratios[NUM_SCENES] = {1, 2.6, 0.05};
    cJSON_AddItemToArray(equal, equal_entry(0.10, "path", 31, 31 * 12.4 * ratios[index]));
    cJSON_AddItemToArray(equal, equal_entry(0.05, "path, plain", 51, 51 * 29.3 * ratios[index]));
    cJSON_AddItemToArray(
        equal, equal_entry(0.03, "path", index == 2 ? 0 : 130, 130 * 31.3 * ratios[index]));
    cJSON *verdicts = cJSON_AddArrayToObject(scene, "verdicts");
    cJSON_AddItemToArray(verdicts, cJSON_CreateString("pop is on the front above 2.7 %"));
    cJSON_AddItemToArray(verdicts, cJSON_CreateString("path wins below 2.7 %"));
    cJSON *promise = cJSON_AddObjectToObject(scene, "promise");
    cJSON_AddStringToObject(promise, "method", "pop");
    cJSON_AddNumberToObject(promise, "above", 0.03);
    cJSON_AddBoolToObject(promise, "holds", index != 2);
    cJSON_AddStringToObject(promise, "text",
                            index != 2 ? "pop is on the front at all errors above 3.0 %"
                                       : "pop is not on the front at all errors above 3.0 %: path "
                                         "wins above 12 %");
    cJSON *moved = make_moved(scene), *times = cJSON_AddObjectToObject(scene, "times");
    cJSON_AddItemToObject(times, "camera_moved", moved);
    return scene;
}

static void add_headline(cJSON *all, const char *frame, double faster)
{
    for (int k = 0; k < 3; k++) {
        const double error = k == 0 ? 0.10 : k == 1 ? 0.05 : 0.03;
        cJSON *h = cJSON_CreateObject();
        cJSON_AddStringToObject(h, "frame", frame);
        cJSON_AddNumberToObject(h, "block", 8);
        cJSON_AddNumberToObject(h, "error", error);
        cJSON_AddStringToObject(h, "method", "pop");
        cJSON_AddNumberToObject(h, "geometric_mean",
                                (k == 0   ? 6.3
                                 : k == 1 ? 14.9
                                          : 50.5) *
                                    faster);
        cJSON_AddNumberToObject(h, "scenes", k == 2 ? 2 : 3);
        cJSON_AddNumberToObject(h, "of", 3);
        cJSON_AddNumberToObject(h, "extrapolated", k);
        cJSON *missing = cJSON_AddArrayToObject(h, "missing");
        if (k == 2) {
            cJSON_AddItemToArray(missing, cJSON_CreateString("milk: pop does not reach it"));
        }
        cJSON_AddItemToArray(all, h);
    }
}

static cJSON *make_presets(void)
{
    cJSON *all = cJSON_CreateArray();
    for (int k = 0; k < 2; k++) {
        cJSON *p = cJSON_CreateObject();
        cJSON_AddStringToObject(p, "frame", "animated_light");
        cJSON_AddNumberToObject(p, "block", k ? 1 : 8);
        cJSON_AddStringToObject(p, "method", "pop");
        cJSON_AddStringToObject(p, "preset", "normal");
        cJSON_AddNumberToObject(p, "error", 0.041);
        cJSON_AddNumberToObject(p, "ms", 52);
        cJSON_AddNumberToObject(p, "geometric_mean", k ? 41 : 7.7);
        cJSON_AddNumberToObject(p, "scenes", 2);
        cJSON_AddNumberToObject(p, "of", 3);
        cJSON_AddNumberToObject(p, "extrapolated", k);
        cJSON *missing = cJSON_AddArrayToObject(p, "missing");
        cJSON_AddItemToArray(missing, cJSON_CreateString("milk: the noise hides it"));
        cJSON_AddItemToArray(all, p);
    }
    return all;
}

static void add_cell(cJSON *cells, const char *method, const char *axis, double x, double error,
                     const char *warning, int bad)
{
    cJSON *c = cJSON_CreateObject();
    char name[64];
    snprintf(name, sizeof name, "%g", x);
    cJSON_AddStringToObject(c, "method", method);
    cJSON_AddStringToObject(c, "axis", axis);
    cJSON_AddStringToObject(c, "case", name);
    cJSON_AddNumberToObject(c, "x", x);
    cJSON_AddItemToObject(c, "error", error >= 0 ? cJSON_CreateNumber(error) : cJSON_CreateNull());
    cJSON_AddNumberToObject(c, "se", 0.001);
    cJSON_AddStringToObject(c, "against", "furnace");
    cJSON_AddNumberToObject(c, "non_finite", bad);
    cJSON_AddNumberToObject(c, "negative", 0);
    cJSON *warnings = cJSON_AddArrayToObject(c, "warnings");
    if (warning) {
        cJSON_AddItemToArray(warnings, cJSON_CreateString(warning));
    }
    cJSON_AddNumberToObject(c, "ms", 12);
    cJSON_AddItemToArray(cells, c);
}

static cJSON *make_stress(bool spoiled)
{
    static const char *const methods[] = {"pop", "path", "pop-paper"};
    cJSON *stress = cJSON_CreateObject(), *axes = cJSON_AddArrayToObject(stress, "axes");
    (void)axes;
    cJSON_AddItemToObject(stress, "methods", cJSON_CreateStringArray(methods, 3));
    cJSON_AddNumberToObject(stress, "expected", 3 * (15 + 6) + 4);
    cJSON *cells = cJSON_AddArrayToObject(stress, "cells");
    for (int m = 0; m < 3; m++) {
        for (int i = -6; i <= 8; i++) {
            add_cell(cells, methods[m], "sigma", pow(10, i),
                     (m == 1 ? 1e-3 : 2e-3 * pow(2, abs(i))) * (1 + m),
                     m != 1 && i > 6
                         ? "cells are 1e5 mean free paths wide: the lattice is diffusion" HOSTILE
                         : NULL,
                     0);
        }
        for (int i = 0; i < 6; i++) {
            const double g[] = {-0.99, -0.5, 0, 0.9, 0.99, 0.9999};
            add_cell(cells, methods[m], "g", g[i],
                     m == 2 && i == 5 ? -1 : 0.004 * pow(1 + i, 1 + m), NULL,
                     spoiled && m == 2 && i == 4 ? 7 : 0);
        }
    }
    return stress;
}

int main(int argc, char **argv)
{
    app a;
    app_init(&a);
    if (argc < 2) {
        fprintf(stderr, "usage: report_make DIR [sound]\n");
        return EXIT_WRONG;
    }
    char path[4096];
    mkdir(argv[1], 0777);
    snprintf(path, sizeof path, "%s/pictures", argv[1]);
    mkdir(path, 0777);
    cJSON *report = cJSON_CreateObject();
    cJSON_AddStringToObject(report, "schema", "tyndall-report");
    cJSON_AddNumberToObject(report, "version", 2);
    cJSON_AddStringToObject(report, "tyndall", "0.1.0");
    cJSON_AddStringToObject(report, "date", "2026-11-21T12:00:00Z");
    cJSON *suite = cJSON_AddObjectToObject(report, "suite");
    cJSON_AddStringToObject(suite, "name", "invented");
    cJSON_AddStringToObject(suite, "about", "Invented figures that try the page.");
    cJSON_AddStringToObject(suite, "hash", "3c6ef372fe94f82b");
    cJSON *device = cJSON_AddObjectToObject(report, "device");
    cJSON_AddStringToObject(device, "name", "llvmpipe (LLVM 15.0.6, 256 bits)");
    cJSON_AddStringToObject(device, "driver", "llvmpipe Mesa 22.3.6 (LLVM 15.0.6)");
    cJSON_AddStringToObject(device, "type", "cpu");
    cJSON *ceilings = cJSON_AddObjectToObject(report, "ceilings");
    cJSON_AddNumberToObject(ceilings, "fma_gflops", 41.3);
    cJSON_AddNumberToObject(ceilings, "copy_gb_s", 9.84);
    cJSON_AddNumberToObject(ceilings, "trilinear_gsamples_s", 0.231);
    cJSON_AddNumberToObject(ceilings, "exp_gops_s", 1.12);
    cJSON_AddNullToObject(ceilings, "dispatch_us");
    cJSON *seconds = cJSON_AddObjectToObject(report, "seconds");
    cJSON_AddNumberToObject(seconds, "references", 812);
    cJSON_AddNumberToObject(seconds, "measuring", 1490);
    cJSON *scenes = cJSON_AddArrayToObject(report, "scenes");
    cJSON_AddItemToObject(
        report, "peers_left_out",
        cJSON_Parse("[{\"peer\": \"cycles\", \"name\": \"Cycles 0.0\", \"scene\": "
                    "\"milk\", \"why\": \"measured against another reference\"}]"));
    for (int i = 0; i < NUM_SCENES; i++) {
        cJSON_AddItemToArray(scenes, make_scene(&a, argv[1], i));
    }
    cJSON *headline = cJSON_AddArrayToObject(report, "headline");
    add_headline(headline, "animated_light", 1);
    add_headline(headline, "camera_moved", 1 / 0.7);
    cJSON_AddItemToObject(report, "presets", make_presets());
    cJSON_AddItemToObject(report, "stress", make_stress(argc < 3));
    char *text = cJSON_Print(report);
    snprintf(path, sizeof path, "%s/report.json", argv[1]);
    int code = app_exit_code(&a, tyn_file_write(path, text, strlen(text), &a.log), false);
    cJSON_free(text);
    snprintf(path, sizeof path, "%s/report.html", argv[1]);
    code = code == EXIT_DONE ? html_write(&a, report, argv[1], path) : code;
    cJSON_Delete(report);
    return code;
}
