// piece_light.glsl -- radiance of the surfaces in a pixel, and how far away they are, in a texel: of two groups of its samples.
//
// Of one group: its packed colour, and the distance. Of two, two words each: 20 bits of the distance, and 12 bits a channel with a
// common exponent of eight. Distances are right within 2^-13 then, colours within 2^-12 of the largest channel
// (2^-11 where shade_alone.comp adds to them).
#ifndef TYN_PIECE_LIGHT_GLSL
#define TYN_PIECE_LIGHT_GLSL
#include "shaders/colour/packed_colour.glsl"

struct piece_light {
    vec3 radiance;  // towards the camera, W/(m^2 sr)
    float distance; // along the ray through the middle of the group's samples, m
};

// Sums for piece_light_mean: of `count` samples, and of reciprocals of distances, which are nearly linear over the pixel.
piece_light piece_light_add(const piece_light sum, int count, vec3 radiance, float distance)
{
    return count > 0 ? piece_light(sum.radiance + float(count) * radiance,
                                   sum.distance + float(count) / distance)
                     : sum;
}

piece_light piece_light_mean(const piece_light sum, int count)
{
    float samples = float(max(count, 1));
    return piece_light(sum.radiance / samples, sum.distance > 0.0 ? samples / sum.distance : 0.0);
}

uvec2 piece_light_half(const piece_light p)
{
    uvec3 bits = floatBitsToUint(p.radiance) & 0x7fffffffu;
    uint exponent = max(max(bits.r, max(bits.g, bits.b)) >> 23, 20u);
    float scale = uintBitsToFloat((265u - exponent) << 23); // times the largest: below 2^12
    uvec3 c = uvec3(max(min(vec3(4095.0), p.radiance * scale + 0.5), vec3(0.0)));
    return uvec2((floatBitsToUint(p.distance) + 0x400u) >> 11 | c.r << 20,
                 c.g | c.b << 12 | exponent << 24);
}

uvec4 piece_light_pack(const piece_light first, const piece_light second, bool two)
{
    uvec4 one = uvec4(colour_pack(first.radiance), floatBitsToUint(first.distance), 0u);
    return two ? uvec4(piece_light_half(first), piece_light_half(second)) : one;
}

// Of group 0 or 1, if there are `two`.
piece_light piece_light_unpack(uvec4 texel, bool two, int group)
{
    uvec2 words = group == 0 ? texel.xy : texel.zw;
    float scale = uintBitsToFloat(((words.y >> 24) - 11u) << 23);
    uvec3 c = uvec3(words.x >> 20, words.y & 0xfffu, words.y >> 12 & 0xfffu);
    piece_light half_of = piece_light(vec3(c) * scale, uintBitsToFloat((words.x & 0xfffffu) << 11));
    piece_light one = piece_light(colour_unpack(texel.xy), uintBitsToFloat(texel.z));
    return piece_light(two ? half_of.radiance : one.radiance,
                       two ? half_of.distance : one.distance);
}

#endif
