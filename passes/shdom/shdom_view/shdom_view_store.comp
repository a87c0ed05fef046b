// shdom_view_store.comp -- light towards the eye as the march reads it: not negative, and continued around the lattice.
//
// A cell without medium has what its neighbours have, so that light does not fall off towards the medium's edge.
#include "shdom_view_args.h"
#include "shaders/common/counters.h"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
TYN_ARGS(shdom_view_args args);
layout(binding = 0) uniform sampler3D seen;
layout(binding = 1, rgba32f) uniform writeonly image3D inscatter;
TYN_UPDATE(2, counters, counters_block counters);

// One row of cells of so many tells of the light that is not negative: atomics of all would take time.
const int TOLD = 8;

vec4 with_neighbours(ivec3 c)
{
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 27; i++) {
        ivec3 q = c + ivec3(i % 3, i / 3 % 3, i / 9) - 1;
        if (all(equal(q, clamp(q, ivec3(0), ivec3(args.dims) - 1)))) {
            vec4 there = texelFetch(seen, q, 0);
            sum += there.a * there;
        }
    }
    return sum / max(sum.a, 1.0);
}

void main()
{
    ivec3 texel = ivec3(gl_GlobalInvocationID), dims = ivec3(args.dims);
    if (any(greaterThanEqual(texel, dims + 2))) {
        return;
    }
    ivec3 c = clamp(texel - 1, ivec3(0), dims - 1);
    bool within = all(equal(c, texel - 1));
    vec4 light = texelFetch(seen, c, 0);
    bool medium = light.a > 0.0;
    light = medium ? light : with_neighbours(c);
    if (any(isnan(light)) || any(isinf(light))) {
        light = vec4(0.0);
        if (within) {
            atomicAdd(counters.non_finite, 1u);
        }
    }
    bool told = (c.y + 3 * c.z) % TOLD == 0;
    if (within && medium) {
        float below = light_below(light.rgb), above = told ? float(TOLD) * light_above(light.rgb) : 0.0;
        TYN_LIGHT_CLAMP_ADD(counters.clamp_0, below, above)
        if (below > 0.0) {
            atomicAdd(counters.clamped, 1u);
        }
    }
    vec3 rgb = args.channels == 1u ? light.r * args.tint : light.rgb;
    imageStore(inscatter, texel, vec4(max(rgb, vec3(0.0)), 1.0));
}
