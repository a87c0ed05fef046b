// env_glow_rows.comp -- Fourier sums of the map's rows: a row a group, an order a thread.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "glow_args.h"
#include "env_glow_args.h"

const uint ORDERS = TYN_GLOW_HEIGHT, HALF = TYN_GLOW_WIDTH / 2;
layout(local_size_x = TYN_GLOW_HEIGHT) in;
layout(set = 0, binding = 0) uniform sampler2D sky_tex;
layout(set = 0, binding = 1, scalar) writeonly buffer rows_buffer
{
    glow_order rows[];
};
layout(push_constant, scalar) uniform Args
{
    env_glow_args args;
};

const float PI = 3.14159265358979;

// Sum and difference of two texels opposite each other: those of even and of odd order add up.
shared vec3 folded[2][HALF];

vec3 texel(uint i, uint row)
{
    vec2 uv = (vec2(i, row) + 0.5) / vec2(TYN_GLOW_WIDTH, TYN_GLOW_HEIGHT);
    vec3 light = textureLod(sky_tex, uv, args.mip).rgb;
    return any(isnan(light)) || any(isinf(light)) ? vec3(0.0) : light;
}

void main()
{
    uint m = gl_LocalInvocationID.x, row = gl_WorkGroupID.y;
    for (uint i = m; i < HALF; i += ORDERS) {
        vec3 here = texel(i, row), opposite = texel(i + HALF, row);
        folded[0][i] = here + opposite;
        folded[1][i] = here - opposite;
    }
    barrier();
    float angle = float(m) * (PI / float(TYN_GLOW_WIDTH));
    vec2 turned = vec2(cos(angle), sin(angle)), turn = vec2(cos(2.0 * angle), sin(2.0 * angle));
    vec3 cosine = vec3(0.0), sine = vec3(0.0);
    for (uint i = 0u; i < HALF; i++) {
        vec3 light = folded[m & 1u][i];
        cosine += light * turned.x;
        sine += light * turned.y;
        turned = vec2(turned.x * turn.x - turned.y * turn.y, turned.x * turn.y + turned.y * turn.x);
    }
    float scale = (m == 0u ? 1.0 : 2.0) / float(TYN_GLOW_WIDTH);
    rows[m * TYN_GLOW_HEIGHT + row] = glow_order(scale * cosine, scale * sine);
}
