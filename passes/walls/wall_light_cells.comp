// wall_light_cells.comp -- the cells whose walls reflect light: few, so that a list of them keeps all threads of
// wall_light_vpls.comp busy on devices that run them in groups.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "wall_light_args.h"
#include "walls_args.h"

layout(local_size_x = WALL_LIGHT_GROUP) in;
layout(push_constant, scalar) uniform push
{
    wall_light_args args;
};
layout(binding = 0, scalar) readonly buffer cell_buffer
{
    wall_cell wall_cells[];
};
layout(binding = 1, scalar) buffer list_buffer
{
    wall_light_list list;
    uint list_cells[];
};
layout(binding = 2, scalar) writeonly buffer wall_light_buffer
{
    vec3 wall_light[];
};
layout(constant_id = 0) const uint added = 0; // 1: to the suns' light

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i == 0u) {
        list.groups.yz = uvec2(1u);
    }
    if (i >= args.dims.x * args.dims.y * args.dims.z) {
        return;
    }
    if (wall_cells[i].area > 0.0 && wall_cells[i].albedo != vec3(0.0)) {
        uint n = atomicAdd(list.count, 1u);
        list_cells[n] = i;
        atomicMax(list.groups.x, n / WALL_LIGHT_GROUP + 1u);
    } else if (added == 0) {
        wall_light[i] = vec3(0.0);
    }
}
