// importance_step.comp -- one iteration: every cell gathers from its six neighbours (Elek et al. 2014,
// Eqs 2-6). Cells hold power, so the growing width of the columns needs no account.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "propagate.glsl"
#include "importance_args.h"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
layout(set = 0, binding = 0, scalar) readonly buffer cells_buffer { importance_cell cells[]; };
layout(set = 0, binding = 1, scalar) readonly buffer in_buffer { vec4 in_state[]; };
layout(set = 0, binding = 2, scalar) writeonly buffer out_buffer { vec4 out_state[]; };
layout(set = 0, binding = 3, scalar) buffer tracks_buffer { vec2 tracks[]; };
layout(push_constant, scalar) uniform push { importance_args args; };

const ivec3 neighbour[6] = ivec3[](ivec3(0, 0, -1), ivec3(0, 0, 1), ivec3(-1, 0, 0), ivec3(1, 0, 0),
                                   ivec3(0, -1, 0), ivec3(0, 1, 0));

void main()
{
    ivec3 cell = ivec3(gl_GlobalInvocationID);
    const int n = int(args.cells);
    if (any(greaterThanEqual(cell, ivec3(n)))) {
        return;
    }
    const int index = (cell.z * n + cell.y) * n + cell.x;
    importance_cell here = cells[index];
    float power = 0.0, spread = 0.0;
    for (int i = 0; i < 6; i++) {
        ivec3 from = cell + neighbour[i];
        bool inside = all(greaterThanEqual(from, ivec3(0))) && all(lessThan(from, ivec3(n)));
        int source = inside ? index + (neighbour[i].z * n + neighbour[i].y) * n + neighbour[i].x : index;
        vec4 state = in_state[source];
        importance_cell there = cells[source];
        // Half the way in either cell.
        float here_length = 0.5 * (i < 2 ? here.along : here.across);
        float there_length = 0.5 * (i < 2 ? there.along : there.across);
        float absorbed = here.sigma_a * here_length + there.sigma_a * there_length;
        float turned = here.decay * here_length + there.decay * there_length;
        float moved = inside ? propagate_part(state, -neighbour[i].z) * exp(-absorbed) : 0.0;
        power += moved;
        spread += moved * (state.y + (1.0 - state.y) * propagate_loss(turned));
    }
    vec4 state = propagate_state(power, power > 0.0 ? spread / power : 1.0);
    out_state[index] = state;
    // Half a hop in and half a hop out.
    float way = power * mix(here.along, here.across, 4.0 * state.z);
    tracks[index] += vec2(way, way * state.y);
}
