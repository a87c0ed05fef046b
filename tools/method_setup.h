// method_setup.h -- --method, --quality, -D and the options of sampling methods.
#pragma once
#include "app.h"
#include <tyndall/registry.h>

typedef struct method_options {
    const char *method, *quality;
    opt_list defines;   // pass.param=value
    uint32_t spp;       // 0: not given
    const char *refine; // "2", "1/8": samples a pixel that pop is refined by; NULL: not asked for
    float until;        // relative error that is asked for; 0: none
    uint32_t seed, max_depth, rr_depth;
    uint32_t memory_budget; // MiB; 0 = no limit
} method_options;
extern const option method_table[];
enum { METHOD_TABLE_SIZE = 9 };

typedef struct method {
    tyn_method_info info;
    tyn_settings *settings;
    uint64_t memory_budget; // bytes; 0 = no limit
} method;

// Finds a method by its name, NULL = the default. False: one line that lists those there are.
bool method_find(app *a, const char *name, tyn_method_info *info);

// Gives the exit code; method_finish is due in any case.
int method_open(app *a, const method_options *options, method *m);
void method_finish(method *m);

// "pass.param=value" into settings. False: said.
bool method_define(app *a, tyn_settings *settings, const char *define);

// Samples that are asked for; `otherwise`: where none are.
uint32_t method_samples(const method_options *options, uint32_t otherwise);
// Seed, samples and depths into the view.
void method_view(const method_options *options, tyn_view *view);
