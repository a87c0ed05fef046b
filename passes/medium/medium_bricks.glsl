// medium_bricks.glsl -- least and largest value over a brick, for the exact shapes. One thread does a
// brick: no texel is fetched by more than a few threads, and nothing needs to be joined.
// Include after medium_shapes.glsl.
#include "shaders/common/uniform_branch.glsl"

const vec2 BRICK_NOTHING = vec2(3.4e38, 0.0);

vec2 brick_add(vec2 range, float value)
{
    value = value >= 0.0 && !isinf(value) ? value : 0.0;
    return vec2(min(range.x, value), max(range.y, value));
}

// Atlas values that interpolation reads anywhere in the M box [lo, hi] of a shape: all texels that its
// image touches, and one more around. A value outside the shape counts as 0.
vec2 brick_of_shape(const shape_block s, vec3 lo, vec3 hi)
{
    vec3 centre = shape_local(s, 0.5 * (lo + hi));
    vec3 local_half = shape_local_half(s, 0.5 * (hi - lo));
    if (shape_misses(s, centre, local_half + 1e-6)) {
        return vec2(0.0);
    }
    ivec3 size = ivec3(s.size);
    // Rounding of the affine map is covered by a thousandth of a texel.
    ivec3 first = ivec3(floor((centre - local_half + 0.5) * vec3(size) - 0.501));
    ivec3 last = ivec3(floor((centre + local_half + 0.5) * vec3(size) - 0.499)) + 1;
    first = clamp(first, ivec3(0), size - 1);
    last = clamp(last, ivec3(0), size - 1);
    vec2 range = BRICK_NOTHING;
    for (int z = first.z; z <= last.z; z++) {
        for (int y = first.y; y <= last.y; y++) {
            for (int x = first.x; x <= last.x; x++) {
                range = brick_add(range, texelFetch(atlas_tex, ivec3(x, y, z) + ivec3(s.offset), 0).r);
            }
        }
    }
    return shape_contains(s, centre, local_half) ? range : vec2(0.0, range.y);
}

#ifdef TYN_COLORS
// Is the grid by which a shape emits above 0 anywhere in the M box? Likewise.
bool brick_glows(const shape_block s, vec3 lo, vec3 hi)
{
    vec3 centre = shape_local(s, 0.5 * (lo + hi));
    vec3 local_half = shape_local_half(s, 0.5 * (hi - lo));
    if (shape_misses(s, centre, local_half + 1e-6)) {
        return false;
    }
    shape_colors c = s.colors[TYN_COLORS_EMISSION];
    ivec3 size = ivec3(c.size);
    ivec3 first = clamp(ivec3(floor((centre - local_half + 0.5) * vec3(size) - 0.501)), ivec3(0), size - 1);
    ivec3 last = clamp(ivec3(floor((centre + local_half + 0.5) * vec3(size) - 0.499)) + 1, ivec3(0), size - 1);
    vec3 most = vec3(0.0);
    for (int z = first.z; z <= last.z; z++) {
        for (int y = first.y; y <= last.y; y++) {
            for (int x = first.x; x <= last.x; x++) {
                most = max(most, texelFetch(colors_tex, ivec3(x, y, z + int(c.layer)), 0).rgb);
            }
        }
    }
    return any(greaterThan(most, vec3(0.0)));
}
#endif

// All shapes together, in what a brick holds: texture values (DENSITY) or 1/m of the largest channel.
vec2 brick_of_shapes(vec3 lo, vec3 hi)
{
    vec3 least = vec3(0.0), largest = vec3(0.0);
    for (uint i = 0u; uniform_branch(i < medium.num_shapes); i++) {
        vec3 weight = uniform_branch(medium.mode == TYN_MEDIUM_DENSITY) ? vec3(shape_scale(shapes[i]))
                                                                        : shapes[i].sigma_s + shapes[i].sigma_a;
        vec2 range = brick_of_shape(shapes[i], lo, hi);
        least += range.x * weight;
        // A medium that only emits must not look empty; the majorant stays one.
        bool glows = max(max(shapes[i].emission.x, shapes[i].emission.y), shapes[i].emission.z) > 0.0;
        largest += range.y * max(weight, vec3(glows ? 1e-6 : 0.0));
#ifdef TYN_COLORS
        if (uniform_branch(shape_has_color(shapes[i], TYN_COLORS_EMISSION)) && brick_glows(shapes[i], lo, hi)) {
            largest = max(largest, vec3(1e-6));
        }
#endif
    }
    return vec2(max(max(least.x, least.y), least.z), max(max(largest.x, largest.y), largest.z));
}
