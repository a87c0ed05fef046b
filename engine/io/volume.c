// volume.c -- grids: what all readers share.
#include "io/volume.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tyndall/extend/hash.h>
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
            return TYN_FAULT(log, TYN_ERR_PARAMS,
                             "%s: grid of %lld x %lld x %lld voxels: each size must be 1 to 65536",
                             file, (long long)size[0], (long long)size[1], (long long)size[2]);
        }
        voxels *= (uint64_t)size[a];
        volume->size[a] = (uint32_t)size[a];
    }
    if (voxels > TYN_MAX_VOXELS / channels) {
        return TYN_FAULT(log, TYN_ERR_PARAMS,
                         "%s: grid of %lld x %lld x %lld voxels: at most %llu in all (it is stored "
                         "dense); resample it coarser",
                         file, (long long)size[0], (long long)size[1], (long long)size[2],
                         (unsigned long long)(TYN_MAX_VOXELS / channels));
    }
    volume->data = calloc((size_t)voxels * channels, sizeof *volume->data);
    if (!volume->data) {
        return TYN_FAULT(log, TYN_ERR_MEMORY, "%s: no memory for %llu voxels", file,
                         (unsigned long long)voxels);
    }
    mat_identity(volume->index_to_world);
    return TYN_OK;
}

tyn_result tyn_grid_begin_list(tyn_grid_job *job, uint32_t count, const char *file)
{
    job->list = calloc(count + 1, sizeof *job->list);
    job->num_list = job->list ? count : 0;
    return job->list ? TYN_OK
                     : TYN_FAULT(job->log, TYN_ERR_MEMORY, "%s: no memory to list its grids", file);
}

void tyn_grid_drop(tyn_grid_job *job)
{
    tyn_volume_finish(&job->volume);
    free(job->list);
    job->list = NULL;
    job->num_list = 0;
}

uint64_t tyn_grid_hash(const uint32_t size[3], uint32_t channels, const float *data)
{
    const size_t count = (size_t)size[0] * size[1] * size[2] * channels;
    return tyn_hash_bytes(tyn_hash_bytes(TYN_HASH_SEED, size, 3 * sizeof *size), data,
                          count * sizeof *data);
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
            tyn_volume_finish(volume);
            return TYN_FAULT(job->log, TYN_ERR_PARAMS,
                             "%s: %s %g at voxel %llu, %llu, %llu: must be finite", file,
                             use_name(job->use), value, (unsigned long long)x,
                             (unsigned long long)y, (unsigned long long)z);
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
    volume->hash = tyn_grid_hash(volume->size, job->channels, volume->data);
    size_t room = strlen(file) + (grid ? strlen(grid) : 0) + 4;
    volume->name = malloc(room);
    if (volume->name) {
        snprintf(volume->name, room, grid ? "%s[%s]" : "%s", file, grid);
    }
    return TYN_OK;
}

void tyn_grid_box(double to_world[16], const double index_to_world[16], const uint32_t size[3])
{
    double box[16];
    mat_identity(box);
    for (int a = 0; a < 3; a++) {
        box[a * 5] = size[a];
        box[12 + a] = 0.5 * (size[a] - 1.0);
    }
    mat_mul(to_world, index_to_world, box);
}

void tyn_volume_grid_place(tyn_volume_grid *g)
{
    const double *m = g->index_to_world;
    for (int a = 0; a < 3; a++) {
        g->voxel[a] =
            sqrt(m[4 * a] * m[4 * a] + m[4 * a + 1] * m[4 * a + 1] + m[4 * a + 2] * m[4 * a + 2]);
    }
    for (int row = 0; row < 3 && g->active_voxels; row++) {
        double centre = m[12 + row], half = 0;
        for (int a = 0; a < 3; a++) {
            const double column = m[4 * a + row];
            centre += column * 0.5 * ((double)g->lo[a] + g->hi[a]);
            half += fabs(column) * 0.5 * ((double)g->hi[a] - g->lo[a] + 1);
        }
        g->world_lo[row] = centre - half;
        g->world_hi[row] = centre + half;
    }
}
