// lattice_restrict.comp -- right hand side of a level: the residual of the next finer one, summed. And the first half
// of its first relaxation, from corrections of 0.
//
// Cells of the finer level whose indices have an odd sum were relaxed last: their residual is 0.
#extension GL_EXT_control_flow_attributes : require
#include "shaders/lattice/lattice_args.h"
#include "shaders/common/quotient.glsl"
#include "lattice_levels.glsl"
#define LATTICE_STENCIL_LO 0
#define LATTICE_STENCIL_HI 1
#include "lattice_stencil_texels.glsl"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
TYN_ARGS(lattice_level_args args); // level: the coarse one
layout(binding = 2) uniform samplerBuffer rhs_words; // the buffers below, at another level
layout(binding = 3) uniform samplerBuffer correction_words;
TYN_WRITE(4, rhs, float rhs[]);
TYN_WRITE(5, correction, float correction[]);

float correction_at(uint i)
{
    return texelFetch(correction_words, int(i)).x;
}

#define LATTICE_REPEAT 1
#include "lattice_inflow.glsl"

void main()
{
    lattice_level coarse = lattice_level_of(ivec3(args.dims), args.level);
    lattice_level fine = lattice_level_of(ivec3(args.dims), args.level - 1);
    ivec3 c = ivec3(gl_GlobalInvocationID);
    int ch = quotient(c.z, coarse.size.z);
    c.z -= ch * coarse.size.z;
    if (any(greaterThanEqual(c.xy, coarse.size.xy)) || ch >= int(args.channels)) {
        return;
    }
    uint channel = uint(ch) * args.stride;
    float sum = 0.0;
    const int even[4] = int[](0, 3, 5, 6);
    [[unroll]] for (int n = 0; n < 4; n++) {
        int child = even[n];
        ivec3 f = 2 * c + ivec3(child & 1, child >> 1 & 1, child >> 2);
        if (any(greaterThanEqual(f, fine.size))) {
            continue;
        }
        uint i = channel + lattice_index(fine, f);
        vec4 hi = lattice_stencil_hi_at(i);
        lattice_stencil k = lattice_stencil_of(lattice_stencil_lo_at(i), hi);
        if (lattice_orphan(hi)) {
            continue;
        }
        sum = lattice_inflow(sum + texelFetch(rhs_words, int(i)).x - k.diagonal * correction_at(i), fine, f, i, k);
    }
    uint i = channel + lattice_index(coarse, c);
    rhs[i] = sum;
    correction[i] = (c.x + c.y + c.z & 1) == 0 ? sum / abs(lattice_stencil_hi_at(i).w) : 0.0;
}
