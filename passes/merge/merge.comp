// merge.comp -- radiance that a cell scatters towards the eye, per sigma_s': clamped at 0, and continued around the
// lattice. Built for one channel and for three (MERGE_CHANNELS, MERGE_FORMAT).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/common/scene_args.h"
#include "shaders/common/counters.h"
#include "merge_args.h"
#include "shaders/lattice/lattice.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
TYN_ARGS(merge_args args);
TYN_READ(0, field, float field[]);
TYN_UPDATE(1, counters, counters_block counters);
layout(binding = 2, MERGE_FORMAT) uniform writeonly image3D inscatter;
#include "merge.glsl"

vec3 merge_cell(ivec3 c)
{
    vec3 j = vec3(0.0);
    for (uint ch = 0u; ch < MERGE_CHANNELS; ch++) {
        float value = field[merge_index(c, ch)];
        j[ch] = isnan(value) || isinf(value) ? 0.0 : max(value, 0.0);
    }
    return j;
}

void merge_count(ivec3 c)
{
    bool negative = false, broken = false;
    for (uint ch = 0u; ch < MERGE_CHANNELS; ch++) {
        float value = field[merge_index(c, ch)];
        negative = negative || value < 0.0;
        broken = broken || isnan(value) || isinf(value);
    }
    // Elsewhere nobody reads it.
    if (negative && field[merge_index(c, MERGE_CHANNELS)] > 0.0) {
        atomicAdd(counters.clamped, 1u);
    }
    if (broken) {
        atomicAdd(counters.non_finite, 1u);
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
    return vec4(max(j, vec3(0.0)), 1.0);
}

void main()
{
    ivec3 texel = ivec3(gl_GlobalInvocationID);
    if (all(lessThan(texel, ivec3(args.dims) + 2))) {
        imageStore(inscatter, texel, merge_texel(texel));
    }
}
