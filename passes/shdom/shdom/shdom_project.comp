// shdom_project.comp -- radiance of a batch of ordinates, cell by cell, as spherical harmonics. y: groups of coefficients.
//
// A thread sums over the ordinates in their order, so that two runs give the same bytes.
#include "shdom_args.h"

layout(local_size_x = 64) in;
TYN_ARGS(shdom_args args);
layout(binding = 0) uniform samplerBuffer emitted_words;   // [ordinate of the batch][cell]
layout(binding = 1) uniform samplerBuffer weighted_texels; // [ordinate][coefficient]
TYN_UPDATE(2, radiance, float radiance[]);                 // [coefficient][cell]

void main()
{
    uint i = gl_GlobalInvocationID.x, group = gl_GlobalInvocationID.y, all = args.dims.x * args.dims.y * args.dims.z;
    if (i >= all || group >= args.coefficients / SHDOM_GROUP) {
        return;
    }
    vec4 a = vec4(0.0), b = a, c = a, d = a;
    for (uint n = 0u; n < args.count; n++) {
        float light = texelFetch(emitted_words, int(n * all + i)).x;
        int row = int((args.first + n) * args.coefficients + group * SHDOM_GROUP) / 4;
        a += light * texelFetch(weighted_texels, row);
        b += light * texelFetch(weighted_texels, row + 1);
        c += light * texelFetch(weighted_texels, row + 2);
        d += light * texelFetch(weighted_texels, row + 3);
    }
    uint to = group * SHDOM_GROUP * all + i;
    bool more = args.first > 0u;
    [[unroll]] for (uint k = 0u; k < SHDOM_GROUP; k++) {
        float sum = k < 4u ? a[k] : k < 8u ? b[k - 4u] : k < 12u ? c[k - 8u] : d[k - 12u];
        radiance[to + k * all] = more ? radiance[to + k * all] + sum : sum;
    }
}
