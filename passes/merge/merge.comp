// merge.comp -- radiance that a cell scatters towards the eye, per sigma_s': clamped at 0, and continued around the
// lattice. Built for one channel and for three (MERGE_CHANNELS, MERGE_FORMAT).
//
// What the clamps hide is weighed as the picture would see it but for what is before it: J sigma_s' over the square of
// the distance, of cells that are in the picture. A ghost cell's light is seen, blended, in the outer half of the
// cell before it alone: an eighth of it.
#include "shaders/common/scene_args.h"
#include "shaders/common/counters.h"
#include "merge_args.h"
#include "shaders/lattice/lattice.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
TYN_ARGS(merge_args args);
TYN_READ(0, field, float field[]);
TYN_UPDATE(1, counters, counters_block counters);
layout(binding = 2, MERGE_FORMAT) uniform writeonly image3D inscatter;
TYN_UNIFORM(3, medium, medium_block medium);
TYN_UNIFORM(4, camera, camera_block camera);
layout(binding = 5) uniform sampler3D cells;
#include "merge.glsl"

// One row of cells of so many tells of the light that is not negative: atomics of all would take time. Threads that run
// together tell all or nothing.
const int MERGE_TOLD = 8;
const float GHOST = 0.125; // int_0^(1/2) t dt: of a cell's light that is blended towards a ghost cell

vec3 merge_cell(ivec3 c)
{
    vec3 j = vec3(0.0);
    for (uint ch = 0u; ch < MERGE_CHANNELS; ch++) {
        float value = field[merge_index(c, ch)];
        j[ch] = isnan(value) || isinf(value) ? 0.0 : max(value, 0.0);
    }
    return j;
}

// sigma_s' of the channels.
vec3 merge_scattering(ivec3 c)
{
    vec3 scattering = vec3(0.0);
    for (uint ch = 0u; ch < MERGE_CHANNELS; ch++) {
        scattering[ch] = texelFetch(cells, c + ivec3(0, 0, ch * args.dims.z), 0).x;
    }
    return scattering;
}

// Counts the light of `value` before its clamp, of cell c: what is below 0 `below` times, what is above `above` times.
void merge_count_light(ivec3 c, vec3 value, float below, float above)
{
    float weight = merge_weight(camera, lattice_box_of(medium.extent, ivec3(args.dims)), c);
    vec3 light = merge_scattering(c) * value;
    below *= weight * light_below(light);
    above *= weight * light_above(light);
    TYN_LIGHT_CLAMP_ADD(counters.clamp_0, below, above)
}

void merge_count(ivec3 c)
{
    vec3 value = vec3(0.0);
    bool broken = false;
    for (uint ch = 0u; ch < MERGE_CHANNELS; ch++) {
        value[ch] = field[merge_index(c, ch)];
        broken = broken || isnan(value[ch]) || isinf(value[ch]);
    }
    if (broken) {
        atomicAdd(counters.non_finite, 1u);
        return;
    }
    bool negative = any(lessThan(value, vec3(0.0))), told = (c.y + 3 * c.z) % MERGE_TOLD == 0;
    if ((negative || told) && field[merge_index(c, MERGE_CHANNELS)] > 0.0) { // elsewhere nobody reads it
        merge_count_light(c, value, 1.0, told ? float(MERGE_TOLD) : 0.0);
        if (negative) {
            atomicAdd(counters.clamped, 1u);
        }
    }
}

// `value` of a ghost cell; `near` is the cell before it.
void merge_count_ghost(ivec3 near, ivec3 outside, vec3 value)
{
    if (any(lessThan(value, vec3(0.0))) && field[merge_index(near, MERGE_CHANNELS)] > 0.0) {
        merge_count_light(near, value, pow(GHOST, float(outside.x + outside.y + outside.z)), 0.0);
        atomicAdd(counters.ghosts, 1u);
    }
}

// A ghost cell continues the two cells before it: 2 J_0 - J_1, along each axis where it is outside; along a
// periodic one it is the cell at the other end.
vec4 merge_texel(ivec3 texel)
{
    ivec3 dims = ivec3(args.dims), c = texel - 1;
    bool within = all(equal(c, clamp(c, ivec3(0), dims - 1)));
    c = mix(c, (c + dims) % dims, notEqual(args.repeat, uvec3(0)));
    ivec3 near = clamp(c, ivec3(0), dims - 1);
    ivec3 far = clamp(2 * near - c, ivec3(0), dims - 1);
    ivec3 outside = ivec3(notEqual(c, near));
    if (within) {
        merge_count(c);
    }
    vec3 j = vec3(0.0);
    for (int k = 0; k <= outside.z; k++) {
        for (int l = 0; l <= outside.y; l++) {
            for (int i = 0; i <= outside.x; i++) {
                ivec3 q = ivec3(i == 0 ? near.x : far.x, l == 0 ? near.y : far.y, k == 0 ? near.z : far.z);
                float w = (i == 0 ? 1.0 + outside.x : -1.0) * (l == 0 ? 1.0 + outside.y : -1.0) *
                          (k == 0 ? 1.0 + outside.z : -1.0);
                j += w * merge_cell(q);
            }
        }
    }
    if (outside != ivec3(0)) {
        merge_count_ghost(near, outside, j);
    }
    return vec4(max(j, vec3(0.0)), 1.0);
}

void main()
{
    ivec3 texel = ivec3(gl_GlobalInvocationID);
    if (all(lessThan(texel, ivec3(args.dims) + 2))) {
        imageStore(inscatter, texel, merge_texel(texel));
    }
}
