// lattice_restrict.comp -- relaxes colour 1 of a level. Then its residual, summed, is the right hand side of the next coarser one.
// And the first half of that one's first relaxation, from corrections of 0.
//
// Cells of the finer level whose indices have an odd sum were relaxed last: their residual is 0.
#extension GL_EXT_control_flow_attributes : require
#include "shaders/lattice/lattice_args.h"
#include "shaders/common/quotient.glsl"
#include "lattice_levels.glsl"
#define LATTICE_STENCIL_LO 0
#define LATTICE_STENCIL_HI 1
#include "lattice_stencil_texels.glsl"

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

#define TILE_GROUP 64 // a coarse cell each
#include "lattice_tile.glsl"

float tile_correction(const lattice_level level, ivec3 c, uint i, bool own)
{
    lattice_stencil k = lattice_stencil_at(i);
    float e = lattice_inflow(texelFetch(rhs_words, int(i)).x, level, c, i, k) / k.diagonal;
    if (own) {
        correction[i] = e;
    }
    return e;
}

void main()
{
    lattice_level coarse = lattice_level_of(ivec3(args.dims), args.level);
    lattice_level fine = lattice_level_of(ivec3(args.dims), args.level - 1);
    lattice_block block = lattice_block_of(fine);
    fill_tile(fine, block);
    ivec3 c = block.begin / 2 + quotient_place(gl_LocalInvocationIndex, ivec3(TILE / 2));
    if (any(greaterThanEqual(c, coarse.size))) {
        return;
    }
    float sum = 0.0;
    const int even[4] = int[](0, 3, 5, 6);
    [[unroll]] for (int n = 0; n < 4; n++) {
        int child = even[n];
        ivec3 f = 2 * c + ivec3(child & 1, child >> 1 & 1, child >> 2);
        if (any(greaterThanEqual(f, fine.size))) {
            continue;
        }
        uint i = block.channel + lattice_index(fine, f);
        vec4 hi = lattice_stencil_hi_at(i);
        lattice_stencil k = lattice_stencil_of(lattice_stencil_lo_at(i), hi);
        if (lattice_orphan(hi)) {
            continue;
        }
        sum = tile_inflow(sum + texelFetch(rhs_words, int(i)).x - k.diagonal * correction_at(i), tile_index(block, f), k);
    }
    uint i = block.channel + lattice_index(coarse, c);
    rhs[i] = sum;
    correction[i] = (c.x + c.y + c.z & 1) == 0 ? sum / abs(lattice_stencil_hi_at(i).w) : 0.0;
}
