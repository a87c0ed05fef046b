// radial_texels.glsl -- local lights and their grids (radial_args.h) read as texels of four words. No bindings.
#ifndef TYN_RADIAL_TEXELS_GLSL
#define TYN_RADIAL_TEXELS_GLSL
#include "radial_args.h"

// The one whose first row is `at`.
light_block light_block_at(usamplerBuffer rows, int at)
{
    uvec4 a = texelFetch(rows, at), b = texelFetch(rows, at + 1);
    uvec4 c = texelFetch(rows, at + 2), d = texelFetch(rows, at + 3);
    return light_block(uintBitsToFloat(a.xyz), a.w, uintBitsToFloat(b.xyz), uintBitsToFloat(b.w),
                       uintBitsToFloat(c.xyz), uintBitsToFloat(c.w), uintBitsToFloat(d.x), d.y, uintBitsToFloat(d.z),
                       d.w);
}

radial_grid radial_grid_at(usamplerBuffer rows, int at)
{
    vec4 a = uintBitsToFloat(texelFetch(rows, at + 4)), b = uintBitsToFloat(texelFetch(rows, at + 5));
    vec4 c = uintBitsToFloat(texelFetch(rows, at + 6));
    uvec4 d = texelFetch(rows, at + 7), e = texelFetch(rows, at + 8), f = texelFetch(rows, at + 9);
    return radial_grid(light_block_at(rows, at), vec3[3](a.xyz, vec3(a.w, b.xy), vec3(b.zw, c.x)), c.yzw,
                       uintBitsToFloat(d.xyz), uvec3(d.w, e.xy), e.z, e.w, uintBitsToFloat(f.x), uintBitsToFloat(f.y),
                       uintBitsToFloat(f.z), f.w);
}

#endif
