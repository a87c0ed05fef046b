// machine.c -- the device that --device names, with its pipelines cached on disk.
#include "machine.h"
#include "devices.h"
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const option machine_table[MACHINE_TABLE_SIZE] = {
    {0, "device", OPT_TEXT, offsetof(machine_options, device), "INDEX|NAME",
     "which device ('tyndall info --devices'); else a discrete, an integrated, any other"},
    PLUGIN_OPTION(offsetof(machine_options, plugins)),
    {'q', "quiet", OPT_FLAG, offsetof(machine_options, quiet), NULL,
     "errors only: no progress, notes or warnings"},
};

// ---- choosing ---------------------------------------------------------------------------------

static bool name_contains(const char *name, const char *part)
{
    for (; *name; name++) {
        size_t i = 0;
        while (part[i] && tolower((unsigned char)name[i]) == tolower((unsigned char)part[i])) {
            i++;
        }
        if (!part[i]) {
            return true;
        }
    }
    return false;
}

static int rank(const tyn_device_info *info)
{
    static const char *const order[] = {"virtual", "integrated", "discrete"};
    int value = info->missing[0] ? 0 : 10;
    for (int i = 0; i < (int)ARRAY_SIZE(order); i++) {
        value += strcmp(info->type, order[i]) == 0 ? i + 1 : 0;
    }
    return value;
}

// The index of the device to open, or -1 if there is none of that name.
static int choose(const devices *d, const char *select)
{
    char *end = NULL;
    long index = select ? strtol(select, &end, 10) : 0;
    bool by_index = select && isdigit((unsigned char)*select) && *end == '\0';
    int best = -1;
    for (int i = 0; i < d->count; i++) {
        bool wanted =
            !select || (by_index ? i == index : *select && name_contains(d->infos[i].name, select));
        if (wanted && (best < 0 || rank(&d->infos[i]) > rank(&d->infos[best]))) {
            best = i;
        }
    }
    return best;
}

static void say_what_there_is(app *a, const devices *d, const char *select)
{
    char line[1024];
    size_t used = 0;
    for (int i = 0; i < d->count && used < sizeof line; i++) {
        used += (size_t)snprintf(line + used, sizeof line - used, "%s %d '%s'", i ? "," : "", i,
                                 d->infos[i].name);
    }
    app_error(a, "--device: there is no device '%s'; there %s:%s", select,
              d->count == 1 ? "is" : "are", line);
}

// ---- open and close ---------------------------------------------------------------------------

static int open_chosen(app *a, const tyn_device_info *info, int index, bool validation, machine *m)
{
    char select[16];
    snprintf(select, sizeof select, "%d", index);
    pipeline_cache_read(&m->cache, info);
    tyn_result result =
        tyn_device_open(tyn_device_open_params(.select = select, .validation = validation,
                                               .pipeline_cache = m->cache.bytes,
                                               .pipeline_cache_size = m->cache.size, .log = a->log),
                        &m->device);
    return app_exit_code(a, result, false);
}

int machine_choose(app *a, const machine_options *options, int *index, tyn_device_info *info)
{
    a->quiet = options->quiet;
    devices d;
    int code = devices_list(a, &d);
    if (code == EXIT_DONE) {
        *index = choose(&d, options->device);
        if (*index < 0) {
            say_what_there_is(a, &d, options->device);
            code = EXIT_WRONG;
        } else {
            *info = d.infos[*index];
        }
    }
    devices_finish(&d);
    return code;
}

int machine_open(app *a, const machine_options *options, bool validation, machine *m)
{
    *m = (machine){0};
    int index;
    tyn_device_info info;
    int code = machine_choose(a, options, &index, &info);
    return code == EXIT_DONE ? open_chosen(a, &info, index, validation, m) : code;
}

void machine_close(machine *m)
{
    if (m->device) {
        pipeline_cache_write(&m->cache, m->device);
    }
    tyn_device_destroy(&m->device);
    pipeline_cache_finish(&m->cache);
    *m = (machine){0};
}
