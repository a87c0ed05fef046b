// refine.glsl -- where planes and levels lie in the images of the pass refine.
#ifndef TYN_REFINE_GLSL
#define TYN_REFINE_GLSL
#include "refine_args.h"
TYN_ARGS(refine_args args);

// Texels of a level.
uvec2 refine_size(uint level)
{
    return (args.cells + (1u << level) - 1u) >> level;
}

// First texel of a level: level 0, to the right of it the others, below each other.
uvec2 refine_corner(uint level)
{
    if (level == 0u) {
        return uvec2(0u);
    }
    uint y = 0u;
    for (uint l = 1u; l < level; l++) {
        y += refine_size(l).y;
    }
    return uvec2(args.cells.x, y);
}

// Texels of all levels.
uvec2 refine_pyramid()
{
    uint y = 0u;
    for (uint l = 1u; l < uint(REFINE_LEVELS); l++) {
        y += refine_size(l).y;
    }
    return uvec2(args.cells.x + refine_size(1u).x, max(args.cells.y, y));
}

// First texel of a plane of moments.
uvec2 refine_moment(uint plane)
{
    return uvec2(plane % uint(REFINE_MOMENTS_ROW), plane / uint(REFINE_MOMENTS_ROW)) * refine_pyramid();
}

// First texel of a window in a plane of coefficients: those of the smallest window, to the right the pyramid.
uvec2 refine_window(uint window)
{
    return window == 0u ? uvec2(0u) : uvec2(args.cells.x, 0u) + refine_corner(window - 1u);
}

uint refine_level_of(uint window)
{
    return window == 0u ? 0u : window - 1u;
}

uvec2 refine_coefficient(uint plane)
{
    return uvec2(plane % uint(REFINE_COEFFICIENTS_ROW), plane / uint(REFINE_COEFFICIENTS_ROW)) *
           (refine_pyramid() + uvec2(args.cells.x, 0u));
}

// Of a plane of cells.
uvec2 refine_cell(uint plane)
{
    return uvec2(plane % uint(REFINE_CELLS_ROW), plane / uint(REFINE_CELLS_ROW)) * args.cells;
}

// Of a plane of what is kept from frame to frame.
uvec2 refine_kept(uint part)
{
    return uvec2(part % uint(REFINE_CELLS_ROW), part / uint(REFINE_CELLS_ROW)) * args.cells;
}

bool refine_finite(vec3 v)
{
    return !any(isnan(v)) && !any(isinf(v));
}

// Light that residuals are kept in units of, as it may change from picture to picture.
vec3 refine_unit(vec3 pop, vec3 mean)
{
    return max(pop, 0.0) + 0.05 * mean + 1e-20;
}

// 1 / radiance: squares with this weight are a share of the light, and not of each pixel's. None in a channel that is black
// throughout, in which there is nothing to compare.
vec3 refine_weight(vec3 pop, vec3 mean)
{
    return mix(vec3(0.0), 1.0 / refine_unit(pop, mean), greaterThan(mean, vec3(1e-18)));
}

refine_changes refine_add_changes(const refine_changes a, const refine_changes b, float w)
{
    return refine_changes(a.difference + w * b.difference, a.now + w * b.now, a.before + w * b.before);
}

refine_sums refine_add(const refine_sums a, const refine_sums b, float w)
{
    return refine_sums(a.cells + w * b.cells, a.light + w * b.light, a.confirmed + w * b.confirmed, a.doubt + w * b.doubt,
                       a.change + w * b.change, a.residual + w * b.residual, a.noise + w * b.noise,
                       a.spread + w * b.spread, a.excess + w * b.excess);
}

const refine_sums REFINE_NO_SUMS = refine_sums(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, vec2(0.0));

// Variances of both of refine_squares, where the change counts by its share.
vec2 refine_doubt(vec2 excess, float share)
{
    const float root = mix(sqrt(excess.x), sqrt(excess.y), share);
    return vec2(excess.x, root * root);
}

// Estimated square errors of pop, and of pop with that share of the change; below 0 by noise. For a fit that is given they are
// unbiased.
vec2 refine_squares(const refine_sums s, float share)
{
    const float pop = s.residual - s.noise;
    return vec2(pop, share * share * s.change - 2.0 * share * s.confirmed + pop);
}

refine_residuals refine_add(const refine_residuals a, const refine_residuals b, float w)
{
    return refine_residuals(a.difference + w * b.difference, a.noise + w * b.noise, a.fit + w * b.fit, a.less + w * b.less,
                            a.variance + w * w * b.variance);
}

const refine_residuals REFINE_NO_RESIDUALS = refine_residuals(0.0, 0.0, vec3(0.0), vec3(0.0), vec3(0.0));

// By what the fit is to be multiplied, so that its sum over a window is the samples', as far as these differ by more than their noise
// (James and Stein). `level`: by what it is multiplied already.
vec3 refine_level(const refine_residuals sum, vec3 level, float doubt)
{
    const vec3 fit = level * sum.fit, less = sum.less + sum.fit - fit;
    const vec3 share = clamp(1.0 - doubt * sum.variance / max(less * less, 1e-30), 0.0, 1.0);
    const vec3 next = level * clamp(1.0 + share * less / max(fit, 1e-20), 0.0, 2.0);
    return any(isnan(next)) ? level : next;
}
#endif
