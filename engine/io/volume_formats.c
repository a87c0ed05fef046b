// volume_formats.c -- volume files of every format, each by its reader.
#include "base/given.h"
#include "io/nvdb.h"
#include "io/vdb.h"
#include <string.h>
#include <strings.h>

static const struct {
    const char *extension;
    tyn_result (*read)(tyn_grid_job *job, const char *path);
} formats[] = {
#define ROW(name) {"." #name, tyn_##name##_read_file},
    TYN_VOLUME_FORMATS(ROW)
#undef ROW
};
enum { NUM_FORMATS = sizeof formats / sizeof formats[0] };

// Which of them a file has; NUM_FORMATS: none.
static size_t format_of(const char *path)
{
    const char *dot = strrchr(path, '.');
    size_t f = dot ? 0 : NUM_FORMATS;
    while (f < NUM_FORMATS && strcasecmp(dot, formats[f].extension) != 0) {
        f++;
    }
    return f;
}

bool tyn_is_volume(const char *path)
{
    return path && format_of(path) < NUM_FORMATS;
}

tyn_result tyn_grid_read(tyn_grid_job *job, const char *path)
{
    const size_t f = format_of(path);
    if (f < NUM_FORMATS) {
        return formats[f].read(job, path);
    }
    const char *dot = strrchr(path, '.');
    if (dot && strcasecmp(dot, ".raw") == 0) {
        return TYN_FAULT(job->log, TYN_ERR_PARAMS,
                         "%s: a .raw file does not say its size: give \"size\" and \"type\" in a "
                         "glTF scene",
                         path);
    }
    return TYN_FAULT(job->log, TYN_ERR_PARAMS,
                     "%s: unknown kind of volume: must be one of .raw" TYN_VOLUME_ENDINGS, path);
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

tyn_result tyn_volume_list(const char *path, tyn_volume_grid **grids, uint32_t *count,
                           const tyn_log *log)
{
    if (!TYN_GIVEN(log, path, grids, count)) {
        return TYN_ERR_PARAMS;
    }
    tyn_grid_job job = {.use = TYN_GRID_LIST, .log = log};
    const tyn_result r = tyn_grid_read(&job, path);
    *grids = job.list;
    *count = job.num_list;
    return r;
}
