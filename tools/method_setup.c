// method_setup.c -- --method, --quality, -D and the options of sampling methods.
#include "method_setup.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const qualities[] = {"draft", "normal", "high", NULL};

#define AT(field) offsetof(method_options, field)
const option method_table[METHOD_TABLE_SIZE] = {
    {'m', "method", OPT_TEXT, AT(method), "NAME",
     "how to compute it, default pop ('tyndall info --methods')"},
    {0, "quality", OPT_TEXT, AT(quality), "draft|normal|high", "preset of all parameters",
     .names = qualities},
    {'D', NULL, OPT_LIST, AT(defines), "PASS.PARAM=VALUE",
     "set one parameter ('tyndall info --passes'); repeatable, after --quality"},
    {0, "spp", OPT_UINT, AT(spp), "N", "samples a pixel or point, of methods that sample; else 64",
     NAN, 1, 16777216},
    {0, "refine", OPT_TEXT, AT(refine), "N|1/N",
     "pop refined by N paths a pixel, from 1/256 on: the same as method 'refined'"},
    {0, "seed", OPT_UINT, AT(seed), "N", "of the random numbers", 0, 0, 4294967295.0},
    {0, "max-depth", OPT_UINT, AT(max_depth), "N", "longest path in scatterings; 0 = no limit", 0},
    {0, "rr-depth", OPT_UINT, AT(rr_depth), "N",
     "Russian roulette from this many scatterings on; 0 = the method's choice", 0},
    {0, "memory-budget", OPT_UINT, AT(memory_budget), "MiB",
     "refuse what takes more device memory; 0 = no limit", 0},
};

bool method_find(app *a, const char *name, tyn_method_info *info)
{
    if (tyn_method_named(name, info)) {
        return true;
    }
    char line[512] = "";
    size_t used = 0;
    for (uint32_t i = 0; i < tyn_num_methods() && used < sizeof line; i++) {
        tyn_method_at(i, info);
        used +=
            (size_t)snprintf(line + used, sizeof line - used, "%s %s", i ? "," : "", info->name);
    }
    const char *others = tyn_methods_left_out();
    app_error(a, "%s: there is no method '%s'; there are:%s%s%s", app_word(a, "--method", "method"),
              name, line, others[0] ? "; not in this build: " : "", others);
    return false;
}

bool method_define(app *a, tyn_settings *settings, const char *define)
{
    const char *equals = strchr(define, '=');
    char name[128];
    if (!equals || equals == define || !equals[1] || (size_t)(equals - define) >= sizeof name) {
        app_error(a,
                  "%s: '%s' is not PASS.PARAM=VALUE; 'tyndall info --passes' lists the parameters",
                  app_word(a, "-D", "settings"), define);
        return false;
    }
    snprintf(name, sizeof name, "%.*s", (int)(equals - define), define);
    return tyn_settings_set(settings, name, equals + 1, &a->log) == TYN_OK;
}

// Squares of pixels that a sample is of, and samples of each: four at least, which two halves need.
static bool refine_parse(const char *text, uint32_t *grid, uint32_t *spp)
{
    char *end;
    double n = strtod(text, &end);
    if (*end == '/' && end[1] >= '0' && end[1] <= '9') {
        n /= strtod(end + 1, &end);
    }
    if (*end || !(n >= 1.0 / 256) || !(n <= 1 << 24)) {
        return false;
    }
    *grid = 1;
    while (*grid < 16 && n * *grid * *grid < 4) {
        *grid *= 2;
    }
    *spp = (uint32_t)fmax(1, round(n * *grid * *grid));
    return true;
}

// Then what is taken from pop without samples would be seen.
static bool refine_is_long(const method_options *options)
{
    enum { LONG = 64 }; // samples a pixel
    uint32_t grid, spp;
    return refine_parse(options->refine, &grid, &spp) && spp > LONG * grid * grid;
}

// --refine: the method that it stands for, and its setting. NULL: said.
static const char *method_refined(app *a, const method_options *options, char grid[16])
{
    uint32_t side, spp;
    if (options->method && strcmp(options->method, "pop") && strcmp(options->method, "refined")) {
        app_error(a, "--refine and --method %s: only pop is refined", options->method);
    } else if (options->spp) {
        app_error(a, "--refine %s and --spp %u: --refine says how many samples there are",
                  options->refine, options->spp);
    } else if (!refine_parse(options->refine, &side, &spp)) {
        app_error(a, "--refine: '%s' is no number of samples a pixel from 1/256 on, as 2 or 1/8",
                  options->refine);
    } else {
        snprintf(grid, 16, "%u", side);
        return "refined";
    }
    return NULL;
}

int method_open(app *a, const method_options *options, method *m)
{
    *m = (method){.memory_budget = (uint64_t)options->memory_budget << 20};
    char grid[16], bias[32];
    const char *name = options->refine ? method_refined(a, options, grid) : options->method;
    if ((options->refine && !name) || !method_find(a, name, &m->info)) {
        return EXIT_WRONG;
    }
    tyn_result result = tyn_settings_create(&m->settings);
    if (result == TYN_OK && options->refine) {
        result = tyn_settings_set(m->settings, "refine.grid", grid, &a->log);
        if (result == TYN_OK && (options->until > 0 || refine_is_long(options))) {
            snprintf(bias, sizeof bias, "%g", (double)options->until);
            result = tyn_settings_set(m->settings, "refine.bias", bias, &a->log);
        }
    }
    if (result == TYN_OK && options->quality) {
        result = tyn_settings_quality(m->settings, options->quality, &a->log);
    }
    if (result != TYN_OK) {
        return app_exit_code(a, result, false);
    }
    for (uint32_t i = 0; i < options->defines.count; i++) {
        if (!method_define(a, m->settings, options->defines.items[i])) {
            return EXIT_WRONG;
        }
    }
    return EXIT_DONE;
}

void method_finish(method *m)
{
    tyn_settings_destroy(&m->settings);
}

uint32_t method_samples(const method_options *options, uint32_t otherwise)
{
    uint32_t grid, spp;
    if (options->refine && refine_parse(options->refine, &grid, &spp)) {
        return spp;
    }
    return options->spp ? options->spp : otherwise;
}

void method_view(const method_options *options, tyn_view *view)
{
    view->num_samples = method_samples(options, 64);
    view->seed = options->seed;
    view->max_depth = options->max_depth;
    view->rr_depth = options->rr_depth;
}
