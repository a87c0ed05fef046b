// volume.c -- density grids: what all readers share, and the choice of reader by file extension.
#include "io/volume.h"
#include "base/given.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "base/hash.h"
#include "io/nvdb.h"
#include "io/vdb.h"
#include "scene/matrix.h"

void tyn_volume_finish(tyn_volume *volume)
{
    if (volume) {
        free(volume->name);
        free(volume->data);
        memset(volume, 0, sizeof *volume);
    }
}

tyn_result tyn_volume_alloc(tyn_volume *volume, const int64_t size[3], uint32_t channels,
                            const char *file, const tyn_log *log)
{
    uint64_t voxels = 1;
    memset(volume, 0, sizeof *volume);
    for (int a = 0; a < 3; a++) {
        if (size[a] < 1 || size[a] > 65536) {
            tyn_log_print(log, TYN_LOG_ERROR,
                          "%s: grid of %lld x %lld x %lld voxels: each size must be 1 to 65536",
                          file, (long long)size[0], (long long)size[1], (long long)size[2]);
            return TYN_ERR_PARAMS;
        }
        voxels *= (uint64_t)size[a];
        volume->size[a] = (uint32_t)size[a];
    }
    if (voxels > TYN_MAX_VOXELS / channels) {
        tyn_log_print(log, TYN_LOG_ERROR,
                      "%s: grid of %lld x %lld x %lld voxels: at most %llu in all (it is stored "
                      "dense); resample it coarser",
                      file, (long long)size[0], (long long)size[1], (long long)size[2],
                      (unsigned long long)(TYN_MAX_VOXELS / channels));
        return TYN_ERR_PARAMS;
    }
    volume->data = calloc((size_t)voxels * channels, sizeof *volume->data);
    if (!volume->data) {
        tyn_log_print(log, TYN_LOG_ERROR, "%s: no memory for %llu voxels", file,
                      (unsigned long long)voxels);
        return TYN_ERR_MEMORY;
    }
    mat_identity(volume->index_to_world);
    return TYN_OK;
}

static const char *use_name(tyn_grid_use use)
{
    return use == TYN_GRID_DENSITY ? "density" : use == TYN_GRID_COLOR ? "colour" : "value";
}

tyn_result tyn_grid_seal(tyn_grid_job *job, const char *file, const char *grid)
{
    tyn_volume *volume = &job->volume;
    const uint64_t voxels = (uint64_t)volume->size[0] * volume->size[1] * volume->size[2];
    const uint64_t count = voxels * job->channels;
    float most = 0.0f;
    for (uint64_t i = 0; i < count; i++) {
        const float value = volume->data[i];
        if (!isfinite(value)) {
            const uint64_t v = i / job->channels, x = v % volume->size[0];
            const uint64_t y = v / volume->size[0] % volume->size[1];
            const uint64_t z = v / volume->size[0] / volume->size[1];
            tyn_log_print(job->log, TYN_LOG_ERROR,
                          "%s: %s %g at voxel %llu, %llu, %llu: must be finite", file,
                          use_name(job->use), value, (unsigned long long)x, (unsigned long long)y,
                          (unsigned long long)z);
            tyn_volume_finish(volume);
            return TYN_ERR_PARAMS;
        }
        if (value < 0.0f && job->use != TYN_GRID_VALUE) {
            job->clamped++;
            volume->data[i] = 0.0f;
        } else if (value > most) {
            most = value;
        }
    }
    for (int i = 0; i < 16; i++) {
        if (!isfinite(volume->index_to_world[i])) {
            mat_identity(volume->index_to_world);
        }
    }
    volume->max_density = most;
    volume->hash = tyn_hash_bytes(tyn_hash_bytes(TYN_HASH_SEED, volume->size, sizeof volume->size),
                                  volume->data, (size_t)count * sizeof *volume->data);
    size_t room = strlen(file) + (grid ? strlen(grid) : 0) + 4;
    volume->name = malloc(room);
    if (volume->name) {
        snprintf(volume->name, room, grid ? "%s[%s]" : "%s", file, grid);
    }
    return TYN_OK;
}

static bool has_extension(const char *path, const char *extension)
{
    const char *dot = strrchr(path, '.');
    return dot && strcasecmp(dot, extension) == 0;
}

tyn_result tyn_grid_read(tyn_grid_job *job, const char *path)
{
    if (has_extension(path, ".nvdb")) {
        void *bytes;
        size_t size;
        tyn_result r = tyn_file_read(path, TYN_MAX_FILE_BYTES, &bytes, &size, job->log);
        if (!r) {
            r = tyn_nvdb_read(job, bytes, size, path);
            free(bytes);
        }
        return r;
    }
    if (has_extension(path, ".vdb")) {
        return tyn_vdb_read(job, path);
    }
    if (has_extension(path, ".raw")) {
        tyn_log_print(job->log, TYN_LOG_ERROR,
                      "%s: a .raw file does not say its size: give \"size\" and \"type\" in a "
                      "glTF scene",
                      path);
        return TYN_ERR_PARAMS;
    }
    tyn_log_print(job->log, TYN_LOG_ERROR,
                  "%s: unknown kind of volume: must be .nvdb, .vdb or .raw", path);
    return TYN_ERR_PARAMS;
}

tyn_result tyn_volume_load(tyn_volume *volume, const char *path, const char *grid,
                           uint64_t *clamped_negative, const tyn_log *log)
{
    if (!TYN_GIVEN(log, volume, path)) {
        return TYN_ERR_PARAMS;
    }
    tyn_grid_job job = {.grid = grid, .log = log};
    const tyn_result r = tyn_grid_read(&job, path);
    *volume = job.volume;
    if (clamped_negative) {
        *clamped_negative += job.clamped;
    }
    return r;
}
