// lattice_relax.comp -- Gauss-Seidel on the cells of one colour of a checkerboard.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lattice_args.h"
#include "lattice_levels.glsl"
#include "lattice_stencil.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
layout(push_constant, scalar) uniform push
{
    lattice_level_args args;
};
layout(binding = 0) uniform sampler3D stencil_lo;
layout(binding = 1) uniform sampler3D stencil_hi;
layout(binding = 2) uniform sampler3D rhs;
layout(binding = 3, r32f) uniform image3D correction;

void main()
{
    lattice_level level = lattice_level_of(ivec3(args.dims), args.level);
    ivec3 c = ivec3(gl_GlobalInvocationID);
    int ch = c.z / level.size.z;
    c.z %= level.size.z;
    c.x = 2 * c.x + (c.y + c.z + int(args.colour) & 1);
    if (any(greaterThanEqual(c.xy, level.size.xy)) || ch >= int(args.channels)) {
        return;
    }
    ivec3 texel = level.offset + c + ivec3(0, 0, ch * int(args.dims.z));
    lattice_stencil k =
        lattice_stencil_of(texelFetch(stencil_lo, texel, 0), texelFetch(stencil_hi, texel, 0));
    float sum = texelFetch(rhs, texel, 0).r;
    for (int axis = 0; axis < 3; axis++) {
        ivec3 o = ivec3(0);
        o[axis] = 1;
        sum += c[axis] > 0 ? k.lo[axis] * imageLoad(correction, texel - o).r : 0.0;
        sum += c[axis] < level.size[axis] - 1 ? k.hi[axis] * imageLoad(correction, texel + o).r : 0.0;
    }
    imageStore(correction, texel, vec4(sum / k.diagonal));
}
