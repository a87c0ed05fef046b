// cmd_bench.c -- `tyndall bench`: error against time, every method of a suite.
#include "bench/bands.h"
#include "bench/html.h"
#include "bench/json.h"
#include "bench/library.h"
#include "bench/print.h"
#include "bench/report.h"
#include "bench/runs.h"
#include "bench/stress.h"
#include "data_folder.h"
#include "devices.h"
#include "folder.h"
#include "fronts.h"
#include "output.h"
#include "stats.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct bench_args {
    machine_options machine;
    const char *suite, *report, *scenes, *bands, *fronts, *axis, *methods;
    bool json, fresh, references, stress, quick;
} bench_args;

// ---- a scene ----------------------------------------------------------------------------------

static int measure_scene(app *a, const bench_machine *on, const bench_suite *suite,
                         const bench_scene *spec, const bench_args *args, bench_report *report)
{
    bench_case c;
    int code = bench_case_open(a, on, suite, spec, args->report, false, &c);
    cJSON *runs = cJSON_CreateArray(), *left_out = cJSON_CreateArray();
    if (code == EXIT_DONE) {
        code = bench_runs(&c, args->fresh, runs, left_out);
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
    if (code == EXIT_DONE && args->fronts) {
        code = paces_measure(a, m->device, &on->paces);
    }
    return code;
}

// ---- references -------------------------------------------------------------------------------

// Makes the reference of a scene that is stored with the suite, and says what it is worth.
static int make_reference(app *a, const bench_machine *on, const bench_suite *suite,
                          const bench_scene *spec)
{
    bench_case c;
    const int code = bench_case_open(a, on, suite, spec, NULL, true, &c);
    const bench_reference *r = &c.reference;
    if (code == EXIT_DONE || code == EXIT_INTERRUPTED) {
        printf(
            "%s, %ux%u: %u samples in %.0f s, noise %.2f %% per pixel, %.2f %% per %ux%u block\n",
            spec->name, c.view.width, c.view.height, r->spp, r->seconds, 100 * r->noise[1],
            100 * r->noise[0], suite->block, suite->block);
        fflush(stdout);
    }
    bench_case_close(&c);
    return code;
}

static int make_references(app *a, const bench_args *args, const bench_suite *suite)
{
    machine mach = {0};
    bench_machine on;
    if (!suite->references) {
        app_error(a, "--references needs a suite that names their folder, \"references\"");
        return EXIT_WRONG;
    }
    int code = bench_check(a, suite);
    if (code == EXIT_DONE) {
        code = folder_make(a, "--references", suite->references);
    }
    if (code == EXIT_DONE) {
        code = open_machine(a, args, suite, &mach, &on);
    }
    for (uint32_t i = 0; i < suite->num_scenes && code == EXIT_DONE; i++) {
        if (!suite->scenes[i].reference) {
            code = make_reference(a, &on, suite, &suite->scenes[i]);
        }
    }
    if (code == EXIT_INTERRUPTED) {
        app_note(a, "interrupted; what is rendered is kept: the same command goes on");
    }
    machine_close(&mach);
    return code;
}

// ---- the report -------------------------------------------------------------------------------

// Where nothing can be written, nothing is measured: the report's folder is made, the other file's tried.
static int open_outputs(app *a, const bench_args *args)
{
    int code = args->report ? folder_make(a, "--report", args->report) : EXIT_DONE;
    if (code == EXIT_DONE && args->fronts && !output_folder_is_writable(a, args->fronts)) {
        code = EXIT_FAILED;
    }
    return code;
}

static int write_report(app *a, const bench_args *args, const bench_machine *on, cJSON *root)
{
    int code = EXIT_DONE;
    if (args->report) {
        // What `--stress` has left in the folder belongs to its report.
        cJSON *stress = stress_read(a, args->report, on->library, on->device);
        if (stress) {
            cJSON_ReplaceItemInObjectCaseSensitive(root, "stress", stress);
        }
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
    int code = bench_check(a, suite);
    if (code == EXIT_DONE) {
        code = open_outputs(a, args);
    }
    if (code == EXIT_DONE) {
        code = open_machine(a, args, suite, &mach, &on);
    }
    if (code == EXIT_DONE) {
        const double start = app_seconds();
        bench_report_begin(a, &report, &on, suite);
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
        code = write_report(a, args, &on, report.root);
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

// An option that does nothing would be taken for one that does. False: said.
static bool check_options(app *a, const bench_args *args)
{
    const struct {
        bool given;
        const char *name;
        bool needed;
        const char *why;
    } rules[] = {
        {args->suite, "suite", !args->stress, "goes with no --stress, which has scenes of its own"},
        {args->scenes, "scenes", !args->stress,
         "goes with no --stress, which has scenes of its own"},
        {args->bands, "bands", !args->stress, "goes with no --stress, whose bounds are fixed"},
        {args->fronts, "write-fronts", !args->stress, "goes with no --stress, which has no fronts"},
        {args->fronts, "write-fronts", !args->references,
         "goes with no --references, which measures nothing"},
        {args->fresh, "fresh", !args->stress, "goes with no --stress, which keeps no records"},
        {args->fresh, "fresh", args->report, "needs --report, whose records it leaves alone"},
        {args->references, "references",
         !args->stress && !args->report && !args->bands && !args->json,
         "goes with --suite and --scenes alone: nothing is measured"},
        {args->quick, "quick", args->stress, "needs --stress"},
        {args->axis, "axis", args->stress, "needs --stress"},
        {args->methods, "methods", args->stress, "needs --stress: a suite names its runs"},
    };
    for (size_t i = 0; i < ARRAY_SIZE(rules); i++) {
        if (rules[i].given && !rules[i].needed) {
            app_error(a, "--%s %s", rules[i].name, rules[i].why);
            return false;
        }
    }
    if (args->axis && !stress_has_axis(args->axis)) {
        app_error(a, "--axis: no axis has '%s' in its name (docs/stress.md lists them)",
                  args->axis);
        return false;
    }
    char unknown[64];
    if (!stress_has_methods(args->methods, unknown)) {
        app_error(a, "--methods: '%s' is no method (tyndall info --methods lists them)", unknown);
        return false;
    }
    return true;
}

// Fronts are of blocks of 8x8 pixels, whatever scenes they are measured on. False: said.
static bool check_fronts(app *a, const bench_args *args, const bench_suite *suite)
{
    if (args->fronts && suite->block != 8) {
        app_error(a, "--write-fronts needs a suite whose \"block\" is 8, not %u", suite->block);
        return false;
    }
    return true;
}

static int run_bench(app *a, const void *arguments)
{
    const bench_args *args = arguments;
    a->quiet = args->machine.quiet;
    if (!check_options(a, args)) {
        return EXIT_WRONG;
    }
    if (args->stress) {
        const stress_options options = {
            .quick = args->quick, .axis = args->axis, .methods = args->methods};
        return stress_command(a, &args->machine, &options, args->report, args->json);
    }
    char *samples = args->scenes ? text_format("%s", args->scenes) : data_folder_scenes();
    bench_suite *suite = calloc(1, sizeof *suite);
    cJSON *bands = NULL;
    int code = EXIT_FAILED;
    if (suite) {
        code = bench_suite_load(a, args->suite, samples, suite);
        if (code == EXIT_DONE && !check_fronts(a, args, suite)) {
            code = EXIT_WRONG;
        }
        if (code == EXIT_DONE && args->bands) {
            code = bands_load(a, args->bands, &bands);
        }
        if (code == EXIT_DONE) {
            code = args->references ? make_references(a, args, suite)
                                    : run_suite(a, args, suite, bands);
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
    {0, "suite", OPT_TEXT, AT(suite), "FILE", "what to measure (docs/bench.md); else a small suite",
     .file = OPT_READS},
    {0, "report", OPT_TEXT, AT(report), "DIR",
     "write report.json, report.html, records and pictures there; goes on with the records it "
     "finds"},
    {0, "fresh", OPT_FLAG, AT(fresh), NULL, "measure anew what --report has records of"},
    {0, "bands", OPT_TEXT, AT(bands), "FILE",
     "figures and their bounds: exit 1 and a line for each that is outside", .file = OPT_READS},
    {0, "write-fronts", OPT_TEXT, AT(fronts), "FILE",
     "what render --max-error and --budget-ms choose from (--fronts)", .file = OPT_WRITES},
    {0, "references", OPT_FLAG, AT(references), NULL,
     "make the references that are stored with the suite, or go on with them, and measure nothing"},
    {0, "scenes", OPT_TEXT, AT(scenes), "DIR",
     "folder of the sample scenes; else those built or installed with the program"},
    {0, "stress", OPT_FLAG, AT(stress), NULL,
     "instead of a suite: where numbers get extreme (docs/stress.md)"},
    {0, "quick", OPT_FLAG, AT(quick), NULL, "with --stress: a minute instead of ten"},
    {0, "axis", OPT_TEXT, AT(axis), "NAME", "with --stress: axes with this in their names"},
    {0, "methods", OPT_TEXT, AT(methods), "NAMES",
     "with --stress: these alone, with commas between"},
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
        "$XDG_CACHE_HOME/tyndall/references) or a file, times of first pictures, of frames after\n"
        "medium, light or camera have changed, and of unchanged ones, memory, imbalance,\n"
        "flicker, each node against the device's\n"
        "ceilings; per scene the front of error against time, and what path tracing needs\n"
        "for the same error.",
    .groups = groups,
    .num_groups = ARRAY_SIZE(groups),
    .args_size = sizeof(bench_args),
    .run = run_bench,
};
