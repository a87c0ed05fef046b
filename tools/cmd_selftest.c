// cmd_selftest.c -- `tyndall selftest`: does this machine compute what is known to be right?
//
// Reads no files but those it writes. Expected values are closed forms, figures from the literature, and rows of
// reference tables that were computed for this project: slabs with DISORT 4.0.99 (128 streams, fluxes to 1e-6),
// the cube with pbrt-v3 (standard error of an image mean below 0.1 %).
#include "devices.h"
#include "selftest.h"
#include "stats.h"
#include <stdio.h>
#include <stdlib.h>

typedef struct selftest_args {
    machine_options machine;
    bool json;
} selftest_args;

// A frame of each under the validation layers, where they are installed.
static int check_validation(selftest *t, const char *device)
{
    tyn_device *own = t->device, *validating = NULL;
    tyn_result result =
        tyn_device_open(tyn_device_open_params(.select = device, .validation = true), &validating);
    if (result != TYN_OK) {
        selftest_skip(t, "validation", "the layers are not installed");
        return EXIT_DONE;
    }
    t->device = validating;
    int code = EXIT_DONE;
    for (uint32_t i = 0; i < tyn_num_methods() && code == EXIT_DONE; i++) {
        tyn_method_info info;
        tyn_method_at(i, &info);
        renderer r;
        code = selftest_render_cube(t, info.name, 1, &r);
        if (code == EXIT_DONE) {
            renderer_close(&r);
        }
    }
    t->device = own;
    selftest_check(t, "validation, every method: messages",
                   tyn_device_validation_messages(validating), 0, 0, "the Vulkan layers");
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
        if (t->json) {
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
    int (*const checks[])(selftest *) = {
        selftest_rows,  selftest_files,      selftest_graphs, selftest_furnace, selftest_cubes,
        selftest_slabs, selftest_half_space, selftest_lamps,  selftest_energy,  selftest_repeats,
    };
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
    selftest t = {.a = a, .json = args->json};
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
            printf("%s: %u checks, %u failed, %u skipped, %.0f s\n",
                   ok ? "all right" : "NOT all right", t.num_checks, t.num_failed, t.num_skipped,
                   seconds);
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
    .summary = "Furnaces, energy, tables, graphs, files, devices: what a bug report needs.",
    .groups = groups,
    .num_groups = ARRAY_SIZE(groups),
    .args_size = sizeof(selftest_args),
    .run = run_selftest,
};
