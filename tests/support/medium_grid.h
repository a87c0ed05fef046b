// medium_grid.h -- a medium as voxels in a box, and line integrals of it in double precision.
#pragma once
#include "shaders/common/scene_args.h"

typedef struct medium_grid {
    struct medium_block block;
    float *texels[3]; // density; or sigma_s, sigma_a, g as RGBA
} medium_grid;

// All texels are 0, and so are coefficients.
medium_grid medium_grid_make(const float extent[3], const uint32_t size[3], uint32_t mode);
void medium_grid_free(medium_grid *m);

// Trilinear between voxel centres, constant in the outer half voxels; periodic axes wrap as a whole.
double medium_grid_value(const medium_grid *m, int texture, int channel, const double p[3]);

// Distance to p from where a ray along d enters the box, of whose sides periodic ones do not count.
double medium_grid_entry(const medium_grid *m, const double p[3], const double d[3]);

// Integral from there to p, in `steps` steps a voxel.
double medium_grid_column(const medium_grid *m, int texture, int channel, const double p[3],
                          const double d[3], int steps);
