// propagate_radial_step.comp -- one iteration: every cell gathers from its six neighbours (Eqs 2-6) and adds
// what it now sends to the eye (Eqs 7-8).
#include "../common/propagate_radial.glsl"
#include "propagate_radial_args.h"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
layout(constant_id = 0) const uint shadowed = 0u; // 1: surfaces stop light
TYN_READ(0, grids, propagate_radial_grid grids[]);
TYN_READ(1, map, vec2 map[]);
TYN_READ(2, cells, vec4 cells[]);
TYN_READ(3, state_other, vec4 in_state[]);
TYN_WRITE(4, state, vec4 out_state[]);
TYN_UPDATE(5, sum, float sum[]);
TYN_READ(6, lit, float lit[]);
TYN_ARGS(propagate_radial_args args);

// Cells side by side are of unequal size. If each sent the same share of its light to the other, the larger
// would lose light that is the same everywhere. So they exchange as much as the smaller one sends, and what
// else the larger one would send stays there.

// Light that comes to the cell's faces, and its share of the spread.
void add(inout vec2 light, float power, float spread)
{
    light += power * vec2(1.0, spread);
}

void main()
{
    uint groups = propagate_groups(args.layers, PROPAGATE_RADIAL_GROUP);
    uint stack = gl_WorkGroupID.z / groups, n = args.first + stack / args.channels;
    ivec3 cell = ivec3(gl_GlobalInvocationID.xy,
                       gl_GlobalInvocationID.z - stack * groups * PROPAGATE_RADIAL_GROUP);
    if (any(greaterThanEqual(uvec3(cell), uvec3(args.cells, args.cells, args.layers)))) {
        return;
    }
    int side = int(args.cells);
    uint layer = args.cells * args.cells, base = n * layer;
    uint q = propagate_radial_index(cell, stack, args.cells, args.layers);
    propagate_cell here = propagate_cell_of(cells[q]);
    float solid_angle = map[base + uint(cell.y * side + cell.x)].y, growth = grids[n].growth;
    float flatter = args.narrowing != 0u ? growth * growth : 1.0;
    bool spacing = args.scale == TYN_PROPAGATE_SCALE_SPACING;
    float smaller = args.scale == TYN_PROPAGATE_SCALE_RECIPROCAL ? 1.0 / (growth * growth) : 1.0;
    if (here.mu >= -1.5) {
        vec2 light = vec2(0.0);
        float times = 1.0; // how often the light goes through the cell
        if (cell.z == 0) {
            ivec2 across = propagate_radial_across(cell.xy, side);
            uint there = propagate_radial_index(ivec3(across, 0), stack, args.cells, args.layers);
            if (args.layers > 1u) {
                vec4 shell = in_state[there + layer];
                propagate_cell near = propagate_cell_of(cells[there]); // the half of the ball that comes first
                // The light's a, about the direction in which it goes now.
                float spread = propagate_more_spread(near, min(shell.w, 2.0 - shell.w), args.rate);
                light = shell.z * smaller * propagate_kept(near) * vec2(1.0, spread);
            }
            times = 2.0; // once on either side of the light
        } else {
            // Outwards, from a cell further in; then inwards. In units of power the growth of the area is in;
            // in those of radiance the paper's factor is that of the spacing instead.
            float stays = 0.0;
            vec4 mine = in_state[q], inner = in_state[q - layer];
            if (shadowed != 0u) {
                inner.x *= lit[propagate_radial_index(cell, stack / args.channels, args.cells, args.layers)];
            }
            add(light, inner.x * (spacing && cell.z > 1 ? growth : 1.0),
                cell.z > 1 ? inner.w / flatter : inner.w);
            if (cell.z + 1 < int(args.layers)) {
                vec4 outer = in_state[q + layer];
                add(light, outer.z * (spacing ? 1.0 / growth : smaller), min(outer.w * flatter, 2.0));
            }
            for (int s = 0; s < 4; s++) {
                int by = s < 2 ? -1 : 1;
                ivec2 t = octahedral_fold(cell.xy + ((s & 1) == 0 ? ivec2(by, 0) : ivec2(0, by)), side);
                vec4 beside = in_state[propagate_radial_index(ivec3(t, cell.z), stack, args.cells, args.layers)];
                float larger = solid_angle / map[base + uint(t.y * side + t.x)].y;
                add(light, beside.y * (spacing ? larger : min(larger, 1.0)), beside.w);
                stays += spacing ? 0.0 : max(1.0 - 1.0 / larger, 0.0);
            }
            // The rest of what would go to smaller cells.
            add(light, mine.y * stays + mine.z * (spacing ? 0.0 : 1.0 - smaller), mine.w);
            float spread = light.x > 0.0 ? clamp(light.y / light.x, 0.0, 2.0) : 1.0;
            light.x *= propagate_kept(here);
            light.y = light.x * propagate_more_spread(here, spread, args.rate);
        }
        float spread = light.x > 0.0 ? clamp(light.y / light.x, 0.0, 2.0) : 1.0;
        sum[q] += times / solid_angle * light.x *
                  propagate_towards_eye(here.mu, 1.0 - spread, here.g, args.last_event != 0u);
        out_state[q] = propagate_radial_outgoing(here, cell.z == 0, light.x, spread, args.rate);
    }
}
