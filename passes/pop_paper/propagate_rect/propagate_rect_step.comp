// propagate_rect_step.comp -- one iteration: every cell gathers from its six neighbours (Eqs 2-6) and
// adds what it now sends to the eye (Eqs 7-8).
#include "../common/propagate.glsl"
#include "propagate_rect_args.h"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
layout(constant_id = 0) const uint shadowed = 0u; // 1: surfaces stop light
layout(constant_id = 1) const uint stretched = 0u; // 1: cells need not be cubes
layout(constant_id = 2) const uint stops = 0u; // 1: iterations end where little light is left
TYN_READ(0, cells, vec4 cells[]);
TYN_READ(1, state_other, vec4 in_state[]);
TYN_WRITE(2, state, vec4 out_state[]);
TYN_UPDATE(3, sum, float sum[]);
TYN_READ(4, lit, float lit[]);
TYN_READ(5, grids, propagate_grid grids[]);
TYN_READ(6, beside_other, float in_beside[]);
TYN_WRITE(7, beside, float out_beside[]);
TYN_UPDATE(8, flight, uint flight[]);
TYN_ARGS(propagate_rect_args args);

// Light that a neighbour sends and its share of the spread. `part`: of propagate_outgoing, which way.
vec2 from(uint q, int step, bool there, int part)
{
    uint p = there ? q + uint(step) : q;
    vec4 state = in_state[p];
    float spread = stretched != 0u && part == 1 ? in_beside[p] : state.w;
    return there ? vec2(state[part], state[part] * spread) : vec2(0.0);
}

// One cell; returns its light.
float step_cell(ivec3 cell, uint stack, uint q)
{
    int last = int(args.cells) - 1, end = int(args.along) - 1, row = int(args.cells), layer = row * row;
    propagate_cell here = propagate_cell_of(cells[q]);
    if (here.mu < -1.5) {
        return 0.0;
    }
    // Beyond the grid is vacuum: nothing comes in.
    vec2 ahead = from(q, -layer, cell.z > 0, 0);
    if (shadowed != 0u) {
        ahead *= lit[propagate_index(cell, stack / args.channels, args.cells, args.along)];
    }
    vec2 along = ahead + from(q, layer, cell.z < end, 2);
    vec2 side_0 = from(q, -1, cell.x > 0, 1), side_1 = from(q, 1, cell.x < last, 1);
    vec2 side_2 = from(q, -row, cell.y > 0, 1), side_3 = from(q, row, cell.y < last, 1);
    vec2 light = along + side_0 + side_1 + side_2 + side_3;
    float spread, seen; // `seen`: the light, times the length of its way through the cell in edges along d
    float cone = PROPAGATE_CONE, stretch = 1.0;
    if (stretched != 0u) {
        propagate_grid grid = grids[args.first + stack / args.channels];
        cone = grid.cone;
        stretch = propagate_stretch(grid);
    }
    if (stretch == 1.0) {
        spread = light.x > 0.0 ? light.y / light.x : 1.0;
        spread = propagate_more_spread(here, spread, args.rate);
        light.x *= propagate_kept(here);
        seen = light.x;
    } else {
        vec2 across = propagate_arrived(propagate_sideways(here, stretch), side_0 + side_1 + side_2 + side_3, args.rate);
        along = propagate_arrived(here, along, args.rate);
        light = along + across;
        spread = light.x > 0.0 ? light.y / light.x : 1.0;
        seen = 0.5 * (along.x + stretch * across.x); // half a hop in, and half a hop out:
        seen += 0.5 * light.x * propagate_way(propagate_state(light.x, spread, cone), stretch);
    }
    sum[q] += seen * propagate_towards_eye(here.mu, 1.0 - spread, here.g, args.last_event != 0u);
    if (stretched != 0u) {
        float beside;
        vec4 state = propagate_state(light.x, spread, cone);
        out_state[q] = propagate_outgoing_stretched(here, stretch, state, args.rate, beside);
        out_beside[q] = beside;
    } else {
        out_state[q] = propagate_outgoing(here, light.x, spread, args.rate);
    }
    return light.x;
}

void main()
{
    uint groups = propagate_groups(args.along, PROPAGATE_RECT_GROUP);
    uint stack = gl_WorkGroupID.z / groups; // grid of this batch and channel
    ivec3 cell = ivec3(gl_GlobalInvocationID.xy,
                       gl_GlobalInvocationID.z - stack * groups * PROPAGATE_RECT_GROUP);
    bool within = all(lessThan(uvec3(cell), uvec3(args.cells, args.cells, args.along)));
    uint q = propagate_index(cell, stack, args.cells, args.along);
    if (!within) {
        return;
    }
    float light = step_cell(cell, stack, q);
    if (stops != 0u) {
        vec3 irradiance = max(grids[args.first + stack / args.channels].irradiance, vec3(0.0));
        float unit = args.channels == 1u ? max(irradiance.r, max(irradiance.g, irradiance.b))
                                         : irradiance[stack % args.channels];
        uint bits = floatBitsToUint(unit * light), word = propagate_flight_word(args.flight, args.iteration);
        if (bits > flight[word]) { // it only grows: an old value costs an atomic operation that changes nothing
            atomicMax(flight[word], bits);
        }
    }
}
