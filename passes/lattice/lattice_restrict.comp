// lattice_restrict.comp -- right hand side of a level: the residual of the next finer one, summed.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lattice_args.h"
#include "lattice_levels.glsl"
#include "lattice_stencil.glsl"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
layout(push_constant, scalar) uniform push
{
    lattice_level_args args; // level: the coarse one
};
layout(binding = 0, scalar) readonly buffer lo_buffer
{
    vec4 stencil_lo[];
};
layout(binding = 1, scalar) readonly buffer hi_buffer
{
    vec4 stencil_hi[];
};
layout(binding = 2, scalar) buffer rhs_buffer
{
    float rhs[];
};
layout(binding = 3, scalar) buffer correction_buffer
{
    float correction[];
};

void main()
{
    lattice_level coarse = lattice_level_of(ivec3(args.dims), args.level);
    lattice_level fine = lattice_level_of(ivec3(args.dims), args.level - 1);
    ivec3 c = ivec3(gl_GlobalInvocationID);
    int ch = c.z / coarse.size.z;
    c.z %= coarse.size.z;
    if (any(greaterThanEqual(c.xy, coarse.size.xy)) || ch >= int(args.channels)) {
        return;
    }
    uint channel = uint(ch) * args.stride;
    uint step_y = fine.size.x, step_z = fine.size.x * fine.size.y;
    float sum = 0.0;
    for (int child = 0; child < 8; child++) {
        ivec3 f = 2 * c + ivec3(child & 1, child >> 1 & 1, child >> 2);
        if (any(greaterThanEqual(f, fine.size))) {
            continue;
        }
        uint i = channel + lattice_index(fine, f);
        lattice_stencil k = lattice_stencil_of(stencil_lo[i], stencil_hi[i]);
        if (lattice_orphan(stencil_hi[i])) {
            continue;
        }
        sum += rhs[i] - k.diagonal * correction[i];
        sum += f.x > 0 ? k.lo.x * correction[i - 1] : 0.0;
        sum += f.x < fine.size.x - 1 ? k.hi.x * correction[i + 1] : 0.0;
        sum += f.y > 0 ? k.lo.y * correction[i - step_y] : 0.0;
        sum += f.y < fine.size.y - 1 ? k.hi.y * correction[i + step_y] : 0.0;
        sum += f.z > 0 ? k.lo.z * correction[i - step_z] : 0.0;
        sum += f.z < fine.size.z - 1 ? k.hi.z * correction[i + step_z] : 0.0;
    }
    uint i = channel + lattice_index(coarse, c);
    rhs[i] = sum;
    correction[i] = 0.0;
}
