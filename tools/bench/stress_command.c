// stress_command.c -- `tyndall bench --stress`.
#include "stress.h"
#include "html.h"
#include "stats.h"
#include <tyndall/io.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static cJSON *read_json(const char *path)
{
    void *data = NULL;
    size_t size = 0;
    bool read = tyn_file_read(path, 256u << 20, &data, &size, NULL) == TYN_OK;
    cJSON *root = read ? cJSON_ParseWithLength(data, size) : NULL;
    free(data);
    return root;
}

// The object goes into a report that is there, and onto its page.
static int write_stress(app *a, const cJSON *stress, const char *dir)
{
    mkdir(dir, 0777);
    char *own = text_format("%s/stress.json", dir), *report = text_format("%s/report.json", dir);
    int code = own && report ? json_write(a, cJSON_Duplicate(stress, true), own)
                             : app_exit_code(a, TYN_ERR_MEMORY, false);
    cJSON *root = code == EXIT_DONE ? read_json(report) : NULL;
    if (root) {
        char *page = text_format("%s/report.html", dir);
        cJSON_DeleteItemFromObject(root, "stress");
        cJSON_AddItemToObject(root, "stress", cJSON_Duplicate(stress, true));
        code = page ? html_write(a, root, dir, page) : app_exit_code(a, TYN_ERR_MEMORY, false);
        code = code == EXIT_DONE ? json_write(a, root, report) : code;
        free(page);
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
