// shape_colors.glsl -- where a shape's grids of colours are in their atlas. Include after shaders/common/scene_args.h.
#ifndef TYN_SHAPE_COLORS_GLSL
#define TYN_SHAPE_COLORS_GLSL

bool shape_has_color(const shape_block shape, uint which)
{
    return shape.colors[which].size.x > 0u;
}

// Of a grid (TYN_COLORS_*) at a local position, texels of the atlas; outside the shape its edge.
vec3 shape_colors_texel(const shape_colors c, vec3 local)
{
    vec3 size = vec3(c.size);
    return clamp((local + 0.5) * size, vec3(0.5), size - 0.5) + vec3(0.0, 0.0, float(c.layer));
}

#endif
