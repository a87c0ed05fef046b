// propagate_rect_setup.comp -- places the grid of each light.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "propagate.glsl"
#include "propagate_rect_args.h"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) uniform medium_uniform { medium_block medium; };
layout(set = 0, binding = 1, scalar) readonly buffer lights_buffer { light_block lights[]; };
layout(set = 0, binding = 2, scalar) writeonly buffer grids_buffer { propagate_grid grids[]; };
layout(push_constant, scalar) uniform push { propagate_rect_args args; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i < args.num_suns) {
        grids[i] = propagate_grid_of(medium.extent, lights[i], i, args.cells, args.channels);
    }
}
