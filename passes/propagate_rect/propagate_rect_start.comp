// propagate_rect_start.comp -- the light before the first iteration (section 4.1): one thread marches a
// column of cells along the light.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "propagate.glsl"
#include "propagate_rect_args.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const uint init = TYN_PROPAGATE_INIT_ENTRY;
layout(set = 0, binding = 0, scalar) readonly buffer grids_buffer { propagate_grid grids[]; };
layout(set = 0, binding = 1, scalar) uniform camera_uniform { camera_block camera; };
layout(set = 0, binding = 2) uniform sampler3D cells;
layout(set = 0, binding = 3, rgba32f) uniform writeonly image3D out_state;
layout(set = 0, binding = 4, r32f) uniform writeonly image3D out_seen;
layout(push_constant, scalar) uniform push { propagate_rect_args args; };

// Mean of exp(-tau) over a depth, (1 - e^-tau) / tau.
float mean_transmittance(float tau)
{
    return tau > 1e-20 ? propagate_loss(tau) / tau : 1.0;
}

void main()
{
    ivec2 column = ivec2(gl_GlobalInvocationID.xy);
    uint stack = gl_GlobalInvocationID.z; // light and channel
    if (any(greaterThanEqual(uvec2(column), uvec2(args.cells))) ||
        stack >= args.num_suns * args.channels) {
        return;
    }
    propagate_grid grid = grids[stack / args.channels];
    float depth = 0.0; // optical, from where the light enters to the face of the cell
    for (int z = 0; z < int(args.cells); z++) {
        ivec3 texel = ivec3(column, int(stack * args.cells) + z);
        float light = 0.0, spread = 0.0, seen = 0.0;
        if (propagate_inside(grid, ivec3(column, z))) {
            vec4 here = texelFetch(cells, texel, 0);
            float sigma_s = here.x, sigma_a = here.y, g = here.z;
            float tau = (init == TYN_PROPAGATE_INIT_ABSORPTION ? sigma_a : sigma_s + sigma_a) * grid.cell;
            float beam = exp(-depth) * mean_transmittance(tau);
            if (init == TYN_PROPAGATE_INIT_ENTRY) {
                light = z == 0 ? 1.0 : 0.0;
            } else if (init == TYN_PROPAGATE_INIT_FIRST_COLLISION) {
                // The beam is not in the grid: what it scatters is. Its own scattering towards the eye,
                // and that of half of what scattered in this very cell, is seen from here.
                light = beam * sigma_s * grid.cell;
                spread = 1.0 - g;
                vec3 p = propagate_to_m(grid, vec3(column, z) + 0.5);
                float mu = dot(grid.direction, propagate_to_eye(camera, p));
                seen = beam * propagate_towards_eye(mu, 1.0, g, true) +
                       0.5 * light * propagate_towards_eye(mu, g, g, args.last_event != 0u);
            } else {
                light = beam;
            }
            depth += tau;
        }
        imageStore(out_state, texel, propagate_state(light, spread));
        imageStore(out_seen, texel, vec4(seen, 0.0, 0.0, 0.0));
    }
}
