// propagate_radial_start.comp -- which cells are in the grid, and the light before the first iteration: one
// thread goes outwards along a direction.
#include "../common/propagate_radial.glsl"
#include "propagate_radial_args.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const uint shadowed = 0u; // 1: surfaces stop light
TYN_READ(0, grids, propagate_radial_grid grids[]);
TYN_READ(1, map, vec2 map[]);
TYN_UPDATE(2, cells, vec4 cells[]);
TYN_WRITE(3, state, vec4 out_state[]);
TYN_WRITE(4, state_other, vec4 out_other[]);
TYN_WRITE(5, sum, float out_sum[]);
TYN_READ(6, lit, float lit[]);
TYN_ARGS(propagate_radial_args args);

// Mean of exp(-tau) over a depth, (1 - e^-tau) / tau.
float mean_transmittance(float tau)
{
    return tau > 1e-20 ? propagate_loss(tau) / tau : 1.0;
}

void main()
{
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    uint stack = gl_WorkGroupID.z, n = args.first + stack / args.channels;
    if (any(greaterThanEqual(uvec2(texel), uvec2(args.cells)))) {
        return;
    }
    vec2 entry = map[n * args.cells * args.cells + uint(texel.y) * args.cells + uint(texel.x)];
    float start = entry.x, solid_angle = entry.y, mean_cosine = grids[n].mean_cosine;
    int first = int(args.layers), last = -1;
    for (int k = 0; k < int(args.layers); k++) {
        vec4 here = cells[propagate_radial_index(ivec3(texel, k), stack, args.cells, args.layers)];
        if (here.w >= -1.5 && here.x + here.y > 0.0) {
            first = min(first, k);
            last = k;
        }
    }
    first = grids[n].inside != 0u ? 0 : first;
    float arrives = 1.0; // past surfaces
    float depth = 0.0; // optical, from the light to the inner face of the cell
    for (int k = 0; k < int(args.layers); k++) {
        uint q = propagate_radial_index(ivec3(texel, k), stack, args.cells, args.layers);
        bool inside = k >= first && k <= last;
        if (shadowed != 0u) {
            arrives *= lit[propagate_radial_index(ivec3(texel, k), stack / args.channels, args.cells, args.layers)];
        }
        vec4 state = vec4(0.0);
        float seen = 0.0;
        if (inside) {
            propagate_cell here = propagate_cell_of(cells[q]);
            float light = k == first ? arrives * start : 0.0, spread = 1.0 - mean_cosine;
            if (args.init == PROPAGATE_RADIAL_INIT_FIRST_COLLISION) {
                // The beam is not in the grid: what it scatters is.
                float part = k == 0 ? 0.5 : 1.0, tau = part * (here.sigma_s + here.sigma_a);
                float beam = arrives * start * exp(-depth) * mean_transmittance(tau);
                light = beam * part * here.sigma_s;
                spread = 1.0 - here.g * mean_cosine;
                seen = beam * propagate_towards_eye(here.mu, mean_cosine, here.g, true) +
                       0.5 * light * propagate_towards_eye(here.mu, 1.0 - spread, here.g,
                                                           args.last_event != 0u);
                depth += tau;
            } else if (k == 0) {
                // No other cell lights the ball: its own beam is seen in it, as that of a shell is when it comes.
                seen = light * propagate_towards_eye(here.mu, mean_cosine, here.g, args.last_event != 0u);
            }
            state = propagate_radial_outgoing(here, k == 0, light, spread, args.rate);
            seen /= solid_angle;
        } else {
            cells[q] = propagate_no_cell;
            out_other[q] = vec4(0.0); // no iteration writes there
        }
        out_state[q] = state;
        out_sum[q] = seen;
    }
}
