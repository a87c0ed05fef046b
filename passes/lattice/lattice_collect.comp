// lattice_collect.comp -- moments of the radiance of a sweep, and the source of its diffusion correction.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lattice_args.h"
#include "lattice_sweep.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
layout(push_constant, scalar) uniform push
{
    lattice_args args;
};
layout(binding = 0) uniform sampler3D cells;
layout(binding = 1) uniform sampler3D mean_psi;
layout(binding = 2) uniform sampler3D moments;
layout(binding = 3, rgba32f) uniform writeonly image3D swept;
// The correction solves for what the sweep's change of phi would still set off: its scattering, W.
layout(binding = 4, r32f) uniform writeonly image3D rhs;
layout(binding = 5, r32f) uniform writeonly image3D correction;

void main()
{
    ivec3 texel = ivec3(gl_GlobalInvocationID);
    ivec3 dims = ivec3(args.dims);
    if (any(greaterThanEqual(texel.xy, dims.xy)) || texel.z >= dims.z * int(args.channels)) {
        return;
    }
    float axes = 0.0, diagonals = 0.0;
    vec3 axis_flux = vec3(0.0), diagonal_flux = vec3(0.0);
    for (uint i = 0; i < LATTICE_DIRECTIONS; i++) {
        float psi = texelFetch(mean_psi, texel + ivec3(int(i) * dims.x, 0, 0), 0).r;
        vec3 o = vec3(lattice_step(i));
        if (i < 6) {
            axes += psi;
            axis_flux += psi * o;
        } else {
            diagonals += psi;
            diagonal_flux += psi * o;
        }
    }
    vec4 m = LATTICE_4PI * vec4(LATTICE_WEIGHT_AXIS * axes + LATTICE_WEIGHT_DIAGONAL * diagonals,
                                LATTICE_WEIGHT_AXIS * axis_flux +
                                    LATTICE_WEIGHT_DIAGONAL * inversesqrt(3.0) * diagonal_flux);
    imageStore(swept, texel, m);
    float sigma_s = texelFetch(cells, texel, 0).x, change = m.x - texelFetch(moments, texel, 0).x;
    imageStore(rhs, texel, vec4(args.dx * args.dx * args.dx * sigma_s * change));
    imageStore(correction, texel, vec4(0.0));
}
