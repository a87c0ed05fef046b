// env_cdf.c -- builds the alias table of an environment map.
#include "frame/env_cdf.h"
#include "shaders/light/env_args.h"
#include "frame/alias_table.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

// Finer maps are averaged down: a cell of 0.18 degrees holds the sun, and the table stays under 24 MiB.
enum { TABLE_WIDTH_MAX = 2048, TABLE_HEIGHT_MAX = 1024 };

static void table_size(const tyn_environment *e, uint32_t *width, uint32_t *height)
{
    bool mapped = e->present && e->data && e->size[0] > 0 && e->size[1] > 0;
    *width = mapped ? (e->size[0] < TABLE_WIDTH_MAX ? e->size[0] : TABLE_WIDTH_MAX) : 0;
    *height = mapped ? (e->size[1] < TABLE_HEIGHT_MAX ? e->size[1] : TABLE_HEIGHT_MAX) : 0;
}

size_t tyn_env_cdf_size(const tyn_environment *environment)
{
    uint32_t width, height;
    table_size(environment, &width, &height);
    size_t cells = (size_t)width * height;
    return cells ? sizeof(struct env_table_block) + cells * sizeof(struct env_cell) : 0;
}

static double brightness(const tyn_environment *e, uint32_t x, uint32_t y)
{
    const float *t = e->data + 3 * ((size_t)y * e->size[0] + x);
    double b = ((double)t[0] + t[1] + t[2]) / 3.0;
    return b > 0 && isfinite(b) ? b : 0;
}

// Power of each cell: mean brightness of the texels that bilinear lookups inside the cell can touch,
// times its solid angle. No direction that is bright has probability 0.
static double weigh(const tyn_environment *e, uint32_t width, uint32_t height, double *weights)
{
    double total = 0;
    for (uint32_t j = 0; j < height; j++) {
        int64_t y0 = (int64_t)j * e->size[1] / height - 1;
        int64_t y1 = ((int64_t)(j + 1) * e->size[1] + height - 1) / height;
        y0 = y0 < 0 ? 0 : y0;
        y1 = y1 >= e->size[1] ? e->size[1] - 1 : y1;
        double sin_theta = sin(M_PI * (j + 0.5) / height);
        for (uint32_t i = 0; i < width; i++) {
            int64_t x0 = (int64_t)i * e->size[0] / width - 1;
            int64_t x1 = ((int64_t)(i + 1) * e->size[0] + width - 1) / width;
            double sum = 0;
            for (int64_t y = y0; y <= y1; y++) {
                for (int64_t x = x0; x <= x1; x++) {
                    sum += brightness(e, (uint32_t)((x + e->size[0]) % e->size[0]), (uint32_t)y);
                }
            }
            double mean = sum / (double)((y1 - y0 + 1) * (x1 - x0 + 1));
            weights[(size_t)j * width + i] = mean * sin_theta;
            total += mean * sin_theta;
        }
    }
    return total;
}

bool tyn_env_cdf_build(const tyn_environment *environment, void *table)
{
    struct env_table_block head = {0};
    table_size(environment, &head.width, &head.height);
    size_t count = (size_t)head.width * head.height;
    if (count == 0) {
        return true;
    }
    struct env_cell *cells = (struct env_cell *)((char *)table + sizeof(head));
    double *weights = malloc(count * sizeof *weights);
    if (!weights) {
        return false;
    }
    memcpy(table, &head, sizeof(head));
    // A black map is drawn from uniformly over the square: any table is right.
    double total = weigh(environment, head.width, head.height, weights);
    for (size_t i = 0; i < count; i++) {
        cells[i].density = total > 0 ? (float)(weights[i] / total * (double)count) : 1.0f;
    }
    bool ok = tyn_alias_build(weights, count, &cells->keep, sizeof *cells);
    free(weights);
    return ok;
}
