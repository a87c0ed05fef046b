// surfaces.glsl -- the surfaces of the scene.
//
// Define GEOMETRY_AT as the first binding of the bundle TYN_GEOMETRY (bundles.h), or MATERIALS_AT as that of
// TYN_MATERIALS, or both; SURFACE_ROWS to read the structs as rows of four: a CPU device reads a vector per lane in
// little more than the time of a number. So are `nodes` always, for surface_trace.glsl.
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
#ifdef SURFACE_ROWS
    vec4 vertex_rows[]; // position, u; normal, v
#else
    surface_vertex vertices[];
#endif
};
layout(set = 0, binding = GEOMETRY_AT + 2, scalar) readonly buffer triangles_buffer
{
#ifdef SURFACE_ROWS
    uvec4 triangle_rows[]; // corners, material
#else
    surface_triangle triangles[];
#endif
};
layout(set = 0, binding = GEOMETRY_AT + 3, scalar) readonly buffer nodes_buffer
{
    uvec4 nodes[];
};
#endif
#ifdef MATERIALS_AT
layout(set = 0, binding = MATERIALS_AT, scalar) readonly buffer materials_buffer
{
#ifdef SURFACE_ROWS
    uvec4 material_rows[]; // albedo, flags; emission, texture
#else
    surface_material materials[];
#endif
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
