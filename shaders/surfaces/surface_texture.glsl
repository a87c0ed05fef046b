// surface_texture.glsl -- textures of surfaces, filtered trilinearly from their mip chains in a buffer.
//
// Define MATERIALS_AT, and GEOMETRY_AT for surface_colour_over (surfaces.glsl).
#ifndef TYN_SURFACE_TEXTURE_GLSL
#define TYN_SURFACE_TEXTURE_GLSL
#include "surfaces.glsl"

// Texel coordinate of a whole number, by the rule of its axis.
int surface_wrap(int i, int size, uint rule)
{
    if (rule == 1u) {
        return clamp(i, 0, size - 1);
    }
    int period = rule == 2u ? 2 * size : size;
    // Not by a quotient of floats, which may be rounded to below a whole number: then the last texel is taken for the first.
    i = i < 0 ? period - 1 - (-1 - i) % period : i % period;
    return i < size ? i : 2 * size - 1 - i;
}

// A texel of a level that starts with `first`, as it is stored: sRGB.
vec3 surface_texel_srgb(uint first, ivec2 size, uvec2 wrap, ivec2 at)
{
    int x = surface_wrap(at.x, size.x, wrap.x), y = surface_wrap(at.y, size.y, wrap.y);
    return unpackUnorm4x8(texelFetch(texels_words, int(first + uint(y * size.x + x))).r).rgb;
}

// Its linear colour (IEC 61966-2-1).
vec3 surface_texel(uint first, ivec2 size, uvec2 wrap, ivec2 at)
{
    vec3 c = surface_texel_srgb(first, size, wrap, at);
    return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045)));
}

// First texel of a level.
uint surface_level(const surface_texture t, uint level, out ivec2 size)
{
    uint first = t.first;
    for (uint l = 0u; l < level; l++) {
        uvec2 s = max(t.size >> l, uvec2(1));
        first += s.x * s.y;
    }
    size = ivec2(max(t.size >> level, uvec2(1)));
    return first;
}

vec3 surface_texture_level(const surface_texture t, vec2 uv, uint level)
{
    ivec2 size;
    uint first = surface_level(t, level, size);
    vec2 p = uv * vec2(size) - 0.5;
    ivec2 i = ivec2(floor(p));
    vec2 w = p - vec2(i);
    vec3 top = mix(surface_texel(first, size, t.wrap, i),
                   surface_texel(first, size, t.wrap, i + ivec2(1, 0)), w.x);
    vec3 bottom = mix(surface_texel(first, size, t.wrap, i + ivec2(0, 1)),
                      surface_texel(first, size, t.wrap, i + ivec2(1, 1)), w.x);
    return mix(top, bottom, w.y);
}

// The texture around `uv`; a step of the sample grid moves by `dx` and `dy` on it.
vec3 surface_texture_around(uint index, vec2 uv, vec2 dx, vec2 dy)
{
    surface_texture t = surface_texture_at(index);
    vec2 a = dx * vec2(t.size), b = dy * vec2(t.size);
    float lod = 0.5 * log2(max(max(dot(a, a), dot(b, b)), 1.0));
    lod = min(lod, float(t.levels - 1u));
    uint level = uint(lod);
    vec3 c = surface_texture_level(t, uv, level);
    float more = lod - float(level);
    return more > 0.0 ? mix(c, surface_texture_level(t, uv, level + 1u), more) : c;
}

#ifdef GEOMETRY_AT
// The mean colour of a triangle's material, 1 without a texture, over a square of `area` (m^2) of the surface around a place.
// `barycentric`: weights of the second and third corner there.
vec3 surface_colour_over(uvec4 triangle, vec2 barycentric, float area)
{
    uint texture_of = surface_material_at(triangle.w).texture;
    if (texture_of == TYN_SURFACE_NO_TEXTURE) {
        return vec3(1.0);
    }
    vec3 a = surface_position(triangle.x), b = surface_position(triangle.y), c = surface_position(triangle.z);
    mat3x2 uv = surface_uvs(triangle);
    float scale = sqrt(abs(determinant(mat2(uv[1], uv[2]))) / max(length(cross(b - a, c - a)), 1e-30) * area);
    return surface_texture_around(texture_of, uv[0] + barycentric.x * uv[1] + barycentric.y * uv[2], vec2(scale, 0.0),
                                  vec2(0.0, scale));
}
#endif

#endif
