// walls_texture.glsl -- mean colour of a surface around a point. Include with the buffers textures, texels.
#ifndef TYN_WALLS_TEXTURE_GLSL
#define TYN_WALLS_TEXTURE_GLSL

float walls_linear(float srgb)
{
    return srgb <= 0.04045 ? srgb / 12.92 : pow((srgb + 0.055) / 1.055, 2.4);
}

// `texels_per_area`: of level 0 within the area to be averaged over.
vec3 walls_texture(uint index, vec2 uv, float texels_per_area)
{
    surface_texture t = textures[index];
    int level = clamp(int(0.5 * log2(max(texels_per_area, 1.0)) + 0.5), 0, int(t.levels) - 1);
    uint first = t.first;
    for (int l = 0; l < level; l++) {
        uvec2 s = max(t.size >> l, uvec2(1));
        first += s.x * s.y;
    }
    uvec2 size = max(t.size >> level, uvec2(1));
    for (int a = 0; a < 2; a++) {
        float m = uv[a] - 2.0 * floor(0.5 * uv[a]);
        uv[a] = t.wrap[a] == 0u ? fract(uv[a]) : t.wrap[a] == 1u ? clamp(uv[a], 0.0, 1.0) : min(m, 2.0 - m);
    }
    uvec2 at = min(uvec2(uv * vec2(size)), size - 1u);
    vec3 c = unpackUnorm4x8(texels[first + at.y * size.x + at.x]).rgb;
    return vec3(walls_linear(c.r), walls_linear(c.g), walls_linear(c.b));
}

#endif
