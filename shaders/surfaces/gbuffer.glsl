// gbuffer.glsl -- what pass gbuffer stores of the surface that a ray of the camera meets first.
//
// `distances`, R32F, a texel a sample, those of a pixel side by side: m along the ray; 0: no surface.
// `facing`, RGBA32UI, a texel a pixel: what it shows (GBUFFER_*), the facet's normal and that for shading, in M and on
// the camera's side.
// `colours`, RGBA32UI, gbuffer_texels(samples along a side) texels a pixel, side by side.
//
// Where all samples of a pixel lie on one piece of surface, `facing` has the first one's facet and their mean normal,
// and the first of `colours` their mean albedo and emission. Of a pixel that shows several pieces, or one beside
// nothing, `facing` is that of the sample nearest its middle, and `colours` hold the triangles that samples see, four a
// texel: index + 1, 0: none. These pixels are in a list as well.
//
// Define GBUFFER_AT as the first binding of the bundle TYN_GBUFFER (bundles.h) to read it.
#ifndef TYN_GBUFFER_GLSL
#define TYN_GBUFFER_GLSL
#include "shaders/colour/packed_colour.glsl"
#include "shaders/common/octahedral.glsl"
#include "gbuffer_edge_args.h"

#define GBUFFER_NONE 0u
#define GBUFFER_WHOLE 1u
#define GBUFFER_SEVERAL 2u

#ifdef GBUFFER_AT
layout(binding = GBUFFER_AT) uniform sampler2D distances_tex;
layout(binding = GBUFFER_AT + 1, rgba32ui) uniform readonly uimage2D facing_image;
layout(binding = GBUFFER_AT + 2, rgba32ui) uniform readonly uimage2D colours_image;
TYN_READ(GBUFFER_AT + 3, edge_count, gbuffer_edge_count edge_count);
TYN_READ(GBUFFER_AT + 4, edges, uint edges[]);
#define GBUFFER_END (GBUFFER_AT + 5)
#endif

struct gbuffer_colours {
    vec3 albedo;
    vec3 emission; // W/(m^2 sr)
};
const gbuffer_colours GBUFFER_BLACK = gbuffer_colours(vec3(0.0), vec3(0.0));

struct gbuffer_point {
    float distance; // m along the ray; 0: no surface
    vec3 normal;    // for shading
    vec3 facet;     // of the triangle
    gbuffer_colours colours;
};

gbuffer_colours gbuffer_add(const gbuffer_colours sum, float share, const gbuffer_colours c)
{
    return gbuffer_colours(sum.albedo + share * c.albedo, sum.emission + share * c.emission);
}

struct gbuffer_facing {
    uint shown; // GBUFFER_*
    int which;  // of the pixel's samples it is for
    vec3 normal, facet;
};

// Floats, but for the lowest bits of the shading normal: they tell what is shown, and of which sample it is.
uvec4 gbuffer_facing_pack(const gbuffer_facing f)
{
    uvec4 texel = floatBitsToUint(vec4(octahedral_of(f.facet), octahedral_of(f.normal)));
    return uvec4(texel.xy, (texel.z & ~3u) | f.shown, (texel.w & ~15u) | uint(f.which));
}

gbuffer_facing gbuffer_facing_unpack(uvec4 texel)
{
    vec2 facet = uintBitsToFloat(texel.xy), normal = uintBitsToFloat(texel.zw & ~uvec2(3u, 15u));
    return gbuffer_facing(texel.z & 3u, int(texel.w & 15u), normalize(octahedral_point(normal)),
                          normalize(octahedral_point(facet)));
}

// Texels of `colours` that a pixel has side by side.
int gbuffer_texels(int samples)
{
    return (samples * samples + 3) / 4;
}

// Albedo, 0 to 1: 20 bits a channel.
uvec4 gbuffer_pack(const gbuffer_colours colours)
{
    uvec3 c = uvec3(clamp(colours.albedo, 0.0, 1.0) * 1048575.0 + 0.5);
    return uvec4(colour_pack(colours.emission), c.r | c.b << 20, c.g | (c.b >> 12) << 20);
}

gbuffer_colours gbuffer_unpack(uvec4 texel)
{
    uvec3 c = uvec3(texel.z & 0xfffffu, texel.w & 0xfffffu, texel.z >> 20 | (texel.w >> 20) << 12);
    return gbuffer_colours(vec3(c) / 1048575.0, colour_unpack(texel.xy));
}

// Do a sample at `other` (M) with the normal `facet`, in the distance `distance` from the camera, and one at `first`
// lie on one piece of surface?
bool gbuffer_same(const gbuffer_point first, vec3 at, vec3 facet, vec3 other, float distance)
{
    vec3 d = other - at;
    return dot(facet, first.facet) > 0.9 && abs(dot(d, first.facet)) < 0.3 * length(d) + 1e-5 * distance;
}

#endif
