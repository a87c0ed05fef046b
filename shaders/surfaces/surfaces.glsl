// surfaces.glsl -- the surfaces of the scene.
//
// Define GEOMETRY_AT as the first binding of the bundle TYN_GEOMETRY (bundles.h), or MATERIALS_AT as that of
// TYN_MATERIALS (reflectance.glsl has what reads materials), or both. The structs of surface_args.h are read as rows of
// four: a CPU device reads a vector per lane in little more than the time of a number.
#ifndef TYN_SURFACES_GLSL
#define TYN_SURFACES_GLSL
#include "surface_args.h"

#ifdef GEOMETRY_AT
TYN_UNIFORM(GEOMETRY_AT, surfaces, surface_block surfaces);
TYN_READ(GEOMETRY_AT + 1, vertices, vec4 vertex_rows[]); // position, u; normal, v
TYN_READ(GEOMETRY_AT + 2, triangles, uvec4 triangles[]); // corners, material
TYN_READ(GEOMETRY_AT + 3, nodes, uvec4 nodes[]);

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
TYN_READ(MATERIALS_AT, materials, uvec4 material_rows[]); // albedo, flags; emission, texture
TYN_READ(MATERIALS_AT + 1, textures, surface_texture textures[]);
TYN_READ(MATERIALS_AT + 2, texels, uint texels[]);
#endif

#endif
