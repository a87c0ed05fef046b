// stress_command.c -- `tyndall bench --stress`.
#include "stress.h"
#include "stats.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static cJSON *read_json(const char *path)
{
    cJSON *root = NULL;
    FILE *f = fopen(path, "rb");
    char *text = NULL;
    size_t size = 0, got;
    char block[4096];
    while (f && (got = fread(block, 1, sizeof block, f)) > 0) {
        char *longer = realloc(text, size + got + 1);
        if (!longer) {
            break;
        }
        text = longer;
        memcpy(text + size, block, got);
        size += got;
    }
    if (text) {
        root = cJSON_ParseWithLength(text, size);
    }
    if (f) {
        fclose(f);
    }
    free(text);
    return root;
}

static int write_stress(app *a, const cJSON *stress, const char *dir)
{
    mkdir(dir, 0777);
    char *own = text_format("%s/stress.json", dir), *report = text_format("%s/report.json", dir);
    int code = own && report ? json_write(a, cJSON_Duplicate(stress, true), own)
                             : app_exit_code(a, TYN_ERR_MEMORY, false);
    cJSON *root = code == EXIT_DONE ? read_json(report) : NULL;
    if (root) {
        cJSON_DeleteItemFromObject(root, "stress");
        cJSON_AddItemToObject(root, "stress", cJSON_Duplicate(stress, true));
        code = json_write(a, root, report);
    }
    free(own);
    free(report);
    return code;
}

int stress_command(app *a, const machine_options *options, const stress_options *what,
                   const char *report, bool json)
{
    machine mach = {0};
    cJSON *stress = NULL;
    int code = machine_open(a, options, false, &mach);
    if (code == EXIT_DONE) {
        code = stress_run(a, mach.device, what, !json, &stress);
    }
    machine_close(&mach);
    if (code == EXIT_DONE && report) {
        code = write_stress(a, stress, report);
    }
    if (code == EXIT_DONE && json) {
        code = json_write(a, cJSON_Duplicate(stress, true), NULL);
    } else if (code == EXIT_DONE) {
        stress_print(stress);
    }
    if (code == EXIT_DONE && stress_faults(a, stress) > 0) {
        code = EXIT_FAILED;
    }
    cJSON_Delete(stress);
    return code;
}
