// pipeline_cache.c -- compiled pipelines of a device, kept on disk between runs.
#include "pipeline_cache.h"
#include "app.h"
#include "cache.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tyndall/io.h>

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

void pipeline_cache_read(pipeline_cache *c, const tyn_device_info *info)
{
    *c = (pipeline_cache){.path = pipelines_path(info)};
    if (c->path) {
        tyn_file_read(c->path, CACHE_LIMIT, &c->bytes, &c->size, NULL);
    }
}

void pipeline_cache_write(const pipeline_cache *c, tyn_device *device)
{
    size_t size = 0;
    void *bytes = NULL;
    if (c->path && tyn_device_pipeline_cache(device, NULL, &size) == TYN_OK) {
        bytes = malloc(size);
    }
    if (bytes && tyn_device_pipeline_cache(device, bytes, &size) == TYN_OK &&
        (size != c->size || memcmp(bytes, c->bytes, size) != 0)) {
        tyn_file_write(c->path, bytes, size, NULL);
    }
    free(bytes);
}

void pipeline_cache_finish(pipeline_cache *c)
{
    free(c->path);
    free(c->bytes);
    *c = (pipeline_cache){0};
}
