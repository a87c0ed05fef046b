// medium_shapes.glsl -- the exact media: shapes with grids in the atlas, averaged over a voxel or bounded
// over a box.
//
// Define MEDIUM_BLOCK (uniform buffer), SHAPES (storage buffer) and ATLAS (sampler3D) before including; in the builds
// with TYN_COLORS, for media with grids of colours, also COLORS (sampler3D).
#include "shaders/common/scene_args.h"

TYN_UNIFORM(MEDIUM_BLOCK, medium, medium_block medium);
TYN_READ(SHAPES, shapes, shape_block shapes[]);
layout(set = 0, binding = ATLAS) uniform sampler3D atlas_tex;

// M -> local unit box.
vec3 shape_local(const shape_block s, vec3 p)
{
    return vec3(dot(s.rows[0].xyz, p) + s.rows[0].w, dot(s.rows[1].xyz, p) + s.rows[1].w,
                dot(s.rows[2].xyz, p) + s.rows[2].w);
}

// Half edges of the local box around an M box of half edges `half_box`.
vec3 shape_local_half(const shape_block s, vec3 half_box)
{
    return vec3(dot(abs(s.rows[0].xyz), half_box), dot(abs(s.rows[1].xyz), half_box),
                dot(abs(s.rows[2].xyz), half_box));
}

// Texture value at a local position; outside the shape its edge value.
float shape_value(const shape_block s, vec3 local)
{
    vec3 size = vec3(s.size);
    vec3 texel = clamp((local + 0.5) * size, vec3(0.5), size - 0.5) + vec3(s.offset);
    float value = textureLod(atlas_tex, texel / vec3(textureSize(atlas_tex, 0)), 0.0).r;
    return value >= 0.0 && !isinf(value) ? value : 0.0;
}

// Part of a small M box (local centre and half edges given, M half edges `half_box`) that is in the
// shape: exact where the faces of both are parallel, for a sphere that of its tangent plane.
float shape_cover(const shape_block s, vec3 local, vec3 local_half, vec3 half_box)
{
    if (s.kind == TYN_SHAPE_KIND_BOX) {
        vec3 overlap = min(local + local_half, vec3(0.5)) - max(local - local_half, vec3(-0.5));
        vec3 part = clamp(overlap / (2.0 * local_half), vec3(0.0), vec3(1.0));
        return part.x * part.y * part.z;
    }
    float r = length(local);
    vec3 normal = local / max(r, 1e-20);
    float reach = dot(abs(normal.x * s.rows[0].xyz + normal.y * s.rows[1].xyz + normal.z * s.rows[2].xyz),
                      half_box);
    return clamp((0.5 - r) / (2.0 * reach) + 0.5, 0.0, 1.0);
}

// Is the box (local centre and half edges) surely outside, surely inside the shape? In between: neither.
bool shape_misses(const shape_block s, vec3 local, vec3 local_half)
{
    vec3 nearest = max(abs(local) - local_half, vec3(0.0));
    return s.kind == TYN_SHAPE_KIND_BOX ? any(greaterThanEqual(nearest, vec3(0.5)))
                                        : dot(nearest, nearest) >= 0.25;
}

bool shape_contains(const shape_block s, vec3 local, vec3 local_half)
{
    vec3 farthest = abs(local) + local_half;
    return s.kind == TYN_SHAPE_KIND_BOX ? all(lessThanEqual(farthest, vec3(0.5 + 1e-5)))
                                        : dot(farthest, farthest) <= 0.25;
}

#ifdef MEDIUM_GROUP
shared uint shapes_near[TYN_SHAPES_MAX / 32]; // a bit each: it may touch voxels of the workgroup

// All threads of the workgroup, MEDIUM_GROUP^3, find its shapes; what is far from it costs its voxels nothing.
void shapes_find()
{
    uint lane = gl_LocalInvocationIndex;
    if (lane < TYN_SHAPES_MAX / 32) {
        shapes_near[lane] = 0u;
    }
    barrier();
    vec3 half_box = 0.5 * float(MEDIUM_GROUP) * medium.voxel;
    vec3 centre = (2.0 * vec3(gl_WorkGroupID) + 1.0) * half_box;
    for (uint i = lane; i < medium.num_shapes; i += MEDIUM_GROUP * MEDIUM_GROUP * MEDIUM_GROUP) {
        // Rounding must not hide a shape that a voxel touches.
        vec3 local_half = (1.0 + 1e-5) * shape_local_half(shapes[i], half_box) + 1e-5;
        if (!shape_misses(shapes[i], shape_local(shapes[i], centre), local_half)) {
            atomicOr(shapes_near[i / 32u], 1u << i % 32u);
        }
    }
    barrier();
}

// The next of them from `first` on, in order; num_shapes: there is none.
uint shapes_next(uint first)
{
    for (uint word = first / 32u; word < TYN_SHAPES_MAX / 32; word++) {
        uint left = shapes_near[word] & (word == first / 32u ? ~0u << first % 32u : ~0u);
        if (left != 0u) {
            return 32u * word + findLSB(left);
        }
    }
    return medium.num_shapes;
}
#endif

// Texels of a grid along a voxel, at least 1 and at most `most`.
int shape_texels(const shape_block s, uvec3 size, int most)
{
    vec3 texels = vec3(size) * vec3(length(s.rows[0].xyz * medium.voxel), length(s.rows[1].xyz * medium.voxel),
                                    length(s.rows[2].xyz * medium.voxel));
    return clamp(int(max(max(texels.x, texels.y), texels.z) + 0.5), 1, most);
}

// Mean over the voxel around p of the texture value, 0 outside the shape. `samples` per axis where the
// voxel is on the shape's edge; inside, as many as it has texels.
float shape_mean(const shape_block s, vec3 p, int samples)
{
    vec3 centre = shape_local(s, p);
    vec3 local_half = shape_local_half(s, 0.5 * medium.voxel);
    if (shape_misses(s, centre, local_half)) {
        return 0.0;
    }
    bool inside = shape_contains(s, centre, local_half);
    int n = inside ? shape_texels(s, s.size, samples) : samples;
    vec3 half_box = 0.5 * medium.voxel / float(n);
    vec3 sub_half = local_half / float(n);
    // Steps between samples are linear in local coordinates.
    mat3 to_local = transpose(mat3(s.rows[0].xyz, s.rows[1].xyz, s.rows[2].xyz));
    vec3 step_x = to_local[0] * 2.0 * half_box.x;
    vec3 step_y = to_local[1] * 2.0 * half_box.y;
    vec3 step_z = to_local[2] * 2.0 * half_box.z;
    vec3 first = centre - 0.5 * float(n - 1) * (step_x + step_y + step_z);
    float sum = 0.0;
    for (int k = 0; k < n; k++) {
        for (int j = 0; j < n; j++) {
            for (int i = 0; i < n; i++) {
                vec3 local = first + float(i) * step_x + float(j) * step_y + float(k) * step_z;
                float cover = inside ? 1.0 : shape_cover(s, local, sub_half, half_box);
                if (cover > 0.0) {
                    sum += cover * shape_value(s, local);
                }
            }
        }
    }
    return sum / float(n * n * n);
}

#ifdef TYN_COLORS
#include "shaders/medium/shape_colors.glsl"
layout(set = 0, binding = COLORS) uniform sampler3D colors_tex;

// A grid of colours (TYN_COLORS_*) at a local position; outside the shape its edge value.
vec3 shape_color(const shape_block s, uint which, vec3 local)
{
    vec3 texel = shape_colors_texel(s.colors[which], local);
    return s.colors[which].scale * textureLod(colors_tex, texel / vec3(textureSize(colors_tex, 0)), 0.0).rgb;
}

// Means over the voxel around p, 0 outside the shape: sigma_s, sigma_a, emission.
mat3 shape_means(const shape_block s, vec3 p, int samples)
{
    vec3 centre = shape_local(s, p);
    vec3 local_half = shape_local_half(s, 0.5 * medium.voxel);
    mat3 sum = mat3(0.0);
    if (shape_misses(s, centre, local_half)) {
        return sum;
    }
    bool inside = shape_contains(s, centre, local_half);
    if (inside) { // of the finest grid
        uvec3 finest = max(max(s.size, s.colors[0].size), max(s.colors[1].size, s.colors[2].size));
        samples = shape_texels(s, finest, samples);
    }
    vec3 half_box = 0.5 * medium.voxel / float(samples);
    mat3 to_local = mat3(s.rows[0].xyz, s.rows[1].xyz, s.rows[2].xyz);
    for (int i = 0; i < samples * samples * samples; i++) {
        ivec3 at = ivec3(i % samples, i / samples % samples, i / (samples * samples));
        vec3 local = centre + (vec3(2 * at - (samples - 1)) * half_box) * to_local;
        float cover = inside ? 1.0 : shape_cover(s, local, local_half / float(samples), half_box);
        if (!(cover > 0.0)) {
            continue;
        }
        float density = shape_value(s, local);
        vec3 t = density * (s.sigma_s + s.sigma_a), scattered = density * s.sigma_s;
        if (shape_has_color(s, TYN_COLORS_ALBEDO)) {
            scattered = t * shape_color(s, TYN_COLORS_ALBEDO, local);
        }
        vec3 emission = density * s.emission;
        if (shape_has_color(s, TYN_COLORS_EMISSION)) {
            emission = s.emission * shape_color(s, TYN_COLORS_EMISSION, local);
        }
        if (shape_has_color(s, TYN_COLORS_RADIANCE)) {
            emission += (t - scattered) * shape_color(s, TYN_COLORS_RADIANCE, local);
        }
        sum += cover * mat3(scattered, t - scattered, emission);
    }
    return sum / float(samples * samples * samples);
}
#endif

// Mode DENSITY: how many times the block's coefficients this shape's are at atlas value 1.
float shape_scale(const shape_block s)
{
    vec3 sigma_t = s.sigma_s + s.sigma_a;
    float largest = max(max(sigma_t.x, sigma_t.y), sigma_t.z);
    return medium.sigma_t_max > 0.0 && largest > 0.0 ? largest / medium.sigma_t_max : 1.0;
}
