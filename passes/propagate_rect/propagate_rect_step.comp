// propagate_rect_step.comp -- one iteration: every cell gathers from its six neighbours (Eqs 2-6) and
// adds what it now sends to the eye (Eqs 7-8).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "propagate.glsl"
#include "propagate_rect_args.h"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
layout(set = 0, binding = 0, scalar) readonly buffer grids_buffer { propagate_grid grids[]; };
layout(set = 0, binding = 1, scalar) uniform camera_uniform { camera_block camera; };
layout(set = 0, binding = 2) uniform sampler3D cells;
layout(set = 0, binding = 3) uniform sampler3D in_state;
layout(set = 0, binding = 4) uniform sampler3D in_seen;
layout(set = 0, binding = 5, rgba32f) uniform writeonly image3D out_state;
layout(set = 0, binding = 6, r32f) uniform writeonly image3D out_seen;
layout(push_constant, scalar) uniform push { propagate_rect_args args; };

const ivec3 neighbour[6] = ivec3[](ivec3(0, 0, -1), ivec3(0, 0, 1), ivec3(-1, 0, 0), ivec3(1, 0, 0),
                                   ivec3(0, -1, 0), ivec3(0, 1, 0));

void main()
{
    ivec3 texel = ivec3(gl_GlobalInvocationID);
    uint stack = uint(texel.z) / args.cells; // light and channel
    ivec3 cell = ivec3(texel.xy, uint(texel.z) % args.cells);
    if (any(greaterThanEqual(uvec2(texel.xy), uvec2(args.cells))) ||
        stack >= args.num_suns * args.channels) {
        return;
    }
    propagate_grid grid = grids[stack / args.channels];
    float light = 0.0, spread = 0.0, seen = 0.0;
    if (propagate_inside(grid, cell)) {
        vec4 here = texelFetch(cells, texel, 0);
        for (int n = 0; n < 6; n++) {
            if (!propagate_inside(grid, cell + neighbour[n])) {
                continue; // vacuum beyond the grid: nothing comes in
            }
            vec4 state = texelFetch(in_state, texel + neighbour[n], 0);
            vec4 there = texelFetch(cells, texel + neighbour[n], 0);
            vec4 hop = 0.5 * (here + there) * grid.cell; // depths: half the way in either cell
            float moved = propagate_part(state, -neighbour[n].z) * exp(-hop.y);
            light += moved;
            spread += moved * (state.y + (1.0 - state.y) * propagate_loss(hop.w));
        }
        seen = texelFetch(in_seen, texel, 0).r;
        spread = light > 0.0 ? spread / light : 1.0;
        vec3 p = propagate_to_m(grid, vec3(cell) + 0.5);
        float mu = dot(grid.direction, propagate_to_eye(camera, p));
        seen += light * propagate_towards_eye(mu, 1.0 - spread, here.z, args.last_event != 0u);
    }
    imageStore(out_state, texel, propagate_state(light, spread));
    imageStore(out_seen, texel, vec4(seen, 0.0, 0.0, 0.0));
}
