// pipeline_cache.c -- compiled pipelines of a device, kept on disk between runs.
#include "pipeline_cache.h"
#include "app.h"
#include "cache.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tyndall/io.h>

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

void pipeline_cache_read(pipeline_cache *c, const tyn_device_info *info)
{
    *c = (pipeline_cache){.path = pipelines_path(info)};
    size_t file_size = 0;
    if (c->path) {
        tyn_file_read(c->path, CACHE_LIMIT, &c->file, &file_size, NULL);
    }
    c->bytes = cache_bytes(c->file, file_size, &c->size, &c->hash);
}

void pipeline_cache_write(const pipeline_cache *c, tyn_device *device)
{
    size_t size = 0;
    void *bytes = c->path ? tyn_device_pipeline_cache(device, &size) : NULL;
    char *file = bytes && size ? malloc(sizeof(cache_header) + size) : NULL;
    if (file) {
        cache_header header = {.size = size, .hash = text_hash(bytes, size, 0)};
        memcpy(header.magic, cache_magic, sizeof cache_magic);
        memcpy(file, &header, sizeof header);
        memcpy(file + sizeof header, bytes, size);
        if (header.hash != c->hash) {
            tyn_file_write(c->path, file, sizeof header + size, NULL);
        }
    }
    free(file);
    free(bytes);
}

void pipeline_cache_finish(pipeline_cache *c)
{
    free(c->path);
    free(c->file);
    *c = (pipeline_cache){0};
}
