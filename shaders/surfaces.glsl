// surfaces.glsl -- the surfaces of the scene.
//
// Define GEOMETRY_AT as the first binding of the bundle TYN_GEOMETRY (bundles.h), or MATERIALS_AT as that of
// TYN_MATERIALS, or both. `nodes` hold what surface_trace.glsl reads.
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
    surface_vertex vertices[];
};
layout(set = 0, binding = GEOMETRY_AT + 2, scalar) readonly buffer triangles_buffer
{
    surface_triangle triangles[];
};
layout(set = 0, binding = GEOMETRY_AT + 3, scalar) readonly buffer nodes_buffer
{
    uvec4 nodes[];
};
#endif
#ifdef MATERIALS_AT
layout(set = 0, binding = MATERIALS_AT, scalar) readonly buffer materials_buffer
{
    surface_material materials[];
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
