// medium_grid.c -- see medium_grid.h.
#include "medium_grid.h"
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

medium_grid medium_grid_make(const float extent[3], const uint32_t size[3], uint32_t mode)
{
    medium_grid m = {{.mode = mode, .sigma_t_max = 1, .max_density = 1}};
    for (int i = 0; i < 3; i++) {
        m.block.extent[i] = extent[i];
        m.block.size[i] = size[i];
        m.block.voxel[i] = extent[i] / (float)size[i];
        m.block.bricks[i] = (size[i] + TYN_BRICK - 1) / TYN_BRICK;
        m.block.brick_size[i] = m.block.voxel[i] * TYN_BRICK;
    }
    size_t count = (size_t)size[0] * size[1] * size[2];
    for (int k = 0; k < (mode == TYN_MEDIUM_DENSITY ? 1 : 3); k++) {
        m.texels[k] = calloc(count * (mode == TYN_MEDIUM_DENSITY ? 1 : 4), sizeof(float));
    }
    return m;
}

void medium_grid_free(medium_grid *m)
{
    for (int k = 0; k < 3; k++) {
        free(m->texels[k]);
    }
}

double medium_grid_value(const medium_grid *m, int texture, int channel, const double p[3])
{
    int channels = m->block.mode == TYN_MEDIUM_DENSITY ? 1 : 4, i0[3], i1[3];
    double w[3];
    for (int i = 0; i < 3; i++) {
        double q = p[i] / (double)m->block.extent[i];
        q = m->block.repeat[i] ? q - floor(q) : q;
        double x = fmin(fmax(q * m->block.size[i] - 0.5, 0), m->block.size[i] - 1.0);
        i0[i] = (int)x;
        i1[i] = i0[i] + 1 < (int)m->block.size[i] ? i0[i] + 1 : i0[i];
        w[i] = x - i0[i];
    }
    double sum = 0;
    for (int c = 0; c < 8; c++) {
        int x = c & 1 ? i1[0] : i0[0], y = c & 2 ? i1[1] : i0[1], z = c & 4 ? i1[2] : i0[2];
        double weight =
            (c & 1 ? w[0] : 1 - w[0]) * (c & 2 ? w[1] : 1 - w[1]) * (c & 4 ? w[2] : 1 - w[2]);
        size_t texel = ((size_t)z * m->block.size[1] + (size_t)y) * m->block.size[0] + (size_t)x;
        sum += weight * (double)m->texels[texture][texel * (size_t)channels + (size_t)channel];
    }
    return sum;
}

double medium_grid_entry(const medium_grid *m, const double p[3], const double d[3])
{
    double length = 1e30;
    for (int i = 0; i < 3; i++) {
        if (!m->block.repeat[i] && fabs(d[i]) > 1e-9) {
            length = fmin(length, (d[i] > 0 ? p[i] : p[i] - (double)m->block.extent[i]) / d[i]);
        }
    }
    return fmax(length, 0);
}

double medium_grid_column(const medium_grid *m, int texture, int channel, const double p[3], const double d[3], int steps)
{
    double length = medium_grid_entry(m, p, d), sum = 0, finest = 1e30;
    for (int i = 0; i < 3; i++) {
        finest = fmin(finest, (double)m->block.voxel[i]);
    }
    int n = (int)(length / finest * steps) + steps;
    for (int i = 0; i < n; i++) {
        double s = length * (i + 0.5) / n,
               q[3] = {p[0] - s * d[0], p[1] - s * d[1], p[2] - s * d[2]};
        sum += medium_grid_value(m, texture, channel, q) * length / n;
    }
    return sum;
}
