// gbuffer_bindings.glsl -- what both shaders of the G-buffer read.
#include "camera.glsl"
#include "surface_args.h"

layout(set = 0, binding = 0, scalar) uniform camera_buffer
{
    camera_block camera;
};
layout(set = 0, binding = 1, scalar) uniform surfaces_buffer
{
    surface_block surfaces;
};
vec3 turn(vec4 rows[3], vec3 v)
{
    return vec3(dot(rows[0].xyz, v), dot(rows[1].xyz, v), dot(rows[2].xyz, v));
}

vec3 shift(vec4 rows[3], vec3 p)
{
    return turn(rows, p) + vec3(rows[0].w, rows[1].w, rows[2].w);
}
