// walls_texture.glsl -- mean colour of a surface around a point. Define MATERIALS_AT (surfaces.glsl).
#include "shaders/surfaces/surface_texture.glsl"

// `texels_per_area`: of level 0 within the area to be averaged over.
vec3 walls_texture(uint index, vec2 uv, float texels_per_area)
{
    surface_texture t = surface_texture_at(index);
    int level = clamp(int(0.5 * log2(max(texels_per_area, 1.0)) + 0.5), 0, int(t.levels) - 1);
    ivec2 size;
    uint first = surface_level(t, uint(level), size);
    for (int a = 0; a < 2; a++) {
        float m = uv[a] - 2.0 * floor(0.5 * uv[a]);
        uv[a] = t.wrap[a] == 0u ? fract(uv[a]) : t.wrap[a] == 1u ? clamp(uv[a], 0.0, 1.0) : min(m, 2.0 - m);
    }
    return surface_texel(first, size, uvec2(1u), ivec2(uv * vec2(size))); // held to the last one
}
