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
layout(binding = 0) uniform sampler3D stencil_lo;
layout(binding = 1) uniform sampler3D stencil_hi;
layout(binding = 2, r32f) uniform image3D rhs;
layout(binding = 3, r32f) uniform image3D correction;

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
    ivec3 stack = ivec3(0, 0, ch * int(args.dims.z));
    float sum = 0.0;
    for (int child = 0; child < 8; child++) {
        ivec3 f = 2 * c + ivec3(child & 1, child >> 1 & 1, child >> 2);
        if (any(greaterThanEqual(f, fine.size))) {
            continue;
        }
        ivec3 texel = fine.offset + stack + f;
        lattice_stencil k =
            lattice_stencil_of(texelFetch(stencil_lo, texel, 0), texelFetch(stencil_hi, texel, 0));
        sum += imageLoad(rhs, texel).r - k.diagonal * imageLoad(correction, texel).r;
        for (int axis = 0; axis < 3; axis++) {
            ivec3 o = ivec3(0);
            o[axis] = 1;
            sum += f[axis] > 0 ? k.lo[axis] * imageLoad(correction, texel - o).r : 0.0;
            sum += f[axis] < fine.size[axis] - 1 ? k.hi[axis] * imageLoad(correction, texel + o).r : 0.0;
        }
    }
    imageStore(rhs, coarse.offset + stack + c, vec4(sum));
    imageStore(correction, coarse.offset + stack + c, vec4(0.0));
}
