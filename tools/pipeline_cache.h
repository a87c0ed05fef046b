// pipeline_cache.h -- compiled pipelines of a device, kept on disk between runs.
#pragma once
#include <tyndall/device.h>

typedef struct pipeline_cache {
    char *path;  // NULL: no place for a cache
    void *bytes; // for tyn_device_params.pipeline_cache; NULL: there is none yet
    size_t size;
} pipeline_cache;

void pipeline_cache_read(pipeline_cache *c, const tyn_device_info *info);
// Writes the device's cache if it has grown; a failure of that is silent.
void pipeline_cache_write(const pipeline_cache *c, tyn_device *device);
void pipeline_cache_finish(pipeline_cache *c);
