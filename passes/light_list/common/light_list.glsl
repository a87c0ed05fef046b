// light_list.glsl -- reads the list of all lights (light_list_args.h).
//
// Declare it before, as `layout(binding = ...) uniform usamplerBuffer light_list_texels`.
#include "light_list_args.h"

struct listed_light {
    vec3 position, color, direction;
    uint kind, shadow;
    float cos_inner, cos_outer, mean_cosine;
};

uint listed_lights()
{
    return texelFetch(light_list_texels, 0).x;
}

// Light n of the list: rows of four words behind the head.
listed_light listed_light_of(uint n)
{
    const int row = 1 + 4 * int(n);
    const uvec4 a = texelFetch(light_list_texels, row), b = texelFetch(light_list_texels, row + 1);
    const uvec4 c = texelFetch(light_list_texels, row + 2), d = texelFetch(light_list_texels, row + 3);
    listed_light l;
    l.position = uintBitsToFloat(a.xyz);
    l.kind = a.w;
    l.color = uintBitsToFloat(b.xyz);
    l.cos_inner = uintBitsToFloat(b.w);
    l.direction = uintBitsToFloat(c.xyz);
    l.cos_outer = uintBitsToFloat(c.w);
    l.shadow = d.y;
    l.mean_cosine = uintBitsToFloat(d.z);
    return l;
}

// Share of a lamp's intensity in a direction of travel, unit.
float listed_light_lobe(const listed_light l, vec3 along)
{
    light_block lobe;
    lobe.kind = l.kind;
    lobe.cos_inner = l.cos_inner;
    lobe.cos_outer = l.cos_outer;
    return light_lobe(lobe, dot(along, l.direction));
}
