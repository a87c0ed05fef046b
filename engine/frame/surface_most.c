// surface_most.c -- where most triangles are: quantiles of the middles of up to SAMPLES of them.
#include "frame/surface_most.h"
#include <math.h>
#include <stdlib.h>
#include "scene/surfaces.h"

enum { SAMPLES = 4096 };

static int by_value(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

// Box of a triangle.
static void box_of(const tyn_surfaces *s, uint32_t triangle, float lo[3], float hi[3])
{
    for (int a = 0; a < 3; a++) {
        lo[a] = INFINITY;
        hi[a] = -INFINITY;
        for (int k = 0; k < 3; k++) {
            const float x = s->vertices[s->triangles[triangle].vertices[k]].position[a];
            lo[a] = fminf(lo[a], x);
            hi[a] = fmaxf(hi[a], x);
        }
    }
}

static float middle(float lo, float hi)
{
    return lo + 0.5f * (hi - lo);
}

static float longest_side(const float lo[3], const float hi[3])
{
    return fmaxf(hi[0] - lo[0], fmaxf(hi[1] - lo[1], hi[2] - lo[2]));
}

bool tyn_surfaces_most(const tyn_surfaces *s, float lo[3], float hi[3])
{
    const uint32_t count = s->num_triangles < SAMPLES ? s->num_triangles : SAMPLES;
    float *middles = count ? malloc(count * sizeof *middles) : NULL;
    float inner_lo[3], inner_hi[3], l[3], h[3];
    tyn_surfaces_bounds(s, lo, hi);
    if (!middles) {
        return count == 0;
    }
    for (int a = 0; a < 3; a++) {
        for (uint32_t i = 0; i < count; i++) {
            box_of(s, (uint32_t)((uint64_t)i * s->num_triangles / count), l, h);
            middles[i] = middle(l[a], h[a]);
        }
        qsort(middles, count, sizeof *middles, by_value);
        inner_lo[a] = middles[(count - 1) / 10];
        inner_hi[a] = middles[count - 1 - (count - 1) / 10];
    }
    free(middles);
    const float size = longest_side(inner_lo, inner_hi);
    float around_lo[3] = {INFINITY, INFINITY, INFINITY};
    float around_hi[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t i = 0; i < count; i++) {
        box_of(s, (uint32_t)((uint64_t)i * s->num_triangles / count), l, h);
        bool inside = longest_side(l, h) <= 2 * size;
        for (int a = 0; a < 3; a++) {
            const float m = middle(l[a], h[a]);
            inside = inside && m >= inner_lo[a] && m <= inner_hi[a];
        }
        for (int a = 0; a < 3 && inside; a++) {
            around_lo[a] = fminf(around_lo[a], l[a]);
            around_hi[a] = fmaxf(around_hi[a], h[a]);
        }
    }
    if (longest_side(around_lo, around_hi) > 0) {
        for (int a = 0; a < 3; a++) {
            lo[a] = around_lo[a];
            hi[a] = around_hi[a];
        }
    }
    return true;
}
