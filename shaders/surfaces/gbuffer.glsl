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
#ifndef TYN_GBUFFER_GLSL
#define TYN_GBUFFER_GLSL
#include "shaders/colour/packed_colour.glsl"

#define GBUFFER_NONE 0u
#define GBUFFER_WHOLE 1u
#define GBUFFER_SEVERAL 2u

struct gbuffer_point {
    float distance; // m along the ray; 0: no surface
    vec3 normal;    // for shading
    vec3 facet;     // of the triangle
    vec3 albedo;
    vec3 emission; // W/(m^2 sr)
};

struct gbuffer_facing {
    uint shown; // GBUFFER_*
    int which;  // of the pixel's samples it is for
    vec3 normal, facet;
};

// The octahedral map of unit vectors to [-1, 1]^2 (Cigolle et al., "A survey of efficient representations
// for independent unit vectors", JCGT 3(2), 2014).
vec2 gbuffer_fold(vec3 n)
{
    vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    vec2 signs = mix(vec2(-1.0), vec2(1.0), greaterThanEqual(p, vec2(0.0)));
    return n.z >= 0.0 ? p : (1.0 - abs(p.yx)) * signs;
}

vec3 gbuffer_unfold(vec2 p)
{
    vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
    vec2 signs = mix(vec2(-1.0), vec2(1.0), greaterThanEqual(p, vec2(0.0)));
    n.xy = n.z >= 0.0 ? n.xy : (1.0 - abs(n.yx)) * signs;
    return normalize(n);
}

// Floats, but for the lowest bits of the shading normal: they tell what is shown, and of which sample it is.
uvec4 gbuffer_facing_pack(gbuffer_facing f)
{
    uvec4 texel = floatBitsToUint(vec4(gbuffer_fold(f.facet), gbuffer_fold(f.normal)));
    return uvec4(texel.xy, (texel.z & ~3u) | f.shown, (texel.w & ~15u) | uint(f.which));
}

gbuffer_facing gbuffer_facing_unpack(uvec4 texel)
{
    return gbuffer_facing(texel.z & 3u, int(texel.w & 15u), gbuffer_unfold(uintBitsToFloat(texel.zw & ~uvec2(3u, 15u))),
                          gbuffer_unfold(uintBitsToFloat(texel.xy)));
}

// Texels of `colours` that a pixel has side by side.
int gbuffer_texels(int samples)
{
    return (samples * samples + 3) / 4;
}

// Albedo, 0 to 1: 20 bits a channel.
uvec4 gbuffer_colours_pack(vec3 albedo, vec3 emission)
{
    uvec3 c = uvec3(clamp(albedo, 0.0, 1.0) * 1048575.0 + 0.5);
    return uvec4(colour_pack(emission), c.r | c.b << 20, c.g | (c.b >> 12) << 20);
}

vec3 gbuffer_albedo(uvec4 texel)
{
    return vec3(texel.z & 0xfffffu, texel.w & 0xfffffu, texel.z >> 20 | (texel.w >> 20) << 12) / 1048575.0;
}

vec3 gbuffer_emission(uvec4 texel)
{
    return colour_unpack(texel.xy);
}

// Do a sample at `other` (M) with the normal `facet`, in the distance `distance` from the camera, and one at `first`
// lie on one piece of surface?
bool gbuffer_same(gbuffer_point first, vec3 at, vec3 facet, vec3 other, float distance)
{
    vec3 d = other - at;
    return dot(facet, first.facet) > 0.9 && abs(dot(d, first.facet)) < 0.3 * length(d) + 1e-5 * distance;
}

#endif
