// diffusion_relax.comp -- cells of one colour take the fluence that fits that of their neighbours, and a little more.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "diffusion_system.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
layout(binding = 0) uniform samplerBuffer system_texels;
TYN_UPDATE(1, fluence, float fluence[]);

void main()
{
    ivec3 texel = ivec3(gl_GlobalInvocationID), dims = ivec3(args.dims);
    uint channel = uint(texel.z / dims.z);
    ivec3 c = ivec3(2 * texel.x, texel.y, texel.z - int(channel) * dims.z);
    c.x += (c.y + c.z + int(args.colour)) & 1;
    if (c.x >= dims.x || c.y >= dims.y || channel >= args.channels) {
        return;
    }
    uint i = system_index(c, channel);
    vec4 own = texelFetch(system_texels, int(i));
    float sum = own.z, weight = own.y;
    [[unroll]] for (int f = 0; f < 6; f++) {
        ivec3 q = c + FACES[f];
        bool within = system_within(q);
        uint k = within ? system_index(q, channel) : i;
        float w = within ? system_between(own.x, texelFetch(system_texels, int(k)).x) : system_boundary(own.x);
        weight += w;
        sum += within ? w * fluence[k] : 0.0;
    }
    float before = fluence[i];
    fluence[i] = before + args.omega * (sum / weight - before);
}
