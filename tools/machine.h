// machine.h -- the device that --device names, with its pipelines cached on disk.
#pragma once
#include "app.h"
#include "pipeline_cache.h"
#include <tyndall/registry.h>

// --plugin FILE.so: loaded when it is read, so that methods and passes of the rest of the line may be its own.
#define PLUGIN_OPTION(at)                                                                          \
    {                                                                                              \
        0, "plugin", OPT_LIST, at, "FILE.so",                                                      \
            "load passes and methods of others (docs/writing-a-plugin.md); repeatable",            \
            .given = tyn_plugin_load                                                               \
    }

typedef struct machine_options {
    const char *device;
    opt_list plugins;
    bool quiet;
} machine_options;
extern const option machine_table[];
enum { MACHINE_TABLE_SIZE = 3 };

typedef struct machine {
    tyn_device *device;
    pipeline_cache cache;
} machine;

// Which device the options mean: its place in Vulkan's list. Applies --quiet. Gives the exit code.
int machine_choose(app *a, const machine_options *options, int *index, tyn_device_info *info);

// Opens the device and applies --quiet. Gives the exit code; `m` may be closed after a failure as well.
int machine_open(app *a, const machine_options *options, bool validation, machine *m);
void machine_close(machine *m); // writes the cache if it has grown; a failure of that is silent
