// lattice_stencil_coarse.comp -- stencil of a level from that of the next finer one.
//
// Coarse conductances are those of cells twice as large whose D is the mean over the four fine
// faces: half the sum. Absorption adds up.
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
layout(binding = 0, scalar) buffer lo_buffer
{
    vec4 stencil_lo[];
};
layout(binding = 1, scalar) buffer hi_buffer
{
    vec4 stencil_hi[];
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
    float edge = args.dx * float(1u << (args.level - 1)), area = edge * edge; // of fine cells
    lattice_stencil k = lattice_stencil(vec3(0.0), vec3(0.0), 0.0, 0.0);
    for (int child = 0; child < 8; child++) {
        ivec3 f = 2 * c + ivec3(child & 1, child >> 1 & 1, child >> 2);
        if (any(greaterThanEqual(f, fine.size))) {
            continue;
        }
        uint i = channel + lattice_index(fine, f);
        vec4 lo = stencil_lo[i], hi = stencil_hi[i];
        k.absorption += lo.w;
        for (int axis = 0; axis < 3; axis++) {
            // At the box the half cell becomes twice as long. A coarse cell that reaches beyond the
            // box has its centre on it, so that only the Robin condition is left.
            if (f[axis] == 0) {
                k.lo[axis] += area / (2.0 * (area / lo[axis]) - 2.0);
            } else if (f[axis] % 2 == 0) {
                k.lo[axis] += 0.5 * lo[axis];
            }
            if (f[axis] == fine.size[axis] - 1) {
                bool beyond = f[axis] % 2 == 0;
                k.hi[axis] += area / (beyond ? 2.0 : 2.0 * (area / hi[axis]) - 2.0);
            } else if (f[axis] % 2 == 1) {
                k.hi[axis] += 0.5 * hi[axis];
            }
        }
    }
    uint i = channel + lattice_index(coarse, c);
    stencil_lo[i] = lattice_stencil_lo(k);
    stencil_hi[i] = lattice_stencil_hi(k);
}
