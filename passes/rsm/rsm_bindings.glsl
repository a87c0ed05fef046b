// rsm_bindings.glsl -- what both shaders of reflective shadow maps read.
#include "scene_args.h"
#include "surface_args.h"
#include "rsm_draw_args.h"

layout(set = 0, binding = 0, scalar) readonly buffer triangles_buffer
{
    surface_triangle triangles[];
};
layout(set = 0, binding = 1, scalar) readonly buffer vertices_buffer
{
    surface_vertex vertices[];
};
layout(push_constant, scalar) uniform args_block
{
    rsm_draw_args args;
};
