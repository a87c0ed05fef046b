// shadow_map_vertex.vert -- the corners of the scene's triangles as a light sees them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/surfaces/surface_args.h"
#include "shaders/light/shadow_args.h"

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
    shadow_map_args args;
};

void main()
{
    surface_triangle t = triangles[gl_VertexIndex / 3];
    int corner = gl_VertexIndex % 3;
    uint v = corner == 0 ? t.v0 : corner == 1 ? t.v1 : t.v2;
    vec4 p = vec4(vertices[v].position, 1.0);
    gl_Position = vec4(dot(args.clip[0], p), dot(args.clip[1], p), dot(args.clip[2], p),
                       dot(args.clip[3], p));
}
