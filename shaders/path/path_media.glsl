// path_media.glsl -- the media exactly as the scene says, for the path tracer: every shape's own grid,
// sums where shapes overlap.
//
// The includer declares `medium` (medium_block), `shapes[]` (shape_block), `atlas`, `colors` and `bricks`
// (sampler3D) and the constants of path_args.h.
#ifndef TYN_PATH_MEDIA_GLSL
#define TYN_PATH_MEDIA_GLSL
#include "shaders/medium/majorant.glsl"
#include "shaders/medium/shape_colors.glsl"
#include "shaders/phase/phase.glsl"

struct media_point {
    vec3 sigma_s, sigma_t, emission; // of all media together
    vec3 part_s; // of one medium, drawn in proportion to its scattering
    phase phase[3];
};

float max3(vec3 v)
{
    return max(v.x, max(v.y, v.z));
}

// Tells the compiler that channels are equal, so that it computes one.
vec3 grey(vec3 v)
{
    return GREY ? v.xxx : v;
}

phase[3] grey(phase p[3])
{
    if (GREY || (FLAGS & TYN_PATH_ONE_PHASE) != 0u) {
        p[1] = p[0];
        p[2] = p[0];
    }
    return p;
}

shape_block shape_get(uint i)
{
    if (SHAPES != 0u) {
        return path_shapes[i];
    }
    shape_block shape = shapes[i];
    return shape;
}

vec3 shape_turn(const shape_block shape, vec3 d)
{
    return vec3(dot(shape.rows[0].xyz, d), dot(shape.rows[1].xyz, d), dot(shape.rows[2].xyz, d));
}

vec3 shape_local(const shape_block shape, vec3 p)
{
    return shape_turn(shape, p) + vec3(shape.rows[0].w, shape.rows[1].w, shape.rows[2].w);
}

// Value of the shape's grid: trilinear, clamped to the grid's own texels, so that neighbours in the atlas
// never show.
float shape_density(const shape_block shape, vec3 local)
{
    vec3 size = vec3(shape.size);
    vec3 texel = clamp((local + 0.5) * size, vec3(0.5), size - 0.5) + vec3(shape.offset);
    return textureLod(atlas, texel * path_atlas_texel, 0.0).r;
}

// A grid of colours of the shape, likewise; TYN_COLORS_*.
vec3 shape_color(const shape_block shape, uint which, vec3 local)
{
    vec3 texel = shape_colors_texel(shape.colors[which], local);
    return shape.colors[which].scale * textureLod(colors, texel * path_colors_texel, 0.0).rgb;
}

bool shape_is_sphere(const shape_block shape)
{
    return SHAPES == 1u ? (FLAGS & TYN_PATH_SPHERE) != 0u : shape.kind == TYN_SHAPE_KIND_SPHERE;
}

bool shape_holds(const shape_block shape, vec3 local)
{
    if (shape_is_sphere(shape)) {
        return dot(local, local) <= 0.25;
    }
    return max3(abs(local)) <= 0.5;
}

vec3 wrap(vec3 p)
{
    if ((FLAGS & TYN_PATH_REPEAT) != 0u) {
        p -= floor(p / medium.extent) * medium.extent * vec3(medium.repeat);
    }
    return p;
}

// What a shape emits where its density is this and its absorption `a`.
vec3 glow_at(const shape_block shape, vec3 local, bool holds, float density, vec3 a)
{
    vec3 emission = density * shape.emission;
    if ((FLAGS & TYN_PATH_GLOW) != 0u && holds) {
        if (shape_has_color(shape, TYN_COLORS_EMISSION)) {
            emission = shape.emission * shape_color(shape, TYN_COLORS_EMISSION, local);
        }
        if (shape_has_color(shape, TYN_COLORS_RADIANCE)) {
            emission += a * shape_color(shape, TYN_COLORS_RADIANCE, local);
        }
    }
    return emission;
}

// `pick` in [0, 1) draws the part; `hero` weighs the channels when it does.
media_point media_at(vec3 p, float pick, vec3 hero)
{
    media_point m;
    if (HOMOGENEOUS) {
        m.sigma_s = grey(path_shapes[0].sigma_s);
        m.sigma_t = grey(path_shapes[0].sigma_s + path_shapes[0].sigma_a);
        m.emission = path_shapes[0].emission;
        m.part_s = m.sigma_s;
        m.phase = grey(path_shapes[0].phase);
        return m;
    }
    p = wrap(p);
    m.sigma_s = vec3(0.0);
    m.sigma_t = vec3(0.0);
    m.emission = vec3(0.0);
    m.part_s = vec3(0.0);
    m.phase = phase_of_mean_cosine(vec3(0.0));
    float total = 0.0;
    uint count = SHAPES != 0u ? SHAPES : medium.num_shapes;
    for (uint i = 0u; i < count; i++) {
        shape_block shape = shape_get(i);
        vec3 local = shape_local(shape, p);
        bool holds = shape_holds(shape, local);
        float density = holds ? shape_density(shape, local) : 0.0;
        vec3 s = density * grey(shape.sigma_s), a = density * grey(shape.sigma_a);
        m.sigma_t += s + a;
        if ((FLAGS & TYN_PATH_ALBEDO) != 0u && shape_has_color(shape, TYN_COLORS_ALBEDO)) {
            vec3 t = s + a;
            s = t * shape_color(shape, TYN_COLORS_ALBEDO, local);
            a = t - s;
        }
        m.sigma_s += s;
        m.emission += glow_at(shape, local, holds, density, a);
        if (SHAPES == 1u) {
            m.part_s = s;
            m.phase = grey(shape.phase);
            break;
        }
        // Weighted reservoir of one, with one random number that is stretched again after each use.
        float weight = dot(s, hero);
        total += weight;
        float share = total > 0.0 ? weight / total : 0.0;
        if (pick < share) {
            m.part_s = s;
            m.phase = grey(shape.phase);
            pick = pick / max(share, 1e-12);
        } else {
            pick = (pick - share) / max(1.0 - share, 1e-12);
        }
    }
    return m;
}

// Where a ray is in the domain of tracking: the shape itself if there is one homogeneous shape, else the
// box around all media. Empty if x >= y.
vec2 media_span(vec3 origin, vec3 direction)
{
    if (!HOMOGENEOUS) {
        return brick_span(medium, origin, direction);
    }
    vec3 o = shape_local(path_shapes[0], origin), d = shape_turn(path_shapes[0], direction);
    vec2 span;
    if (shape_is_sphere(path_shapes[0])) {
        span = ray_sphere(o, d, 0.5);
    } else {
        vec3 half_size = vec3(0.5);
        if ((FLAGS & TYN_PATH_REPEAT) != 0u) {
            half_size += 1e30 * vec3(medium.repeat);
        }
        span = ray_box(o, ray_inverse(d), -half_size, half_size);
    }
    return vec2(max(span.x, 0.0), span.y);
}

// Least and largest extinction of a brick, largest channel, 1/m.
vec2 media_bounds(ivec3 cell)
{
    vec2 range = texelFetch(bricks, cell, 0).xy * medium.sigma_t_max;
    // Only where coefficients are one constant times density is the least value known for each channel.
    return vec2(medium.mode == TYN_MEDIUM_DENSITY ? range.x : 0.0, range.y);
}

#endif
