// beam.c -- lays out the grids of the suns and sweeps them in one dispatch.
#include "beam.h"
#include "passes/beam_tables.h"
#include "shaders/common/counters.h"
#include <math.h>
#include <string.h>

// Texels of `column` at most: 162 x 162 x 161 per sun, 17 MB. With coefficients a node has 48 bytes
// instead of 4, so that grids are kept to 96 cells: 46 MB per sun.
enum { MAX_CELLS = 160, MAX_COEFFICIENT_CELLS = 96, MAX_SAMPLES = 1024 };

// Where nothing bounds a ray (periodic axes, light within a face) its length counts as this many
// times the box.
static const double unbounded = 1e6;

static const tyn_param params_table[] = {
    {"cells", TYN_PARAM_INT, offsetof(tyn_beam_params, cells), 112, 1, MAX_CELLS, "cells",
     "most cells of a sun's grid along an axis (96 where coefficients are textures); a cell is one "
     "voxel along the light and half of one across at least",
     NULL},
};

// ---- layout ---------------------------------------------------------------------------------------

// The axis of the box that slices lie across: the one most along the light, if possible not periodic.
static uint32_t slice_axis(const struct medium_block *m, const double d[3])
{
    uint32_t best = 0;
    double best_score = -1;
    for (uint32_t i = 0; i < 3; i++) {
        double score = fabs(d[i]) > 1e-6 ? fabs(d[i]) + (m->repeat[i] ? 0 : 2) : 0;
        if (score > best_score) {
            best = i;
            best_score = score;
        }
    }
    return best;
}

static bool is_homogeneous(const struct medium_block *m)
{
    return m->size[0] == 1 && m->size[1] == 1 && m->size[2] == 1;
}

// Distance between columns over `range` metres across the light: as the finest voxel, or half of it
// where columns do not run through voxel centres, if `limit` cells are enough for that.
static double lateral_step(const struct medium_block *m, uint32_t lateral, uint32_t axis,
                           double range, bool oblique, uint32_t limit)
{
    double finest = fmin(m->voxel[lateral], m->voxel[axis]) * (oblique ? 0.5 : 1);
    return is_homogeneous(m) ? range : fmax(finest, range / limit);
}

static uint32_t lateral_cells(double range, double step)
{
    return (uint32_t)fmax(ceil(range / step - 1e-3), 1);
}

// One slice a voxel; more where a periodic box lets the light run so flat that it crosses many voxels
// from slice to slice.
static uint32_t num_slices(const struct medium_block *m, const double d[3], uint32_t axis,
                           uint32_t limit)
{
    double slices = m->size[axis];
    for (uint32_t i = 0; i < 3; i++) {
        if (m->repeat[i] && !is_homogeneous(m)) {
            slices = fmax(slices, ceil(fabs(d[i] / d[axis]) * m->extent[axis] / m->voxel[i]));
        }
    }
    return slices < limit ? (uint32_t)slices : limit;
}

// One sun, except for what depends on the whole texture. `alloc` = nodes along u, v and slices that its
// part of the texture needs whatever the direction.
static void plan_sun(struct beam_block *b, const struct medium_block *m,
                     const struct light_block *light, uint32_t limit, uint32_t alloc[3],
                     double map[3][4])
{
    const float *dir = light->direction;
    double norm = sqrt((double)dir[0] * dir[0] + (double)dir[1] * dir[1] + (double)dir[2] * dir[2]);
    double d[3], longest = fmax(m->extent[0], fmax(m->extent[1], m->extent[2]));
    for (int i = 0; i < 3; i++) {
        d[i] = dir[i] / norm;
    }
    uint32_t w = slice_axis(m, d), lateral[2] = {(w + 1) % 3, (w + 2) % 3};
    uint32_t slices = num_slices(m, d, w, limit);
    double first = d[w] < 0 ? m->extent[w] : 0, sign = d[w] < 0 ? -1 : 1;
    double origin[3] = {0}, step[3][3] = {{0}};
    origin[w] = first;
    memset(map, 0, sizeof(double[3][4]));

    for (int k = 0; k < 2; k++) {
        uint32_t a = lateral[k];
        double shear = d[a] / d[w], slide = d[a] / fabs(d[w]) * m->extent[w];
        double from = m->repeat[a] ? 0 : fmin(0, -slide);
        double range = m->extent[a] + (m->repeat[a] ? 0 : fabs(slide));
        bool oblique = fabs(slide) > 0.5 * m->voxel[a];
        double h = lateral_step(m, a, w, range, oblique, limit);
        uint32_t cells = lateral_cells(range, h);
        h = m->repeat[a] ? range / cells : h;
        // Where the light is along an axis and the grid as fine as the medium, columns go through voxel
        // centres: the column density is bilinear between those.
        origin[a] = from - 0.5 * h;
        step[k][a] = h;
        map[k][a] = 1 / h;
        map[k][w] = -shear / h;
        map[k][3] = (shear * first - from) / h + 0.5;
        b->nodes[k] = cells + 2;
        b->period[k] = m->repeat[a] ? (float)cells : 0;
        b->period_first[k] = 0.5f;
        range = m->extent[a] + (m->repeat[a] ? 0 : (double)m->extent[w]);
        alloc[k] = lateral_cells(range, lateral_step(m, a, w, range, true, limit)) + 2;
    }
    b->depth_row[w] = (float)(1 / d[w]);
    b->depth_row[3] = (float)(-first / d[w]);
    b->even = is_homogeneous(m) || m->repeat[w];
    map[2][w] = sign * slices / m->extent[w];
    map[2][3] = d[w] < 0 ? slices : 0;
    b->nodes[2] = alloc[2] = slices + 1;
    b->axis = w;

    double voxels = 0; // that a ray crosses from slice to slice, squared
    for (int i = 0; i < 3; i++) {
        step[2][i] = d[i] / fabs(d[w]) * m->extent[w] / slices;
        voxels += step[2][i] / m->voxel[i] * step[2][i] / m->voxel[i];
        bool bounds = !m->repeat[i] && fabs(d[i]) > 1e-6;
        b->clip_scale[i] = bounds ? (float)(1 / d[i]) : 0;
        b->clip_offset[i] = (float)(!bounds    ? unbounded * longest
                                    : d[i] > 0 ? 0
                                               : m->extent[i] / -d[i]);
        b->origin[i] = (float)origin[i];
        b->step_u[i] = (float)step[0][i];
        b->step_v[i] = (float)step[1][i];
        b->step_w[i] = (float)step[2][i];
        b->direction[i] = (float)d[i];
    }
    // One per voxel: midpoints sum the voxels' values, which along an axis is exact but for the ends.
    b->samples = (uint32_t)fmin(fmax(round(sqrt(voxels)), 1), MAX_SAMPLES);
}

void tyn_beam_plan(tyn_beam_params *params, const struct medium_block *medium,
                   const struct light_block *lights, uint32_t num_suns)
{
    int32_t most = medium->mode != TYN_MEDIUM_DENSITY ? MAX_COEFFICIENT_CELLS : MAX_CELLS;
    int32_t cells = params->cells < 1 ? 1 : params->cells > most ? most : params->cells;
    double maps[TYN_BEAM_MAX_SUNS][3][4];
    params->mode = medium->mode;
    params->num_suns = num_suns < TYN_BEAM_MAX_SUNS ? num_suns : TYN_BEAM_MAX_SUNS;
    memset(params->extent, 0, sizeof(params->extent));
    memset(params->beams, 0, sizeof(params->beams));
    for (uint32_t n = 0; n < params->num_suns; n++) {
        struct beam_block *b = &params->beams[n];
        uint32_t alloc[3];
        plan_sun(b, medium, &lights[n], (uint32_t)cells, alloc, maps[n]);
        b->light = n;
        b->first_slice = params->extent[2];
        for (int k = 0; k < 2; k++) {
            params->extent[k] = alloc[k] > params->extent[k] ? alloc[k] : params->extent[k];
        }
        params->extent[2] += alloc[2];
    }
    for (uint32_t n = 0; n < params->num_suns; n++) { // nodes -> texture coordinates
        struct beam_block *b = &params->beams[n];
        for (int k = 0; k < 3; k++) {
            double texels = params->extent[k], shift = 0.5 + (k == 2 ? b->first_slice : 0);
            for (int i = 0; i < 4; i++) {
                b->rows[k][i] = (float)((maps[n][k][i] + (i == 3 ? shift : 0)) / texels);
            }
            if (k == 2) {
                b->z_rate = (float)(maps[n][2][b->axis] * b->direction[b->axis] / texels);
            } else {
                b->period[k] = (float)(b->period[k] / texels);
                b->period_first[k] = (float)((b->period_first[k] + 0.5) / texels);
            }
        }
    }
}

// ---- the pass -------------------------------------------------------------------------------------

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_beam_params *p = params;
    if (p->num_suns < 1 || p->num_suns > TYN_BEAM_MAX_SUNS || p->extent[0] == 0) {
        return TYN_FAULT(tyn_build_log(b), TYN_ERR_PARAMS, "beam: %u suns planned, must be 1 to %d",
                         p->num_suns, TYN_BEAM_MAX_SUNS);
    }
    tyn_extent extent = {p->extent[0], p->extent[1], p->extent[2]};
    tyn_build_buffer(b, BEAM_PORT_BEAMS, sizeof(p->beams));
    if (p->mode == TYN_MEDIUM_DENSITY) {
        tyn_build_image(b, BEAM_PORT_COLUMN, extent, 1);
    } else {
        tyn_build_format(b, BEAM_PORT_COLUMN, VK_FORMAT_R32G32B32A32_SFLOAT);
        tyn_build_image(b, BEAM_PORT_COLUMN, extent, 1);
        tyn_build_image(b, BEAM_PORT_TAU_A, extent, 1);
        tyn_build_image(b, BEAM_PORT_TAU_P, extent, 1);
    }
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_beam_params *p = params;
    bool density = p->mode == TYN_MEDIUM_DENSITY;
    tyn_rec_update(r, BEAM_PORT_BEAMS, 0, p->beams, sizeof(p->beams));
    // Slices and columns that no point reads are not computed, but rounding lets a fetch beside them give
    // them a weight of 1e-7: they must be finite.
    static const uint8_t textures[] = {BEAM_PORT_COLUMN, BEAM_PORT_TAU_A, BEAM_PORT_TAU_P};
    for (size_t i = 0; i < sizeof(textures); i++) {
        if (tyn_rec_has(r, textures[i])) {
            tyn_rec_clear(r, textures[i]);
        }
    }
    TYN_DISPATCH(r, .kernel = density ? KERNEL_DENSITY : KERNEL_COEFFICIENTS,
                 .cells = {p->extent[0], p->extent[1], p->num_suns}, .spec = &p->mode);
    double nodes = 0, fetches = 0;
    for (uint32_t n = 0; n < p->num_suns; n++) {
        double columns = (double)p->beams[n].nodes[0] * p->beams[n].nodes[1];
        nodes += columns * p->beams[n].nodes[2];
        fetches += columns * (p->beams[n].nodes[2] - 1) * p->beams[n].samples;
    }
    // A sample: position 9, wrap and coordinate 12, sum 1; with coefficients delta scaling and sums.
    tyn_rec_work(r, "cells", nodes);
    tyn_rec_work(r, "flops", fetches * (density ? 22 : 70) + nodes * (density ? 8 : 40));
    tyn_rec_work(r, "bytes", fetches * (density ? 4 : 48) + nodes * (density ? 4 : 48));
}

const tyn_pass_desc tyn_pass_beam = {
    .name = "beam",
    .summary = "optical depth along directional lights, in a grid aligned with each",
    .serves = "suns in media",
    TYN_PASS_TABLES(tyn_beam_params),
    TYN_SETTINGS(params_table),
    .debug_port = BEAM_PORT_COLUMN,
    .debug_meaning = "column density in the slices of the suns' grids",
    TYN_COUNTS(BEAM_PORT_COUNTERS, struct counters_block, TYN_COUNTER_NON_FINITE),
};
