// propagate_rect_start.comp -- the light before the first iteration (section 4.1): one thread marches a
// column of cells along the light.
#include "../common/propagate.glsl"
#include "propagate_rect_args.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const uint init = TYN_PROPAGATE_INIT_ENTRY;
layout(constant_id = 1) const uint shadowed = 0u; // 1: surfaces stop light
layout(constant_id = 2) const uint stretched = 0u; // 1: cells need not be cubes
TYN_READ(0, grids, propagate_grid grids[]);
TYN_READ(1, cells, vec4 cells[]);
TYN_WRITE(2, state, vec4 out_state[]);
TYN_WRITE(3, state_other, vec4 out_other[]);
TYN_WRITE(4, sum, float out_sum[]);
TYN_READ(5, lit, float lit[]);
TYN_WRITE(6, beside, float out_beside[]);
TYN_WRITE(7, beside_other, float out_beside_other[]);
TYN_ARGS(propagate_rect_args args);

// Mean of exp(-tau) over a depth, (1 - e^-tau) / tau.
float mean_transmittance(float tau)
{
    return tau > 1e-20 ? propagate_loss(tau) / tau : 1.0;
}

void main()
{
    ivec2 column = ivec2(gl_GlobalInvocationID.xy);
    uint stack = gl_WorkGroupID.z; // grid of this batch and channel
    if (any(greaterThanEqual(uvec2(column), uvec2(args.cells)))) {
        return;
    }
    propagate_grid grid = grids[args.first + stack / args.channels];
    float mean_cosine = grid.mean_cosine, stretch = stretched != 0u ? propagate_stretch(grid) : 1.0;
    float arrives = 1.0; // past surfaces
    float depth = 0.0; // optical, from where the light enters to the face of the cell
    for (int z = 0; z < int(args.along); z++) {
        uint q = propagate_index(ivec3(column, z), stack, args.cells, args.along);
        propagate_cell here = propagate_cell_of(cells[q]);
        float light = 0.0, spread = 1.0 - mean_cosine, seen = 0.0;
        if (shadowed != 0u) {
            arrives *= lit[propagate_index(ivec3(column, z), stack / args.channels, args.cells, args.along)];
        }
        if (here.mu >= -1.5) {
            float tau = (init == TYN_PROPAGATE_INIT_ABSORPTION ? 0.0 : here.sigma_s) + here.sigma_a;
            float beam = arrives * exp(-depth) * mean_transmittance(tau);
            if (init == TYN_PROPAGATE_INIT_ENTRY) {
                light = z == 0 ? arrives : 0.0;
            } else if (init == TYN_PROPAGATE_INIT_FIRST_COLLISION) {
                // The beam is not in the grid: what it scatters is. Its own scattering towards the eye,
                // and that of half of what scattered in this very cell, is seen from here.
                light = beam * here.sigma_s;
                spread = 1.0 - here.g * mean_cosine;
                float way = 0.5 * light;
                if (stretched != 0u) {
                    way *= propagate_way(propagate_state(light, spread, grid.cone), stretch);
                }
                seen = beam * propagate_towards_eye(here.mu, mean_cosine, here.g, true) +
                       way * propagate_towards_eye(here.mu, 1.0 - spread, here.g,
                                                           args.last_event != 0u);
            } else {
                light = beam;
            }
            depth += tau;
        }
        if (stretched != 0u) {
            float beside;
            vec4 state = propagate_state(light, spread, grid.cone);
            out_state[q] = propagate_outgoing_stretched(here, stretch, state, args.rate, beside);
            out_beside[q] = beside;
        } else {
            out_state[q] = propagate_outgoing(here, light, spread, args.rate);
        }
        out_sum[q] = seen;
        if (here.mu < -1.5) {
            out_other[q] = vec4(0.0); // no iteration writes there
            if (stretched != 0u) {
                out_beside_other[q] = 0.0;
            }
        }
    }
}
