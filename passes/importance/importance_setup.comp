// importance_setup.comp -- places the grid.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "importance.glsl"

layout(local_size_x = 1) in;
layout(set = 0, binding = 0, scalar) uniform medium_uniform { medium_block medium; };
layout(set = 0, binding = 1, scalar) uniform camera_uniform { camera_block camera; };
layout(set = 0, binding = 2, scalar) writeonly buffer grid_buffer { importance_grid grid; };
layout(push_constant, scalar) uniform push { importance_args args; };

void main()
{
    grid = importance_grid_of(camera, medium.extent);
}
