// paces_cache.c -- how fast a device is, measured once a day.
#include "bench/library.h"
#include "cache.h"
#include "paces.h"
#include "stats.h"
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <tyndall/io.h>
#include <unistd.h>

enum { SECONDS_KEPT = 24 * 3600, SIZE_LIMIT = 1 << 16 };

// Software devices are called alike on all processors: what tells these apart counts as well.
static uint64_t processor_hash(uint64_t seed)
{
    void *data = NULL;
    size_t size = 0;
    const long count = sysconf(_SC_NPROCESSORS_ONLN);
    uint64_t hash = text_hash(&count, sizeof count, seed);
    if (tyn_file_read("/proc/cpuinfo", 1u << 24, &data, &size, NULL) == TYN_OK && size > 0) {
        char *text = data;
        text[size - 1] = '\0';
        const char *line = strstr(text, "model name");
        hash = line ? text_hash(line, strcspn(line, "\n"), hash) : hash;
    }
    free(data);
    return hash;
}

static char *path_of(tyn_device *device)
{
    const char *const texts[] = {tyn_device_name(device), tyn_device_driver(device),
                                 tyn_version_string()};
    uint64_t hash = processor_hash(library_hash());
    for (size_t i = 0; i < ARRAY_SIZE(texts); i++) {
        hash = text_hash(texts[i], strlen(texts[i]), hash);
    }
    char *name = text_format("paces-%016llx.json", (unsigned long long)hash);
    char *path = name ? cache_path(name) : NULL;
    free(name);
    return path;
}

static bool all_known(const paces *p)
{
    return p->solve_ms > 0 && p->pixel_ns > 0 && p->sample_ns > 0;
}

static bool load(const char *path, paces *p)
{
    struct stat status;
    void *data = NULL;
    size_t size = 0;
    if (!path || stat(path, &status) != 0 || time(NULL) - status.st_mtime > SECONDS_KEPT ||
        tyn_file_read(path, SIZE_LIMIT, &data, &size, NULL) != TYN_OK) {
        return false;
    }
    cJSON *json = cJSON_ParseWithLength(data, size);
    free(data);
    *p = paces_read(json);
    cJSON_Delete(json);
    return all_known(p);
}

int paces_known(app *a, tyn_device *device, paces *p)
{
    char *path = path_of(device);
    int code = EXIT_DONE;
    if (!load(path, p)) {
        app_note(a, "measuring how fast this device is, once a day");
        code = paces_measure(a, device, p);
        const bool known = code == EXIT_DONE && all_known(p);
        if (code == EXIT_DONE && !known) {
            app_warn(a, "the device was too busy to be timed: times of kernels that were not are "
                        "foretold as of the machine of the stored figures");
        }
        cJSON *json = known && path ? paces_json(p) : NULL;
        char *text = json ? cJSON_Print(json) : NULL;
        if (text) { // without it they are measured again, and nothing else is lost
            tyn_file_write(path, text, strlen(text), NULL);
        }
        free(text);
        cJSON_Delete(json);
    }
    free(path);
    return code;
}
