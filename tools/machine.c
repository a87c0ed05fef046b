// machine.c -- the device that --device names, with its pipelines cached on disk.
#include "machine.h"
#include "cache.h"
#include "devices.h"
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tyndall/io.h>

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

// ---- the pipeline cache on disk ---------------------------------------------------------------

// In front of the driver's bytes. Vulkan lets a driver trust them, so a damaged file must not get there.
typedef struct cache_header {
    char magic[8];
    uint64_t size, hash;
} cache_header;
static const char cache_magic[8] = "TYNPIPE1";

enum { CACHE_LIMIT = 256 << 20 };

static char *pipelines_path(const tyn_device_info *info)
{
    uint64_t key = text_hash(info->name, strlen(info->name), info->api_version);
    key = text_hash(info->driver, strlen(info->driver), key);
    key = text_hash(tyn_version_string(), strlen(tyn_version_string()), key);
    char name[40];
    snprintf(name, sizeof name, "pipelines-%016llx", (unsigned long long)key);
    return cache_path(name);
}

// The driver's bytes in `file`, or NULL if the file is not whole.
static const void *cache_bytes(const void *file, size_t file_size, size_t *size, uint64_t *hash)
{
    cache_header header;
    if (!file || file_size < sizeof header) {
        return NULL;
    }
    memcpy(&header, file, sizeof header);
    const void *bytes = (const char *)file + sizeof header;
    if (memcmp(header.magic, cache_magic, sizeof cache_magic) != 0 ||
        header.size != file_size - sizeof header ||
        header.hash != text_hash(bytes, header.size, 0)) {
        return NULL;
    }
    *size = (size_t)header.size;
    *hash = header.hash;
    return bytes;
}

static void cache_write(machine *m)
{
    size_t size = 0;
    void *bytes = m->cache_path ? tyn_device_pipeline_cache(m->device, &size) : NULL;
    char *file = bytes && size ? malloc(sizeof(cache_header) + size) : NULL;
    if (file) {
        cache_header header = {.size = size, .hash = text_hash(bytes, size, 0)};
        memcpy(header.magic, cache_magic, sizeof cache_magic);
        memcpy(file, &header, sizeof header);
        memcpy(file + sizeof header, bytes, size);
        if (header.hash != m->cache_hash) {
            tyn_file_write(m->cache_path, file, sizeof header + size, NULL);
        }
    }
    free(file);
    free(bytes);
}

// ---- open and close ---------------------------------------------------------------------------

static int open_chosen(app *a, const tyn_device_info *info, int index, bool validation, machine *m)
{
    char select[16];
    snprintf(select, sizeof select, "%d", index);
    void *file = NULL;
    size_t file_size = 0, size = 0;
    m->cache_path = pipelines_path(info);
    if (m->cache_path) {
        tyn_file_read(m->cache_path, CACHE_LIMIT, &file, &file_size, NULL);
    }
    const void *bytes = cache_bytes(file, file_size, &size, &m->cache_hash);
    tyn_result result = tyn_device_open(
        tyn_device_open_params(.select = select, .validation = validation, .pipeline_cache = bytes,
                               .pipeline_cache_size = size, .log = a->log),
        &m->device);
    free(file);
    return app_exit_code(a, result, false);
}

int machine_open(app *a, const machine_options *options, bool validation, machine *m)
{
    *m = (machine){0};
    a->quiet = options->quiet;
    devices d;
    int code = devices_list(a, &d);
    if (code == EXIT_DONE) {
        int index = choose(&d, options->device);
        if (index < 0) {
            say_what_there_is(a, &d, options->device);
            code = EXIT_WRONG;
        } else {
            code = open_chosen(a, &d.infos[index], index, validation, m);
        }
    }
    devices_finish(&d);
    return code;
}

void machine_close(machine *m)
{
    if (m->device) {
        cache_write(m);
    }
    tyn_device_destroy(&m->device);
    free(m->cache_path);
    *m = (machine){0};
}
