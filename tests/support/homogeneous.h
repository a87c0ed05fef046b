// homogeneous.h -- a medium that is the same everywhere in its box [0, extent]: beams and radials for it, without the
// passes that make them. Textures of one texel hold its mean, and depths are that times lengths in the box.
#pragma once
#include "shaders/beams/beam_args.h"
#include "shaders/beams/radial_args.h"
#include "vector.h"
#include <string.h>

// Length within the box of the way from a to b.
static inline double homogeneous_length(const float extent[3], const double a[3], const double b[3])
{
    double from = 0, to = 1, d[3];
    for (int i = 0; i < 3; i++) {
        d[i] = b[i] - a[i];
        const double x = -a[i] / d[i], y = ((double)extent[i] - a[i]) / d[i];
        if (fabs(d[i]) > 1e-12) {
            from = fmax(from, fmin(x, y));
            to = fmin(to, fmax(x, y));
        } else if (a[i] < 0 || a[i] > (double)extent[i]) {
            return 0;
        }
    }
    return fmax(to - from, 0) * vector_length(d);
}

// Of a sun that shines along `direction`; `light`: its number.
static inline void homogeneous_beam(struct beam_block *beam, const float extent[3],
                                    const float direction[3], uint32_t light)
{
    *beam = (struct beam_block){.light = light, .even = 1};
    memcpy(beam->direction, direction, sizeof beam->direction);
    for (int i = 0; i < 3; i++) {
        const float d = direction[i];
        beam->clip_scale[i] = fabsf(d) > 1e-6f ? 1 / d : 0;
        beam->clip_offset[i] = fabsf(d) <= 1e-6f ? 1e9f : d > 0 ? 0 : -extent[i] / d;
    }
}

static inline void homogeneous_radial(struct radial_grid *grid, const float extent[3],
                                      const struct light_block *light)
{
    *grid = (struct radial_grid){.light = *light, .inside = 1, .inverse_near = 1};
    for (int i = 0; i < 3; i++) {
        const float x = light->position[i];
        grid->to_map[i][i] = 1;
        grid->inside = grid->inside && x >= 0 && x <= extent[i];
    }
}
