// grid_list.c -- what is in a volume file.
#include "io/volume.h"
#include <math.h>
#include "base/given.h"

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
