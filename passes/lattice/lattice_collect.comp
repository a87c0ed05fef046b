// lattice_collect.comp -- moments of the radiance of a sweep, and the source of its diffusion
// correction.
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
layout(binding = 1, scalar) readonly buffer mean_buffer
{
    float mean_psi[]; // [direction][channel][cell]
};
layout(binding = 2, scalar) readonly buffer state_buffer
{
    vec4 state[];
};
layout(binding = 3, scalar) writeonly buffer swept_buffer
{
    vec4 swept[];
};
// The correction solves for what the sweep's change of phi would still set off: its scattering, W.
layout(binding = 4, scalar) writeonly buffer rhs_buffer
{
    float rhs[];
};
layout(binding = 5, scalar) writeonly buffer correction_buffer
{
    float correction[];
};

void main()
{
    uvec3 texel = gl_GlobalInvocationID;
    uint ch = texel.z / args.dims.z, plane = args.dims.x * args.dims.y;
    if (any(greaterThanEqual(texel.xy, args.dims.xy)) || ch >= args.channels) {
        return;
    }
    uint i = texel.z * plane + texel.y * args.dims.x + texel.x;
    uint per_direction = plane * args.dims.z * args.channels;
    float axes = 0.0, diagonals = 0.0;
    vec3 axis_flux = vec3(0.0), diagonal_flux = vec3(0.0);
    for (uint d = 0; d < LATTICE_DIRECTIONS; d++) {
        float psi = mean_psi[d * per_direction + i];
        vec3 o = vec3(lattice_step(d));
        if (d < 6) {
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
    swept[i] = m;
    float sigma_s = texelFetch(cells, ivec3(texel), 0).x;
    uint l = ch * args.stride + i - ch * plane * args.dims.z; // on level 0
    rhs[l] = args.dx * args.dx * args.dx * sigma_s * (m.x - state[i].x);
    correction[l] = 0.0;
}
