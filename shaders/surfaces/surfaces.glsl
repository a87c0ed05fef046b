// surfaces.glsl -- the surfaces of the scene.
//
// Define GEOMETRY_AT as the first binding of the bundle TYN_GEOMETRY (bundles.h), or MATERIALS_AT as that of
// TYN_MATERIALS (reflectance.glsl has what reads materials), or both. The structs of surface_args.h are read as rows of
// four: a CPU device reads a vector per lane in little more than the time of a number.
#ifndef TYN_SURFACES_GLSL
#define TYN_SURFACES_GLSL
#include "surface_args.h"

#ifdef GEOMETRY_AT
layout(set = 0, binding = GEOMETRY_AT, scalar) uniform surfaces_uniform
{
    surface_block surfaces;
};
layout(set = 0, binding = GEOMETRY_AT + 1, scalar) readonly buffer vertices_buffer
{
    vec4 vertex_rows[]; // position, u; normal, v
};
layout(set = 0, binding = GEOMETRY_AT + 2, scalar) readonly buffer triangles_buffer
{
    uvec4 triangles[]; // corners, material
};
layout(set = 0, binding = GEOMETRY_AT + 3, scalar) readonly buffer nodes_buffer
{
    uvec4 nodes[];
};

vec3 surface_position(uint vertex)
{
    return vertex_rows[2u * vertex].xyz;
}

vec2 surface_uv(uint vertex)
{
    return vec2(vertex_rows[2u * vertex].w, vertex_rows[2u * vertex + 1u].w);
}

// Texture coordinates of a triangle's first corner, and of the others from there.
mat3x2 surface_uvs(uvec4 triangle)
{
    vec2 first = surface_uv(triangle.x);
    return mat3x2(first, surface_uv(triangle.y) - first, surface_uv(triangle.z) - first);
}
#endif
#ifdef MATERIALS_AT
layout(set = 0, binding = MATERIALS_AT, scalar) readonly buffer materials_buffer
{
    uvec4 material_rows[]; // albedo, flags; emission, texture
};
layout(set = 0, binding = MATERIALS_AT + 1, scalar) readonly buffer textures_buffer
{
    surface_texture textures[];
};
layout(set = 0, binding = MATERIALS_AT + 2, scalar) readonly buffer texels_buffer
{
    uint texels[];
};
#endif

#endif
