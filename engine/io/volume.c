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

tyn_result tyn_volume_alloc(tyn_volume *volume, const int64_t size[3], const char *file,
                            const tyn_log *log)
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
    if (voxels > TYN_MAX_VOXELS) {
        tyn_log_print(log, TYN_LOG_ERROR,
                      "%s: grid of %lld x %lld x %lld voxels: at most %llu in all (it is stored "
                      "dense); resample it coarser",
                      file, (long long)size[0], (long long)size[1], (long long)size[2],
                      (unsigned long long)TYN_MAX_VOXELS);
        return TYN_ERR_PARAMS;
    }
    volume->data = calloc((size_t)voxels, sizeof *volume->data);
    if (!volume->data) {
        tyn_log_print(log, TYN_LOG_ERROR, "%s: no memory for %llu voxels", file,
                      (unsigned long long)voxels);
        return TYN_ERR_MEMORY;
    }
    mat_identity(volume->index_to_world);
    return TYN_OK;
}

tyn_result tyn_volume_seal(tyn_volume *volume, const char *file, const char *grid,
                           uint64_t *clamped_negative, const tyn_log *log)
{
    uint64_t voxels = (uint64_t)volume->size[0] * volume->size[1] * volume->size[2];
    uint64_t negative = 0;
    float most = 0.0f;
    for (uint64_t i = 0; i < voxels; i++) {
        float density = volume->data[i];
        if (!isfinite(density)) {
            uint64_t x = i % volume->size[0], y = i / volume->size[0] % volume->size[1];
            uint64_t z = i / volume->size[0] / volume->size[1];
            tyn_log_print(log, TYN_LOG_ERROR,
                          "%s: density %g at voxel %llu, %llu, %llu: must be finite", file, density,
                          (unsigned long long)x, (unsigned long long)y, (unsigned long long)z);
            tyn_volume_finish(volume);
            return TYN_ERR_PARAMS;
        }
        if (density < 0.0f) {
            negative++;
            volume->data[i] = 0.0f;
        } else if (density > most) {
            most = density;
        }
    }
    for (int i = 0; i < 16; i++) {
        if (!isfinite(volume->index_to_world[i])) {
            mat_identity(volume->index_to_world);
        }
    }
    *clamped_negative += negative;
    volume->max_density = most;
    volume->hash = tyn_hash_bytes(tyn_hash_bytes(TYN_HASH_SEED, volume->size, sizeof volume->size),
                                  volume->data, (size_t)voxels * sizeof *volume->data);
    size_t room = strlen(file) + (grid ? strlen(grid) : 0) + 4;
    volume->name = malloc(room);
    if (volume->name) {
        snprintf(volume->name, room, grid ? "%s[%s]" : "%s", file, grid);
    }
    return TYN_OK;
}

int tyn_volume_choose(const char *const *names, const char *const *types, const bool *readable,
                      uint32_t count, const char *grid, const char *file, const tyn_log *log)
{
    const char *wanted = grid ? grid : "density";
    char list[512] = "";
    for (uint32_t i = 0; i < count; i++) {
        if (strcmp(names[i], wanted) == 0 && (readable[i] || grid)) {
            if (readable[i]) {
                return (int)i;
            }
            tyn_log_print(log, TYN_LOG_ERROR,
                          "%s: grid \"%.100s\" holds %s values: must be float, half or quantised "
                          "float",
                          file, names[i], types[i]);
            return -1;
        }
    }
    for (uint32_t i = 0; i < count && !grid; i++) {
        if (readable[i]) {
            return (int)i;
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s\"%.60s\" (%s)", i ? ", " : "", names[i],
                 types[i]);
    }
    if (grid) {
        tyn_log_print(log, TYN_LOG_ERROR, "%s: no grid \"%.100s\": there are %s", file, grid,
                      count ? list : "none");
    } else {
        tyn_log_print(log, TYN_LOG_ERROR, "%s: no grid of float values: there are %s", file,
                      count ? list : "none");
    }
    return -1;
}

tyn_result tyn_volume_load(tyn_volume *volume, const char *path, const char *grid,
                           uint64_t *clamped_negative, const tyn_log *log)
{
    if (!TYN_GIVEN(log, volume, path)) {
        return TYN_ERR_PARAMS;
    }
    const char *dot = strrchr(path, '.');
    uint64_t ignored = 0;
    uint64_t *clamped = clamped_negative ? clamped_negative : &ignored;
    memset(volume, 0, sizeof *volume);
    if (dot && strcasecmp(dot, ".nvdb") == 0) {
        void *bytes;
        size_t size;
        tyn_result r = tyn_file_read(path, TYN_MAX_FILE_BYTES, &bytes, &size, log);
        if (!r) {
            r = tyn_nvdb_parse(volume, bytes, size, grid, path, clamped, log);
            free(bytes);
        }
        return r;
    }
    if (dot && strcasecmp(dot, ".vdb") == 0) {
        return tyn_vdb_load(volume, path, grid, clamped, log);
    }
    if (dot && strcasecmp(dot, ".raw") == 0) {
        tyn_log_print(log, TYN_LOG_ERROR,
                      "%s: a .raw file does not say its size: give \"size\" and \"type\" in a "
                      "glTF scene",
                      path);
        return TYN_ERR_PARAMS;
    }
    tyn_log_print(log, TYN_LOG_ERROR, "%s: unknown kind of volume: must be .nvdb, .vdb or .raw",
                  path);
    return TYN_ERR_PARAMS;
}
