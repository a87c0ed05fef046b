// gbuffer.glsl -- what pass gbuffer stores: the triangle that each sample of the picture sees.
//
// `seen`, R32UI, a texel a sample, those of a pixel side by side: index + 1, 0: none; bits above it tell of the pixel. All else is
// computed from the triangles where it is needed (gbuffer_triangle.glsl).
//
// Samples of a pixel lie on one piece of surface, or on several. Their light is stored for two groups of them: a piece each, or
// what is near and what is far (piece_light.glsl).
//
// Define GBUFFER_AT as the binding of the bundle TYN_GBUFFER (bundles.h) to read it, and GBUFFER_SIDE where the samples along each side
// of a pixel are a constant: a quotient takes a CPU device long.
#ifndef TYN_GBUFFER_GLSL
#define TYN_GBUFFER_GLSL

#define GBUFFER_SEVERAL 0x80000000u // of the first sample: the pixel shows several pieces, or one beside nothing
#define GBUFFER_MIXED 0x40000000u   // of the first sample: not all of the pixel's see the same
#define GBUFFER_SECOND 0x20000000u  // in the second group
#define GBUFFER_INDEX 0x1fffffffu   // gbuffer.h has the number of triangles that fit

struct gbuffer_pixel {
    ivec2 at;
    int side;   // samples along each side
    uint first; // texel of the first sample
};

struct gbuffer_groups { // samples: bits
    uint first, second;
};

// The samples among `left` of the first group, or of the second if these are none.
uint gbuffer_of_group(const gbuffer_groups g, uint left)
{
    return (left & g.first) != 0u ? left & g.first : left & g.second;
}

uint gbuffer_all(const gbuffer_pixel p)
{
    return (1u << p.side * p.side) - 1u;
}

ivec2 gbuffer_texel(const gbuffer_pixel p, int k)
{
    return p.at * p.side + ivec2(k % p.side, k / p.side);
}

// Where sample k is, pixels.
vec2 gbuffer_place(const gbuffer_pixel p, int k)
{
    return (vec2(gbuffer_texel(p, k)) + 0.5) / float(p.side);
}

// The middle of samples, pixels from the pixel's corner.
vec2 gbuffer_middle(const gbuffer_pixel p, uint members)
{
    vec2 sum = vec2(0.0);
    for (uint some = members; some != 0u; some &= some - 1u) {
        int k = findLSB(some);
        sum += vec2(k % p.side, k / p.side) + 0.5;
    }
    return sum / float(max(bitCount(members), 1) * p.side);
}

// The part of the picture that samples fill, or the rectangle around them: from xy to zw, pixels.
vec4 gbuffer_part(const gbuffer_pixel p, uint members)
{
    vec4 part = vec4(1e9, 1e9, -1e9, -1e9);
    for (uint some = members; some != 0u; some &= some - 1u) {
        vec2 at = vec2(gbuffer_texel(p, findLSB(some)));
        part = vec4(min(part.xy, at), max(part.zw, at + 1.0));
    }
    return part / float(p.side);
}

bool gbuffer_is_several(const gbuffer_pixel p)
{
    return (p.first & GBUFFER_SEVERAL) != 0u;
}

bool gbuffer_is_mixed(const gbuffer_pixel p)
{
    return (p.first & GBUFFER_MIXED) != 0u;
}

bool gbuffer_is_none(const gbuffer_pixel p)
{
    return p.first == 0u;
}

#ifdef GBUFFER_AT
layout(binding = GBUFFER_AT, r32ui) uniform readonly uimage2D seen_image;
#define GBUFFER_END (GBUFFER_AT + 1)

// `width` of the picture, pixels.
gbuffer_pixel gbuffer_pixel_at(ivec2 at, uint width)
{
#ifdef GBUFFER_SIDE
    const int side = GBUFFER_SIDE;
#else
    int side = imageSize(seen_image).x / int(width);
#endif
    return gbuffer_pixel(at, side, imageLoad(seen_image, at * side).r);
}

uint gbuffer_seen(const gbuffer_pixel p, int k)
{
    return gbuffer_is_mixed(p) ? imageLoad(seen_image, gbuffer_texel(p, k)).r : p.first;
}

// Of the triangle that sample k sees, + 1; 0: none.
uint gbuffer_index(const gbuffer_pixel p, int k)
{
    return gbuffer_seen(p, k) & GBUFFER_INDEX;
}

// Samples that see a surface: bits.
uint gbuffer_shown(const gbuffer_pixel p)
{
    uint shown = gbuffer_is_none(p) ? 0u : gbuffer_all(p);
    for (int k = 0; k < p.side * p.side && gbuffer_is_several(p); k++) {
        shown &= gbuffer_index(p, k) == 0u ? ~(1u << k) : ~0u;
    }
    return shown;
}

gbuffer_groups gbuffer_groups_of(const gbuffer_pixel p)
{
    uint shown = gbuffer_shown(p), second = 0u;
    for (int k = 0; k < p.side * p.side && gbuffer_is_mixed(p); k++) {
        second |= (gbuffer_seen(p, k) & GBUFFER_SECOND) != 0u ? 1u << k : 0u;
    }
    return gbuffer_groups(shown & ~second, second);
}
#endif

#endif
