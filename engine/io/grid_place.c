// grid_place.c -- several grids of one medium, each with its own transform, made to fill the same box.
#include "io/grid_place.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "scene/matrix.h"

// Where a grid lies in the voxels of the first: index there = scale * index + offset.
typedef struct place {
    double scale[3], offset[3];
} place;

static bool invert(double out[16], const double m[16])
{
    const double det = mat_det3(m);
    if (!(fabs(det) > 0) || !isfinite(det)) {
        return false;
    }
    double rows[3][3];
    mat_cofactors(rows, m, m + 4, m + 8);
    mat_identity(out);
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) {
            out[4 * c + r] = rows[r][c] / det;
        }
        out[12 + r] = -(out[r] * m[12] + out[4 + r] * m[13] + out[8 + r] * m[14]);
    }
    return true;
}

// False: its axes are not those of the first.
static bool find_place(place *p, const double first[16], const double own[16])
{
    double inverse[16], m[16];
    if (!invert(inverse, first)) {
        return false;
    }
    mat_mul(m, inverse, own);
    for (int a = 0; a < 3; a++) {
        p->scale[a] = m[5 * a];
        p->offset[a] = m[12 + a];
        for (int b = 0; b < 3; b++) {
            if (!isfinite(m[4 * a + b]) || (a != b && fabs(m[4 * a + b]) > 1e-4 * m[5 * a])) {
                return false;
            }
        }
        if (!(p->scale[a] > 0) || !isfinite(p->offset[a])) {
            return false;
        }
        // Rounding of files in single precision.
        const double whole = round(p->offset[a]);
        p->scale[a] = fabs(p->scale[a] - 1) < 1e-4 ? 1 : p->scale[a];
        p->offset[a] = fabs(p->offset[a] - whole) < 1e-2 ? whole : p->offset[a];
    }
    return true;
}

// The value at an index that need not be whole: trilinear, constant in the outer half voxel, beyond it 0 or `edge`.
static void look_up(const tyn_placed_grid *g, const double at[3], float *value)
{
    const uint32_t *n = g->size;
    size_t lo[3], hi[3];
    double t[3];
    memset(value, 0, g->channels * sizeof *value);
    for (int a = 0; a < 3; a++) {
        if (!g->edge && (at[a] < -0.5 - 1e-6 || at[a] > n[a] - 0.5 + 1e-6)) {
            return;
        }
        const double x = fmin(fmax(at[a], 0), n[a] - 1.0);
        lo[a] = (size_t)x;
        hi[a] = lo[a] + 1 < n[a] ? lo[a] + 1 : lo[a];
        t[a] = x - (double)lo[a];
    }
    for (int k = 0; k < 8; k++) {
        const size_t x = k & 1 ? hi[0] : lo[0], y = k & 2 ? hi[1] : lo[1],
                     z = k & 4 ? hi[2] : lo[2];
        const double weight =
            (k & 1 ? t[0] : 1 - t[0]) * (k & 2 ? t[1] : 1 - t[1]) * (k & 4 ? t[2] : 1 - t[2]);
        const float *from = g->data + ((z * n[1] + y) * n[0] + x) * g->channels;
        for (uint32_t c = 0; c < g->channels && weight > 0; c++) {
            value[c] += (float)(weight * (double)from[c]);
        }
    }
}

static bool fill_box(tyn_placed_grid *g, const place *p, const int64_t lo[3],
                     const uint32_t size[3])
{
    const size_t count = (size_t)size[0] * size[1] * size[2];
    float *data = malloc(count * g->channels * sizeof *data), *value = data;
    for (size_t i = 0; data && i < count; i++, value += g->channels) {
        const int64_t voxel[3] = {(int64_t)(i % size[0]), (int64_t)(i / size[0] % size[1]),
                                  (int64_t)(i / size[0] / size[1])};
        double at[3];
        for (int a = 0; a < 3; a++) {
            at[a] = ((double)(voxel[a] + lo[a]) - p->offset[a]) / p->scale[a];
        }
        look_up(g, at, value);
    }
    if (data) {
        free(g->data);
        g->data = data;
        memcpy(g->size, size, sizeof g->size);
    }
    return data != NULL;
}

tyn_result tyn_grids_align(tyn_placed_grid *grids, uint32_t count, uint64_t most, const char **why)
{
    place places[TYN_PLACED_MAX];
    double lo[3] = {0}, hi[3] = {0};
    for (uint32_t i = 0; i < count; i++) {
        place *p = &places[i];
        if (!find_place(p, grids[0].index_to_world, grids[i].index_to_world)) {
            *why = "its axes are not along those of the medium's first grid: resample it";
            return TYN_ERR_PARAMS;
        }
        for (int a = 0; a < 3; a++) { // in corners of voxels of the first
            const double from = p->offset[a] - 0.5 * p->scale[a] + 0.5;
            const double to = from + p->scale[a] * grids[i].size[a];
            lo[a] = i ? fmin(lo[a], from) : from;
            hi[a] = i ? fmax(hi[a], to) : to;
        }
    }
    int64_t first[3];
    uint32_t size[3];
    double voxels = 1;
    for (int a = 0; a < 3; a++) {
        const double begin = floor(lo[a] + 1e-3), length = ceil(hi[a] - 1e-3) - begin;
        voxels *= length;
        if (!(fabs(begin) < 1e9) || !(length <= 65536) || !(voxels <= (double)most)) {
            *why = "the box around all grids of the medium has too many voxels";
            return TYN_ERR_PARAMS;
        }
        first[a] = (int64_t)begin;
        size[a] = (uint32_t)length;
    }
    const double *m = grids[0].index_to_world;
    double all[16];
    memcpy(all, m, sizeof all);
    for (int row = 0; row < 3; row++) {
        all[12 + row] += m[row] * (double)first[0] + m[4 + row] * (double)first[1] +
                         m[8 + row] * (double)first[2];
    }
    for (uint32_t i = 0; i < count; i++) {
        tyn_placed_grid *g = &grids[i];
        const place *p = &places[i];
        bool there = true;
        for (int a = 0; a < 3; a++) {
            there &= p->scale[a] == 1 && p->offset[a] == (double)first[a] && g->size[a] == size[a];
        }
        if (!there && !fill_box(g, p, first, size)) {
            *why = "no memory for the box around all grids of the medium";
            return TYN_ERR_MEMORY;
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        memcpy(grids[i].index_to_world, all, sizeof all);
    }
    return TYN_OK;
}
