// stress_command.c -- `tyndall bench --stress`.
#include "stress.h"
#include "folder.h"
#include "html.h"
#include "json.h"
#include "library.h"
#include "stats.h"
#include <tyndall/io.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static cJSON *read_json(const char *path)
{
    void *data = NULL;
    size_t size = 0;
    bool read = tyn_file_read(path, 256u << 20, &data, &size, NULL) == TYN_OK;
    cJSON *root = read ? cJSON_ParseWithLength(data, size) : NULL;
    free(data);
    return root;
}

// ---- whose figures they are -------------------------------------------------------------------

enum { STRESS_VERSION = 1 };

// Head of stress.json, or of the object "stress" of a report.
static void add_head(cJSON *stress, uint64_t library, tyn_device *device, bool quick)
{
    cJSON_AddStringToObject(stress, "schema", "tyndall-stress");
    cJSON_AddNumberToObject(stress, "version", STRESS_VERSION);
    cJSON_AddStringToObject(stress, "tyndall", tyn_version_string());
    json_add_hash(stress, "library", library);
    json_add_date(stress);
    cJSON *of = cJSON_AddObjectToObject(stress, "device");
    cJSON_AddStringToObject(of, "name", tyn_device_name(device));
    cJSON_AddStringToObject(of, "driver", tyn_device_driver(device));
    cJSON_AddBoolToObject(stress, "quick", quick);
}

// A report's or a stress.json's.
static bool is_of(const cJSON *root, uint64_t library, tyn_device *device)
{
    char hash[17];
    snprintf(hash, sizeof hash, "%016llx", (unsigned long long)library);
    const cJSON *of = cJSON_GetObjectItemCaseSensitive(root, "device");
    return strcmp(json_text(root, "library"), hash) == 0 &&
           strcmp(json_text(of, "name"), tyn_device_name(device)) == 0 &&
           strcmp(json_text(of, "driver"), tyn_device_driver(device)) == 0;
}

cJSON *stress_read(app *a, const char *dir, uint64_t library, tyn_device *device)
{
    char *path = text_format("%s/stress.json", dir);
    cJSON *stress = path ? read_json(path) : NULL;
    const bool known = strcmp(json_text(stress, "schema"), "tyndall-stress") == 0 &&
                       json_figure(stress, "version") == STRESS_VERSION;
    if (stress && !(known && is_of(stress, library, device))) {
        app_warn(a, "%s is not of this build on this device; it is left out", path);
        cJSON_Delete(stress);
        stress = NULL;
    }
    free(path);
    return stress;
}

// ---- the command ------------------------------------------------------------------------------

// The object goes into a report that is there, and onto its page.
static int write_stress(app *a, const cJSON *stress, const char *dir, uint64_t library,
                        tyn_device *device)
{
    char *own = text_format("%s/stress.json", dir), *report = text_format("%s/report.json", dir);
    char *page = text_format("%s/report.html", dir);
    int code = own && report && page ? json_write(a, cJSON_Duplicate(stress, true), own)
                                     : app_exit_code(a, TYN_ERR_MEMORY, false);
    cJSON *root = code == EXIT_DONE ? read_json(report) : NULL;
    if (root && is_of(root, library, device)) {
        cJSON_DeleteItemFromObject(root, "stress");
        cJSON_AddItemToObject(root, "stress", cJSON_Duplicate(stress, true));
        code = html_write(a, root, dir, page);
        code = code == EXIT_DONE ? json_write(a, cJSON_Duplicate(root, true), report) : code;
    } else if (root) {
        app_warn(a, "%s is not of this build on this device: it is left as it is", report);
    }
    cJSON_Delete(root);
    free(own);
    free(report);
    free(page);
    return code;
}

int stress_command(app *a, const machine_options *options, const stress_options *what,
                   const char *report, bool json)
{
    machine mach = {0};
    cJSON *stress = cJSON_CreateObject(), *before = NULL;
    const uint64_t library = library_hash();
    int code = report ? folder_make(a, "--report", report) : EXIT_DONE;
    if (code == EXIT_DONE) {
        code = machine_open(a, options, false, &mach);
    }
    if (code == EXIT_DONE) {
        before = report ? stress_read(a, report, library, mach.device) : NULL;
        add_head(stress, library, mach.device, what->quick);
        // Quick cells have references of their own: they do not go with others.
        const bool goes_on = before && json_true(before, "quick") == what->quick;
        code = stress_run(a, mach.device, what, !json, goes_on ? before : NULL, stress);
    }
    if (code == EXIT_DONE) {
        code = report ? write_stress(a, stress, report, library, mach.device) : EXIT_DONE;
    }
    machine_close(&mach);
    if (code == EXIT_DONE && json) {
        code = json_write(a, cJSON_Duplicate(stress, true), NULL);
    } else if (code == EXIT_DONE) {
        stress_print(stress);
    }
    if (code == EXIT_DONE && stress_faults(a, stress) > 0) {
        code = EXIT_FAILED;
    }
    cJSON_Delete(before);
    cJSON_Delete(stress);
    return code;
}
