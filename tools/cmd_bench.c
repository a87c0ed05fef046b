// cmd_bench.c -- `tyndall bench`: error against time, every method of a suite.
#include "bench/bands.h"
#include "bench/html.h"
#include "bench/library.h"
#include "bench/print.h"
#include "bench/record.h"
#include "bench/report.h"
#include "bench/stress.h"
#include "devices.h"
#include "fronts.h"
#include "stats.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <tyndall/io.h>
#include <unistd.h>

typedef struct bench_args {
    machine_options machine;
    const char *suite, *report, *scenes, *bands, *fronts, *axis;
    bool json, fresh, stress, quick;
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

// ---- runs -------------------------------------------------------------------------------------

// The settings of every run are tried before hours may be spent on the first.
static int check_methods(app *a, const bench_suite *suite)
{
    int code = EXIT_DONE;
    for (uint32_t i = 0; i < suite->num_runs && code == EXIT_DONE; i++) {
        const bench_run *run = &suite->runs[i];
        method m;
        code = method_open(a, &run->method, &m);
        if (code == EXIT_DONE && run->baseline && !m.info.progressive) {
            app_error(a, "baselines: '%s' does not sample; its error does not fall with time",
                      run->name);
            code = EXIT_WRONG;
        }
        method_finish(&m);
    }
    return code;
}

// The record of a run, from the folder or measured now.
static int get_record(bench_case *c, const bench_run *run, bool fresh, cJSON **record)
{
    char key[17];
    int code = bench_key(c, run, key);
    *record = code == EXIT_DONE && !fresh ? record_load(c->folder, key) : NULL;
    if (*record || code != EXIT_DONE) {
        return code;
    }
    code = bench_measure(c, run, key, record);
    if (*record && code == EXIT_DONE) {
        code = record_store(c->a, c->folder, key, record);
    } else if (
        *record) { // it failed for want of memory or of the device, which is no property of it
        code = record_store(c->a, NULL, key, record);
    }
    return code;
}

// What the most samples of the sweep so far have taken tells what the next will take.
static double expected_seconds(const bench_suite *suite, uint32_t index, const cJSON *runs)
{
    const bench_run *run = &suite->runs[index];
    double seconds = 0, most = 0;
    const cJSON *done;
    cJSON_ArrayForEach(done, runs)
    {
        const double spp = json_figure(done, "settings.spp");
        if (strcmp(json_text(done, "group"), run->group) == 0 && spp > most &&
            spp < run->method.spp) {
            most = spp;
            seconds = 1e-3 * json_figure(done, "frame_ms.cold") * run->method.spp / spp;
        }
    }
    return seconds;
}

static void leave_out(const bench_run *run, double seconds, double most, cJSON *left_out)
{
    char *why = text_format("would take about %.0f s; max_seconds is %g", seconds, most);
    cJSON *entry = cJSON_CreateObject();
    cJSON_AddStringToObject(entry, "run", run->name);
    cJSON_AddStringToObject(entry, "group", run->group);
    cJSON_AddStringToObject(entry, "why", why ? why : "");
    cJSON_AddItemToArray(left_out, entry);
    free(why);
}

static int measure_runs(bench_case *c, bool fresh, cJSON *runs, cJSON *left_out)
{
    int code = EXIT_DONE;
    for (uint32_t i = 0; i < c->suite->num_runs && code == EXIT_DONE; i++) {
        const bench_run *run = &c->suite->runs[i];
        if (!bench_run_is_for(run, c->spec)) {
            continue;
        }
        const double seconds = expected_seconds(c->suite, i, runs);
        if (seconds > c->suite->max_seconds) {
            leave_out(run, seconds, c->suite->max_seconds, left_out);
            continue;
        }
        cJSON *record = NULL;
        code = get_record(c, run, fresh, &record);
        if (code == EXIT_DONE) {
            cJSON *measured = cJSON_DetachItemFromObjectCaseSensitive(record, "run");
            cJSON_AddStringToObject(measured, "date", json_text(record, "date"));
            cJSON_AddItemToArray(runs, measured);
        }
        cJSON_Delete(record);
    }
    return code;
}

static int measure_scene(app *a, const bench_machine *on, const bench_suite *suite,
                         const bench_scene *spec, const bench_args *args, bench_report *report)
{
    bench_case c;
    int code = bench_case_open(a, on, suite, spec, args->report, &c);
    cJSON *runs = cJSON_CreateArray(), *left_out = cJSON_CreateArray();
    if (code == EXIT_DONE) {
        code = measure_runs(&c, args->fresh, runs, left_out);
    }
    if (code == EXIT_DONE) {
        bench_report_scene(report, &c, runs, left_out);
        if (!args->json) {
            const cJSON *scenes = cJSON_GetObjectItemCaseSensitive(report->root, "scenes");
            bench_print_scene(cJSON_GetArrayItem(scenes, cJSON_GetArraySize(scenes) - 1));
        }
    } else {
        cJSON_Delete(runs);
        cJSON_Delete(left_out);
    }
    bench_case_close(&c);
    return code;
}

// ---- the machine ------------------------------------------------------------------------------

static const char *device_type(app *a, const bench_machine *on)
{
    static const char *const types[] = {"discrete", "integrated", "virtual", "cpu"};
    const char *type = "other";
    devices d;
    if (devices_list(a, &d) == EXIT_DONE) {
        for (int i = 0; i < d.count; i++) {
            for (size_t k = 0; k < ARRAY_SIZE(types); k++) {
                if (strcmp(d.infos[i].name, on->name) == 0 &&
                    strcmp(d.infos[i].type, types[k]) == 0) {
                    type = types[k];
                }
            }
        }
    }
    devices_finish(&d);
    return type;
}

static int open_machine(app *a, const bench_args *args, const bench_suite *suite, machine *m,
                        bench_machine *on)
{
    int code = machine_open(a, &args->machine, false, m);
    *on = (bench_machine){.ceilings = {NAN, NAN, NAN, NAN, NAN}};
    if (code == EXIT_DONE) {
        on->device = m->device;
        on->name = tyn_device_name(m->device);
        on->driver = tyn_device_driver(m->device);
        on->type = device_type(a, on);
        on->library = library_hash();
        code = suite->ceilings ? ceilings_measure(a, m->device, &on->ceilings) : EXIT_DONE;
    }
    return code;
}

// ---- the report -------------------------------------------------------------------------------

static int make_folder(app *a, const char *path)
{
    struct stat status;
    if (!path || mkdir(path, 0777) == 0 ||
        (stat(path, &status) == 0 && S_ISDIR(status.st_mode) && access(path, W_OK) == 0)) {
        return EXIT_DONE;
    }
    app_error(a, "--report: the folder '%s' cannot be made: %s", path, strerror(errno));
    return EXIT_FAILED;
}

// What `--stress` has left in the folder belongs to its report.
static void add_stress(const char *folder, cJSON *root)
{
    void *data = NULL;
    size_t size = 0;
    char *path = text_format("%s/stress.json", folder);
    if (path && tyn_file_read(path, 256u << 20, &data, &size, NULL) == TYN_OK) {
        cJSON *stress = cJSON_ParseWithLength(data, size);
        if (stress) {
            cJSON_ReplaceItemInObjectCaseSensitive(root, "stress", stress);
        }
    }
    free(data);
    free(path);
}

static int write_report(app *a, const bench_args *args, cJSON *root)
{
    int code = EXIT_DONE;
    if (args->report) {
        add_stress(args->report, root);
        char *json = text_format("%s/report.json", args->report);
        char *html = text_format("%s/report.html", args->report);
        code = json && html ? json_write(a, cJSON_Duplicate(root, true), json)
                            : app_exit_code(a, TYN_ERR_MEMORY, false);
        if (code == EXIT_DONE) {
            code = html_write(a, root, args->report, html);
        }
        free(json);
        free(html);
    }
    if (code == EXIT_DONE && args->json) {
        code = json_write(a, cJSON_Duplicate(root, true), NULL);
    }
    return code;
}

static int run_suite(app *a, const bench_args *args, const bench_suite *suite, const cJSON *bands)
{
    machine mach = {0};
    bench_machine on;
    bench_report report = {0};
    int code = check_methods(a, suite);
    if (code == EXIT_DONE) {
        code = make_folder(a, args->report);
    }
    if (code == EXIT_DONE) {
        code = open_machine(a, args, suite, &mach, &on);
    }
    if (code == EXIT_DONE) {
        const double start = app_seconds();
        bench_report_begin(&report, &on, suite);
        if (!args->json) {
            bench_print_head(report.root);
        }
        for (uint32_t i = 0; i < suite->num_scenes && code == EXIT_DONE; i++) {
            code = measure_scene(a, &on, suite, &suite->scenes[i], args, &report);
        }
        report.measuring_seconds = app_seconds() - start - report.reference_seconds;
    }
    int inside = EXIT_DONE;
    if (code == EXIT_DONE) {
        bench_report_end(&report, suite);
        if (!args->json) {
            bench_print_end(report.root);
        }
        inside = bands ? bands_apply(a, args->bands, bands, report.root) : EXIT_DONE;
        code = write_report(a, args, report.root);
        if (code == EXIT_DONE && args->fronts) {
            code = fronts_write(a, report.root, args->fronts);
        }
    } else if (code == EXIT_INTERRUPTED && args->report) {
        app_note(a, "interrupted; the records made so far are kept: the same command goes on");
    }
    bench_report_finish(&report);
    machine_close(&mach);
    return code == EXIT_DONE ? inside : code;
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
    cJSON *bands = NULL;
    int code = EXIT_FAILED;
    if (suite) {
        code = bench_suite_load(a, args->suite, samples, suite);
        if (code == EXIT_DONE && args->bands) {
            code = bands_load(a, args->bands, &bands);
        }
        if (code == EXIT_DONE) {
            code = run_suite(a, args, suite, bands);
        }
        bench_suite_finish(suite);
    } else {
        app_error(a, "out of memory");
    }
    cJSON_Delete(bands);
    free(suite);
    free(samples);
    return code;
}

#define AT(field) offsetof(bench_args, field)
static const option bench_table[] = {
    {0, "suite", OPT_TEXT, AT(suite), "FILE",
     "what to measure (docs/bench.md); else a small suite"},
    {0, "report", OPT_TEXT, AT(report), "DIR",
     "write report.json, report.html, records and pictures there; goes on with the records it "
     "finds"},
    {0, "fresh", OPT_FLAG, AT(fresh), NULL, "measure anew what --report has records of"},
    {0, "bands", OPT_TEXT, AT(bands), "FILE",
     "figures and their bounds: exit 1 and a line for each that is outside"},
    {0, "write-fronts", OPT_TEXT, AT(fronts), "FILE",
     "what render --max-error and --budget-ms choose from (--fronts)"},
    {0, "scenes", OPT_TEXT, AT(scenes), "DIR",
     "folder of the sample scenes; else ../samples/scenes beside the program"},
    {0, "stress", OPT_FLAG, AT(stress), NULL,
     "instead of a suite: where numbers get extreme (docs/stress.md)"},
    {0, "quick", OPT_FLAG, AT(quick), NULL, "with --stress: a minute instead of ten"},
    {0, "axis", OPT_TEXT, AT(axis), "NAME", "with --stress: axes with this in their names"},
    {0, "json", OPT_FLAG, AT(json), NULL, "print report.json instead of the table"},
};
static const opt_group groups[] = {
    {"bench", bench_table, ARRAY_SIZE(bench_table), 0},
    {"machine", machine_table, MACHINE_TABLE_SIZE, AT(machine)},
};

const command cmd_bench = {
    .name = "bench",
    .summary = "Error against time: every method of a suite on every scene.",
    .details =
        "For every scene and run: the error against a converged `path` (kept in\n"
        "$XDG_CACHE_HOME/tyndall/references) or a file, the times of cold, camera-moved and\n"
        "unchanged frames, memory, imbalance, flicker, each node against the device's\n"
        "ceilings; per scene the front of error against time, and what path tracing needs\n"
        "for the same error.",
    .groups = groups,
    .num_groups = ARRAY_SIZE(groups),
    .args_size = sizeof(bench_args),
    .run = run_bench,
};
