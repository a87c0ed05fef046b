// cmd_bench.c -- `tyndall bench`: error against time, every method of a suite.
#include "bench/bench.h"
#include "bench/stress.h"
#include "stats.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

typedef struct bench_args {
    machine_options machine;
    const char *suite, *report, *scenes, *axis;
    bool json, stress, quick;
} bench_args;

// The sample scenes of a build tree, as seen from the program: ../samples/scenes.
static char *default_scenes(void)
{
    char program[4096];
    ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    char *slash = NULL;
    if (length > 0) {
        program[length] = '\0';
        slash = strrchr(program, '/');
    }
    return slash ? text_format("%.*s/../samples/scenes", (int)(slash - program), program)
                 : text_format("samples/scenes");
}

static int measure_equal(bench_case *c, bench_baseline *baselines, bench_result *result)
{
    int code = EXIT_DONE;
    for (uint32_t i = 0; i < c->suite->num_baselines && code == EXIT_DONE; i++) {
        for (int k = 0; k < BENCH_BLOCKS && code == EXIT_DONE; k++) {
            code = bench_baseline_equal(c, &c->suite->baselines[i], &baselines[i], (uint32_t)k,
                                        result->error[k].error, &result->equal[i][k]);
        }
    }
    return code;
}

// All runs on one scene, and then the table: it starts with what only the runs can tell.
static int measure_runs(bench_case *c, bool table, cJSON *json_scenes)
{
    const bench_suite *suite = c->suite;
    bench_baseline baselines[BENCH_MAX_BASELINES];
    bench_result *results = calloc(suite->num_runs, sizeof *results);
    int code = results ? EXIT_DONE : app_exit_code(c->a, TYN_ERR_MEMORY, false);
    for (uint32_t i = 0; i < suite->num_baselines && code == EXIT_DONE; i++) {
        code = bench_baseline_pilot(c, &suite->baselines[i], &baselines[i]);
    }
    for (uint32_t i = 0; i < suite->num_runs && code == EXIT_DONE; i++) {
        code = bench_measure(c, &suite->runs[i], &results[i]);
        if (code == EXIT_DONE && !results[i].failed) {
            code = measure_equal(c, baselines, &results[i]);
        }
    }
    if (code == EXIT_DONE) {
        cJSON *scene = bench_json_scene(c), *runs = cJSON_AddArrayToObject(scene, "runs");
        cJSON_AddItemToArray(json_scenes, scene);
        if (table) {
            bench_print_scene(c);
        }
        for (uint32_t i = 0; i < suite->num_runs; i++) {
            cJSON_AddItemToArray(runs, bench_json_result(c, &suite->runs[i], &results[i]));
            if (table) {
                bench_print_result(c, &suite->runs[i], &results[i]);
            }
        }
    }
    free(results);
    return code;
}

static int measure_scene(app *a, tyn_device *device, const bench_suite *suite,
                         const bench_scene *spec, bool table, cJSON *json_scenes)
{
    bench_case c = {.a = a,
                    .device = device,
                    .suite = suite,
                    .spec = spec,
                    .blocks = {suite->block, 1},
                    .view = {.outputs = TYN_OUTPUT_RADIANCE, .no_background = true},
                    .fill = NAN};
    int code = scene_open(a, &spec->scene, &c.scene);
    if (code == EXIT_DONE && spec->lights > 0 && spec->lights < c.scene.num_lights) {
        c.scene.num_lights = spec->lights;
    }
    if (code == EXIT_DONE) { // for the reference
        code = scene_prepare(a, &(tyn_method_info){.traces_rays = true}, &c.scene);
    }
    if (code == EXIT_DONE) {
        code = view_setup(a, &spec->view, &c.scene, &c.view);
    }
    if (code == EXIT_DONE) {
        code = bench_reference_get(&c);
    }
    if (code == EXIT_DONE) {
        code = measure_runs(&c, table, json_scenes);
    }
    bench_reference_finish(&c.reference);
    tyn_scene_finish(&c.scene);
    return code;
}

// The settings of every run are tried before hours may be spent on the first.
static int check_methods(app *a, const bench_suite *suite)
{
    int code = EXIT_DONE;
    for (uint32_t i = 0; i < suite->num_runs + suite->num_baselines && code == EXIT_DONE; i++) {
        bool is_run = i < suite->num_runs;
        const bench_run *run = is_run ? &suite->runs[i] : &suite->baselines[i - suite->num_runs];
        method m;
        code = method_open(a, &run->method, &m);
        if (code == EXIT_DONE && !is_run && !m.info.progressive) {
            app_error(a, "baselines: '%s' does not sample; its error does not fall with time",
                      run->name);
            code = EXIT_WRONG;
        }
        method_finish(&m);
    }
    return code;
}

static int write_report(app *a, cJSON *root, const bench_args *args)
{
    int code = EXIT_DONE;
    if (args->report) {
        mkdir(args->report, 0777);
        char *path = text_format("%s/bench.json", args->report);
        cJSON *copy = cJSON_Duplicate(root, true);
        code = json_write(a, copy, path ? path : "bench.json");
        free(path);
    }
    if (code == EXIT_DONE && args->json) {
        code = json_write(a, cJSON_Duplicate(root, true), NULL);
    }
    return code;
}

static double cold_ms(const cJSON *root, const char *scene, uint32_t run)
{
    const cJSON *s;
    cJSON_ArrayForEach(s, cJSON_GetObjectItem(root, "scenes"))
    {
        if (strcmp(cJSON_GetStringValue(cJSON_GetObjectItem(s, "name")), scene) == 0) {
            const cJSON *result = cJSON_GetArrayItem(cJSON_GetObjectItem(s, "runs"), (int)run);
            const cJSON *ms = cJSON_GetObjectItem(cJSON_GetObjectItem(result, "frame_ms"), "cold");
            return ms && cJSON_IsRaw(ms) ? strtod(ms->valuestring, NULL) : NAN;
        }
    }
    return NAN;
}

static void measure_ratios(const bench_suite *suite, bool table, cJSON *root)
{
    cJSON *list = suite->num_ratios ? cJSON_AddArrayToObject(root, "ratios") : NULL;
    for (uint32_t k = 0; k < suite->num_ratios; k++) {
        const bench_ratio *ratio = &suite->ratios[k];
        for (uint32_t i = 0; i < suite->num_runs; i++) {
            const double times = cold_ms(root, ratio->of, i) / cold_ms(root, ratio->to, i);
            if (table) {
                printf("\n%s, %s: %.2f times the cold frame\n", ratio->name, suite->runs[i].name,
                       times);
            }
            cJSON *entry = cJSON_CreateObject();
            cJSON_AddStringToObject(entry, "name", ratio->name);
            cJSON_AddStringToObject(entry, "run", suite->runs[i].name);
            json_add_float(entry, "times", times);
            cJSON_AddItemToArray(list, entry);
        }
    }
}

static int run_suite(app *a, const bench_args *args, const bench_suite *suite)
{
    machine mach = {0};
    int code = check_methods(a, suite);
    if (code == EXIT_DONE) {
        code = machine_open(a, &args->machine, false, &mach);
    }
    if (code == EXIT_DONE) {
        const char *device = tyn_device_name(mach.device), *driver = tyn_device_driver(mach.device);
        cJSON *root = cJSON_CreateObject();
        cJSON_AddStringToObject(root, "tyndall", tyn_version_string());
        cJSON_AddStringToObject(root, "device", device);
        cJSON_AddStringToObject(root, "driver", driver);
        cJSON_AddStringToObject(root, "suite", suite->name);
        cJSON *scenes = cJSON_AddArrayToObject(root, "scenes");
        if (!args->json) {
            printf("suite %s, tyndall %s on %s, %s\n", suite->name, tyn_version_string(), device,
                   driver);
        }
        for (uint32_t i = 0; i < suite->num_scenes && code == EXIT_DONE; i++) {
            code = measure_scene(a, mach.device, suite, &suite->scenes[i], !args->json, scenes);
        }
        if (code == EXIT_DONE) {
            measure_ratios(suite, !args->json, root);
            code = write_report(a, root, args);
        }
        cJSON_Delete(root);
    }
    machine_close(&mach);
    return code;
}

static int run_bench(app *a, const void *arguments)
{
    const bench_args *args = arguments;
    a->quiet = args->machine.quiet;
    if (args->stress) {
        const stress_options options = {.quick = args->quick, .axis = args->axis};
        return stress_command(a, &args->machine, &options, args->report, args->json);
    }
    char *samples = args->scenes ? text_format("%s", args->scenes) : default_scenes();
    bench_suite *suite = calloc(1, sizeof *suite);
    int code = EXIT_FAILED;
    if (suite) {
        code = bench_suite_load(a, args->suite, samples, suite);
        if (code == EXIT_DONE) {
            code = run_suite(a, args, suite);
        }
        bench_suite_finish(suite);
    } else {
        app_error(a, "out of memory");
    }
    free(suite);
    free(samples);
    return code;
}

#define AT(field) offsetof(bench_args, field)
static const option bench_table[] = {
    {0, "suite", OPT_TEXT, AT(suite), "FILE",
     "what to measure (docs/bench.md); else a small suite"},
    {0, "report", OPT_TEXT, AT(report), "DIR", "write bench.json there"},
    {0, "scenes", OPT_TEXT, AT(scenes), "DIR",
     "folder of the sample scenes; else ../samples/scenes beside the program"},
    {0, "stress", OPT_FLAG, AT(stress), NULL,
     "instead of a suite: where numbers get extreme (docs/stress.md)"},
    {0, "quick", OPT_FLAG, AT(quick), NULL, "with --stress: a minute instead of ten"},
    {0, "axis", OPT_TEXT, AT(axis), "NAME", "with --stress: axes with this in their names"},
    {0, "json", OPT_FLAG, AT(json), NULL, "print JSON instead of the table"},
};
static const opt_group groups[] = {
    {"bench", bench_table, ARRAY_SIZE(bench_table), 0},
    {"machine", machine_table, MACHINE_TABLE_SIZE, AT(machine)},
};

const command cmd_bench = {
    .name = "bench",
    .summary = "Error against time: every method of a suite on every scene.",
    .details = "For every scene and run: the error against a converged `path` (kept in\n"
               "$XDG_CACHE_HOME/tyndall/references), the times of cold, camera-moved and unchanged "
               "frames,\n"
               "memory, and the time that path tracing needs for the same error.",
    .groups = groups,
    .num_groups = ARRAY_SIZE(groups),
    .args_size = sizeof(bench_args),
    .run = run_bench,
};
