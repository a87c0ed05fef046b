// propagate_rect_step.comp -- one iteration: every cell gathers from its six neighbours (Eqs 2-6) and
// adds what it now sends to the eye (Eqs 7-8).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "propagate.glsl"
#include "propagate_rect_args.h"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
layout(constant_id = 0) const uint rate = TYN_PROPAGATE_RATE_PAPER;
layout(set = 0, binding = 0, scalar) readonly buffer grids_buffer { propagate_grid grids[]; };
layout(set = 0, binding = 1, scalar) uniform camera_uniform { camera_block camera; };
layout(set = 0, binding = 2) uniform sampler3D cell_sigma_s;
layout(set = 0, binding = 3) uniform sampler3D cell_sigma_a;
layout(set = 0, binding = 4) uniform sampler3D cell_g;
layout(set = 0, binding = 5) uniform sampler3D in_light;
layout(set = 0, binding = 6) uniform sampler3D in_spread;
layout(set = 0, binding = 7) uniform sampler3D in_seen;
layout(set = 0, binding = 8, rgba32f) uniform writeonly image3D out_light;
layout(set = 0, binding = 9, rgba32f) uniform writeonly image3D out_spread;
layout(set = 0, binding = 10, rgba32f) uniform writeonly image3D out_seen;
layout(push_constant, scalar) uniform push { propagate_rect_args args; };

const ivec3 neighbour[6] = ivec3[](ivec3(0, 0, -1), ivec3(0, 0, 1), ivec3(-1, 0, 0), ivec3(1, 0, 0),
                                   ivec3(0, -1, 0), ivec3(0, 1, 0));

void main()
{
    ivec3 texel = ivec3(gl_GlobalInvocationID), cell;
    uint index;
    if (!propagate_cell_of(texel, args.cells, index, cell) || index >= args.num_suns) {
        return;
    }
    propagate_grid grid = grids[index];
    vec3 light = vec3(0.0), spread = vec3(0.0), seen = vec3(0.0);
    if (propagate_inside(grid, cell)) {
        vec3 own_s = texelFetch(cell_sigma_s, texel, 0).rgb;
        vec3 own_a = texelFetch(cell_sigma_a, texel, 0).rgb;
        vec3 own_g = texelFetch(cell_g, texel, 0).rgb;
        for (int n = 0; n < 6; n++) {
            if (!propagate_inside(grid, cell + neighbour[n])) {
                continue; // vacuum beyond the grid: nothing comes in
            }
            ivec3 source = texel + neighbour[n];
            vec3 l = texelFetch(in_light, source, 0).rgb;
            vec3 wide = texelFetch(in_spread, source, 0).rgb;
            vec3 s = texelFetch(cell_sigma_s, source, 0).rgb;
            vec3 scattering = 0.5 * (own_s + s);
            vec3 absorption = 0.5 * (own_a + texelFetch(cell_sigma_a, source, 0).rgb);
            vec3 g = (own_s * own_g + s * texelFetch(cell_g, source, 0).rgb) /
                     max(own_s + s, vec3(1e-30));
            l *= exp(-absorption * grid.cell);
            for (int c = 0; c < 3; c++) {
                float moved = l[c] * propagate_fraction(wide[c], -neighbour[n].z);
                light[c] += moved;
                spread[c] += moved * propagate_scatter(wide[c], g[c], scattering[c] * grid.cell, rate);
            }
        }
        vec3 p = propagate_to_m(grid, vec3(cell) + 0.5);
        float mu = dot(grid.direction, propagate_to_eye(camera, p));
        seen = texelFetch(in_seen, texel, 0).rgb;
        for (int c = 0; c < 3; c++) {
            if (light[c] > 0.0) {
                spread[c] /= light[c];
                seen[c] += light[c] * propagate_towards_eye(mu, 1.0 - spread[c], own_g[c],
                                                            args.last_event != 0u);
            } else {
                light[c] = 0.0;
                spread[c] = 1.0;
            }
        }
    }
    imageStore(out_light, texel, vec4(light, 0.0));
    imageStore(out_spread, texel, vec4(spread, 0.0));
    imageStore(out_seen, texel, vec4(seen, 0.0));
}
