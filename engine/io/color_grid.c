// color_grid.c -- grids of colours: what emits, black bodies, albedo.
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/given.h"
#include "io/volume.h"

void tyn_color_grid_finish(tyn_color_grid *colors)
{
    if (colors) {
        free(colors->name);
        free(colors->data);
        memset(colors, 0, sizeof *colors);
    }
}

tyn_color_grid tyn_grid_take_colors(tyn_grid_job *job)
{
    const tyn_volume *v = &job->volume;
    const tyn_color_grid colors = {.name = v->name,
                                   .size = {v->size[0], v->size[1], v->size[2]},
                                   .channels = job->channels,
                                   .data = v->data,
                                   .max = v->max_density,
                                   .hash = v->hash};
    memset(&job->volume, 0, sizeof job->volume);
    return colors;
}

tyn_result tyn_color_grid_load(tyn_color_grid *colors, const char *path, const char *grid,
                               double index_to_world[16], uint64_t *clamped_negative,
                               const tyn_log *log)
{
    if (!TYN_GIVEN(log, colors, path, grid)) {
        return TYN_ERR_PARAMS;
    }
    memset(colors, 0, sizeof *colors);
    tyn_grid_job job = {.grid = grid, .use = TYN_GRID_COLOR, .log = log};
    const tyn_result r = tyn_grid_read(&job, path);
    if (!r && index_to_world) {
        memcpy(index_to_world, job.volume.index_to_world, sizeof job.volume.index_to_world);
    }
    *colors = tyn_grid_take_colors(&job);
    if (clamped_negative) {
        *clamped_negative += job.clamped;
    }
    return r;
}

// ---- temperatures -----------------------------------------------------------------------------

// A table over the temperatures of a grid, even in their logarithms. What is colder is dark.
enum { MOST_STEPS = 65536, COLDEST = 300 };
static const double fine_step = 3e-4; // octaves; at 600 K straight lines are then 1e-5 off

static void radiance_of(double kelvins, const tyn_temperature *how, float rgb[3])
{
    const double strength = how->strength == 0 ? 1 : how->strength;
    tyn_blackbody(kelvins, rgb);
    double factor = strength;
    if (how->luminance > 0) {
        const double y = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
        factor = kelvins >= 500 && y > 0 ? strength * how->luminance / y : 0;
    }
    for (int c = 0; c < 3; c++) {
        rgb[c] = (float)fmin(rgb[c] * factor, FLT_MAX);
    }
}

static bool is_fit(const tyn_temperature *t, const tyn_log *log)
{
    const struct {
        const char *name;
        double value, least;
    } numbers[] = {{"scale", t->scale, -DBL_MAX},
                   {"offset", t->offset, -DBL_MAX},
                   {"strength", t->strength, 0},
                   {"luminance", t->luminance, 0}};
    for (int i = 0; i < 4; i++) {
        if (!isfinite(numbers[i].value) || numbers[i].value < numbers[i].least) {
            return TYN_FAULT(log, false, "temperature: %s = %g: must be finite%s", numbers[i].name,
                             numbers[i].value, numbers[i].least == 0 ? " and >= 0" : "");
        }
    }
    return true;
}

tyn_result tyn_color_grid_of_temperatures(tyn_color_grid *colors, const uint32_t size[3],
                                          const float *values, const tyn_temperature *how,
                                          const tyn_log *log)
{
    if (!TYN_GIVEN(log, colors, size, values, how) || !is_fit(how, log)) {
        return TYN_ERR_PARAMS;
    }
    const size_t count = (size_t)size[0] * size[1] * size[2];
    const double scale = how->scale == 0 ? 1 : how->scale;
    double least = INFINITY, most = COLDEST;
    for (size_t i = 0; i < count; i++) {
        const double given = values[i] * scale + how->offset, kelvins = fmax(given, COLDEST);
        if (!isfinite(given)) {
            return TYN_FAULT(log, TYN_ERR_PARAMS, "temperature %g of value %zu: must be finite",
                             (double)values[i], i);
        }
        least = fmin(least, kelvins);
        most = fmax(most, kelvins);
    }
    *colors = (tyn_color_grid){.size = {size[0], size[1], size[2]}, .channels = 3};
    colors->data = malloc(count * 3 * sizeof *colors->data);
    const double octaves = log2(most / least);
    const int steps = (int)fmin(ceil(octaves / fine_step) + 1, MOST_STEPS);
    const double step = fmax(octaves / steps, 1e-12);
    float(*table)[3] = malloc(((size_t)steps + 1) * sizeof *table);
    if (!colors->data || !table) {
        free(table);
        tyn_color_grid_finish(colors);
        return TYN_FAULT(log, TYN_ERR_MEMORY, "no memory for the radiance of %zu voxels", count);
    }
    for (int i = 0; i <= steps; i++) {
        radiance_of(least * exp2(i * step), how, table[i]);
    }
    for (size_t i = 0; i < count; i++) {
        const double kelvins = values[i] * scale + how->offset;
        const double at = kelvins > COLDEST ? fmax(log2(kelvins / least) / step, 0) : 0;
        const int below = at < steps ? (int)at : steps - 1;
        const float t = (float)fmin(at - below, 1);
        for (int c = 0; c < 3; c++) {
            float v = table[below][c] + t * (table[below + 1][c] - table[below][c]);
            v = kelvins > COLDEST ? v : 0;
            colors->data[3 * i + (size_t)c] = v;
            colors->max = v > colors->max ? v : colors->max;
        }
    }
    free(table);
    colors->hash = tyn_grid_hash(size, 3, colors->data);
    return TYN_OK;
}
