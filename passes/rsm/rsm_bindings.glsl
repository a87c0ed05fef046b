// rsm_bindings.glsl -- what both shaders of reflective shadow maps read.
#include "scene_args.h"
#include "surface_args.h"
#include "rsm_draw_args.h"

layout(set = 0, binding = 0, scalar) uniform surfaces_buffer
{
    surface_block surfaces;
};
layout(set = 0, binding = 1, scalar) readonly buffer triangles_buffer
{
    surface_triangle triangles[];
};
layout(set = 0, binding = 2, scalar) readonly buffer vertices_buffer
{
    surface_vertex vertices[];
};
layout(push_constant, scalar) uniform args_block
{
    rsm_draw_args args;
};

vec3 to_m(vec3 v)
{
    return vec3(dot(surfaces.from_world[0].xyz, v), dot(surfaces.from_world[1].xyz, v),
                dot(surfaces.from_world[2].xyz, v));
}
