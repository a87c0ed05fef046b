// packed_colour.glsl -- three numbers >= 0 in 62 bits of two words: 18 bits each, with a common exponent of eight.
//
// The error is 2^-18 of the largest one at most, from 1e-32 to 3e38; a colour that is not finite comes back as one that
// is not. Bits 30 and 31 of the second word are the caller's.
#ifndef TYN_PACKED_COLOUR_GLSL
#define TYN_PACKED_COLOUR_GLSL

uvec2 colour_pack(vec3 colour)
{
    uvec3 bits = floatBitsToUint(colour) & 0x7fffffffu;
    uint exponent = max(max(bits.r, max(bits.g, bits.b)) >> 23, 20u);
    float scale = uintBitsToFloat((271u - exponent) << 23); // 2^18 times this is above the largest one
    uvec3 c = uvec3(max(min(vec3(262143.0), colour * scale + 0.5), vec3(0.0)));
    return uvec2(c.r | c.b << 18, c.g | (c.b >> 14) << 18 | exponent << 22);
}

vec3 colour_unpack(uvec2 words)
{
    float scale = uintBitsToFloat(((words.y >> 22 & 0xffu) - 17u) << 23);
    uvec3 c = uvec3(words.x & 0x3ffffu, words.y & 0x3ffffu, words.x >> 18 | (words.y >> 18 & 0xfu) << 14);
    return vec3(c) * scale;
}

#endif
