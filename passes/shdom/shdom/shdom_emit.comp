// shdom_emit.comp -- the source function of the cells towards a batch of ordinates, W/(m^3 sr). y: groups of ordinates.
#include "shdom_args.h"

layout(local_size_x = 64) in;
TYN_ARGS(shdom_args args);
layout(binding = 0) uniform samplerBuffer sent_0_words; // [coefficient][cell]
layout(binding = 1) uniform samplerBuffer basis_texels; // [coefficient][ordinate]
TYN_WRITE(2, emitted, float emitted[]);                 // [ordinate of the batch][cell]

void main()
{
    uint i = gl_GlobalInvocationID.x, group = gl_GlobalInvocationID.y, all = args.dims.x * args.dims.y * args.dims.z;
    if (i >= all || group * SHDOM_GROUP >= args.count) {
        return;
    }
    vec4 a = vec4(0.0), b = a, c = a, d = a;
    for (uint k = 0u; k < args.bands * args.bands; k++) {
        float s = texelFetch(sent_0_words, int(k * all + i)).x;
        int row = int(k * args.ordinates + args.first + group * SHDOM_GROUP) / 4;
        a += s * texelFetch(basis_texels, row);
        b += s * texelFetch(basis_texels, row + 1);
        c += s * texelFetch(basis_texels, row + 2);
        d += s * texelFetch(basis_texels, row + 3);
    }
    uint to = group * SHDOM_GROUP * all + i;
    [[unroll]] for (uint n = 0u; n < SHDOM_GROUP; n++) {
        emitted[to + n * all] = n < 4u ? a[n] : n < 8u ? b[n - 4u] : n < 12u ? c[n - 8u] : d[n - 12u];
    }
}
