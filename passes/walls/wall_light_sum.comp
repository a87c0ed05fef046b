// wall_light_sum.comp -- the factor that makes the walls of all cells get what virtual point lights send to walls. One
// workgroup; sums have a fixed order.
//
// The walls of the lattice are stairs: those of a box of seven cells are some percent more or less than its
// own, and farther or nearer.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "wall_light_args.h"
#include "lattice.glsl"

layout(local_size_x = WALL_LIGHT_SUM_GROUP) in;
layout(push_constant, scalar) uniform push
{
    wall_light_args args;
};
layout(binding = 0, scalar) buffer power_buffer
{
    wall_light_power power;
};
layout(binding = 1, scalar) readonly buffer arrived_buffer
{
    vec3 arrived[]; // W/m^2, times the area over dx^2
};

shared vec3 sums[WALL_LIGHT_SUM_GROUP];

vec3 total_of(vec3 v)
{
    uint me = gl_LocalInvocationIndex;
    barrier();
    sums[me] = v;
    for (uint half_n = WALL_LIGHT_SUM_GROUP / 2u; half_n > 0u; half_n /= 2u) {
        barrier();
        if (me < half_n) {
            sums[me] += sums[me + half_n];
        }
    }
    barrier();
    return sums[0];
}

void main()
{
    uint me = gl_LocalInvocationIndex, cells = args.dims.x * args.dims.y * args.dims.z;
    float dx = lattice_box_of(args.extent, ivec3(args.dims)).dx;
    vec3 sent = vec3(0.0), got = vec3(0.0);
    for (uint v = me; v < WALL_LIGHT_VPLS; v += WALL_LIGHT_SUM_GROUP) {
        sent += power.expected[v];
    }
    for (uint i = me; i < cells; i += WALL_LIGHT_SUM_GROUP) {
        got += arrived[i];
    }
    sent = total_of(sent);
    got = total_of(got) * (dx * dx);
    if (me == 0u) {
        // Surfaces that the lattice has few links for do not give all their light to others.
        power.scale = mix(vec3(1.0), clamp(sent / max(got, vec3(1e-30)), 0.5, 2.0), greaterThan(got, vec3(0.0)));
    }
}
