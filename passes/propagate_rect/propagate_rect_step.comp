// propagate_rect_step.comp -- one iteration: every cell gathers from its six neighbours (Eqs 2-6) and
// adds what it now sends to the eye (Eqs 7-8).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/beams/propagate.glsl"
#include "propagate_rect_args.h"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
layout(constant_id = 0) const uint shadowed = 0u; // 1: surfaces stop light
TYN_READ(0, cells, vec4 cells[]);
TYN_READ(1, state_other, vec4 in_state[]);
TYN_WRITE(2, state, vec4 out_state[]);
TYN_UPDATE(3, sum, float sum[]);
TYN_READ(4, lit, float lit[]);
TYN_ARGS(propagate_rect_args args);

// Light that a neighbour sends and its share of the spread. `part`: of propagate_outgoing, which way.
vec2 from(uint q, int step, bool there, int part)
{
    vec4 state = in_state[there ? q + uint(step) : q];
    return there ? vec2(state[part], state[part] * state.w) : vec2(0.0);
}

void main()
{
    uint groups = propagate_groups(args.cells, PROPAGATE_RECT_GROUP);
    uint stack = gl_WorkGroupID.z / groups; // grid of this batch and channel
    ivec3 cell = ivec3(gl_GlobalInvocationID.xy,
                       gl_GlobalInvocationID.z - stack * groups * PROPAGATE_RECT_GROUP);
    int last = int(args.cells) - 1, row = int(args.cells), layer = row * row;
    if (any(greaterThan(cell, ivec3(last)))) {
        return;
    }
    uint q = propagate_index(cell, stack, args.cells);
    propagate_cell here = propagate_cell_of(cells[q]);
    if (here.mu >= -1.5) {
        // Beyond the grid is vacuum: nothing comes in.
        vec2 ahead = from(q, -layer, cell.z > 0, 0);
        if (shadowed != 0u) {
            ahead *= lit[propagate_index(cell, stack / args.channels, args.cells)];
        }
        vec2 light = ahead + from(q, layer, cell.z < last, 2) +
                     from(q, -1, cell.x > 0, 1) + from(q, 1, cell.x < last, 1) +
                     from(q, -row, cell.y > 0, 1) + from(q, row, cell.y < last, 1);
        float spread = light.x > 0.0 ? light.y / light.x : 1.0;
        spread = propagate_more_spread(here, spread, args.rate);
        light.x *= propagate_kept(here);
        sum[q] += light.x * propagate_towards_eye(here.mu, 1.0 - spread, here.g, args.last_event != 0u);
        out_state[q] = propagate_outgoing(here, light.x, spread, args.rate);
    }
}
