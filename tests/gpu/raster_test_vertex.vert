// raster_test_vertex.vert -- triangles pulled from a buffer, moved and coloured by push constants.
#version 460
#extension GL_EXT_scalar_block_layout : require
struct corner {
    vec3 position; // clip space with w = 1
    vec3 color;
};
layout(set = 0, binding = 0, scalar) readonly buffer corners_buffer
{
    corner corners[];
};
layout(push_constant, scalar) uniform args_block
{
    vec2 shift;
    float brightness;
}
args;
layout(location = 0) out vec3 color;

void main()
{
    corner c = corners[gl_VertexIndex];
    gl_Position = vec4(c.position + vec3(args.shift, 0.0), 1.0);
    color = c.color * args.brightness;
}
