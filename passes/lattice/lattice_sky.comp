// lattice_sky.comp -- the environment as the 14 lattice directions see it, first part: lobes.
//
// One workgroup per direction averages the map with a lobe cos^6 about where the light comes from,
// as wide as the directions are apart. Sums have a fixed order.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "environment.glsl"
#include "lattice_args.h"
#include "lattice_sweep.glsl"

layout(local_size_x = LATTICE_SKY_GROUP) in;
layout(binding = 0, scalar) uniform environment_uniform
{
    env_block environment;
};
layout(binding = 1) uniform sampler2D map;
layout(binding = 2, scalar) writeonly buffer sky_buffer
{
    vec3 sky[]; // per direction, W/(m^2 sr)
};

shared vec4 sums[LATTICE_SKY_GROUP]; // radiance, weight

void main()
{
    uint direction = gl_WorkGroupID.x, me = gl_LocalInvocationIndex;
    if (environment.has_map == 0) {
        if (me == 0) {
            sky[direction] = environment.radiance;
        }
        return;
    }
    vec3 from = environment_map_direction(environment, -normalize(vec3(lattice_step(direction))));
    // A bilinear fetch between four texels is their mean.
    uvec2 n = max(environment.size / 2, uvec2(1));
    vec4 sum = vec4(0.0);
    for (uint row = 0; row < n.y; row++) {
        float polar = (float(row) + 0.5) / float(n.y) / TYN_INV_PI;
        for (uint column = me; column < n.x; column += LATTICE_SKY_GROUP) {
            vec2 uv = (vec2(column, row) + 0.5) / vec2(n);
            float azimuth = (uv.x - 0.5) * 2.0 / TYN_INV_PI;
            vec3 d = vec3(sin(polar) * sin(azimuth), cos(polar), -sin(polar) * cos(azimuth));
            float mu = max(dot(d, from), 0.0);
            float weight = mu * mu * mu * mu * mu * mu * sin(polar);
            sum += weight * vec4(textureLod(map, uv, 0.0).rgb, 1.0);
        }
    }
    sums[me] = sum;
    for (uint half_n = LATTICE_SKY_GROUP / 2; half_n > 0; half_n /= 2) {
        barrier();
        if (me < half_n) {
            sums[me] += sums[me + half_n];
        }
    }
    barrier();
    if (me == 0) {
        sky[direction] = environment.radiance * sums[0].rgb / max(sums[0].a, 1e-20);
    }
}
