// env_glow_texels.comp -- texels of the smeared map from its rows' Fourier sums: four texels a thread.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "glow_args.h"

const uint ROWS = TYN_GLOW_HEIGHT, ORDERS = TYN_GLOW_HEIGHT, WIDTH = TYN_GLOW_WIDTH;
layout(local_size_x = TYN_GLOW_WIDTH / 4) in;
layout(set = 0, binding = 0, scalar) readonly buffer series_buffer
{
    glow_series series;
};
layout(set = 0, binding = 1, scalar) readonly buffer levels_buffer
{
    glow_order levels[];
};
layout(set = 0, binding = 2, rgba32f) writeonly uniform image3D glow_image;

const float PI = 3.14159265358979;

void main()
{
    uint i = gl_LocalInvocationID.x, row = gl_WorkGroupID.y, level = gl_WorkGroupID.z;
    float angle = (2.0 * PI) * (float(i) + 0.5) / float(WIDTH);
    vec2 turn = vec2(cos(angle), sin(angle)), turned = vec2(1.0, 0.0);
    // Of even and odd orders, cosines and sines: their signs differ between phi, pi - phi, pi + phi and
    // -phi.
    vec3 cosine[2] = {vec3(0.0), vec3(0.0)}, sine[2] = {vec3(0.0), vec3(0.0)};
    uint terms = series.terms[level], at = level * ORDERS * ROWS + row;
    for (uint m = 0u; m < terms; m += 2u) {
        for (uint k = 0u; k < 2u; k++) { // terms are even
            glow_order f = levels[at + (m + k) * ROWS];
            cosine[k] += f.cosine * turned.x;
            sine[k] += f.sine * turned.y;
            turned = vec2(turned.x * turn.x - turned.y * turn.y, turned.x * turn.y + turned.y * turn.x);
        }
    }
    vec3 c = cosine[0] + cosine[1], s = sine[0] + sine[1];
    vec3 c_pi = cosine[0] - cosine[1], s_pi = sine[0] - sine[1];
    // What the truncated series leaves below 0 in dark places beside bright ones is not resolved.
    imageStore(glow_image, ivec3(i, row, level), vec4(max(c + s, 0.0), 1.0));
    imageStore(glow_image, ivec3(WIDTH / 2 - 1 - i, row, level), vec4(max(c_pi - s_pi, 0.0), 1.0));
    imageStore(glow_image, ivec3(WIDTH / 2 + i, row, level), vec4(max(c_pi + s_pi, 0.0), 1.0));
    imageStore(glow_image, ivec3(WIDTH - 1 - i, row, level), vec4(max(c - s, 0.0), 1.0));
}
