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
layout(set = 0, binding = 2) uniform sampler3D cell_sigma_s;
layout(set = 0, binding = 3) uniform sampler3D cell_sigma_a;
layout(set = 0, binding = 4) uniform sampler3D cell_g;
layout(set = 0, binding = 5, rgba32f) uniform writeonly image3D out_light;
layout(set = 0, binding = 6, rgba32f) uniform writeonly image3D out_spread;
layout(set = 0, binding = 7, rgba32f) uniform writeonly image3D out_seen;
layout(push_constant, scalar) uniform push { propagate_rect_args args; };

// Mean of exp(-tau) over a depth, (1 - e^-tau) / tau.
float mean_transmittance(float tau)
{
    return tau > 1e-20 ? propagate_loss(tau) / tau : 1.0;
}

void main()
{
    ivec2 column = ivec2(gl_GlobalInvocationID.xy);
    uint index = gl_GlobalInvocationID.z;
    if (any(greaterThanEqual(uvec2(column), uvec2(args.cells))) || index >= args.num_suns) {
        return;
    }
    propagate_grid grid = grids[index];
    vec3 depth = vec3(0.0); // optical, from where the light enters to the face of the cell
    for (int z = 0; z < int(args.cells); z++) {
        ivec3 texel = ivec3(column, int(grid.first_layer) + z);
        vec3 light = vec3(0.0), spread = vec3(0.0), seen = vec3(0.0);
        if (propagate_inside(grid, ivec3(column, z))) {
            vec3 sigma_s = texelFetch(cell_sigma_s, texel, 0).rgb;
            vec3 sigma_a = texelFetch(cell_sigma_a, texel, 0).rgb;
            vec3 sigma = init == TYN_PROPAGATE_INIT_ABSORPTION ? sigma_a : sigma_s + sigma_a;
            vec3 tau = sigma * grid.cell;
            vec3 beam = grid.irradiance * exp(-depth) *
                        vec3(mean_transmittance(tau.r), mean_transmittance(tau.g), mean_transmittance(tau.b));
            if (init == TYN_PROPAGATE_INIT_ENTRY) {
                light = z == 0 ? grid.irradiance : vec3(0.0);
            } else if (init == TYN_PROPAGATE_INIT_FIRST_COLLISION) {
                // The beam is not in the grid: what it scatters is. Its own scattering towards the eye,
                // and that of half of what scattered in this very cell, is seen from here.
                vec3 g = texelFetch(cell_g, texel, 0).rgb;
                light = beam * sigma_s * grid.cell;
                spread = 1.0 - g;
                vec3 p = propagate_to_m(grid, vec3(column, z) + 0.5);
                float mu = dot(grid.direction, propagate_to_eye(camera, p));
                for (int c = 0; c < 3; c++) {
                    seen[c] = beam[c] * propagate_towards_eye(mu, 1.0, g[c], true) +
                              0.5 * light[c] * propagate_towards_eye(mu, g[c], g[c], args.last_event != 0u);
                }
            } else {
                light = beam;
            }
            depth += tau;
        }
        imageStore(out_light, texel, vec4(light, 0.0));
        imageStore(out_spread, texel, vec4(spread, 0.0));
        imageStore(out_seen, texel, vec4(seen, 0.0));
    }
}
