// lattice_interpolate.comp -- adds the correction of the next coarser level, and relaxes colour 0 of the sum.
//
// Nothing else reads the sum: colour 1 is relaxed next, from colour 0 alone.
#include "shaders/lattice/lattice_args.h"
#include "shaders/common/quotient.glsl"
#include "lattice_levels.glsl"
#define LATTICE_STENCIL_LO 1
#define LATTICE_STENCIL_HI 2
#include "lattice_stencil_texels.glsl"

TYN_ARGS(lattice_level_args args); // level: the fine one
TYN_WRITE(0, correction, float correction[]);
layout(binding = 3) uniform samplerBuffer correction_words; // the same
layout(binding = 4) uniform samplerBuffer rhs_words;

layout(constant_id = 0) const uint walls = 0;

float correction_at(uint i)
{
    return texelFetch(correction_words, int(i)).x;
}

#define LATTICE_REPEAT 1
#include "lattice_inflow.glsl"
#define TILE_GROUP 256 // a cell of colour 0 each
#include "lattice_tile.glsl"

float tile_correction(const lattice_level fine, ivec3 c, uint i, bool own)
{
    lattice_level coarse = lattice_next_level(fine);
    lattice_interpolation from = lattice_interpolation_of(c, coarse.size, lattice_repeat);
    uint channel = i - lattice_index(fine, c);
    bool blended = true, orphan = false;
    if (walls == 1) {
        orphan = lattice_orphan(lattice_stencil_hi_at(i));
        blended = !lattice_alone(lattice_stencil_lo_at(i));
    }
    float sum = 0.0;
    for (uint corner = 0; corner < 8 && !orphan; corner++) {
        uint k = channel + lattice_index(coarse, blended ? lattice_corner(from, corner) : from.near);
        sum += lattice_corner_weight(corner) * correction_at(k);
    }
    return correction_at(i) + sum;
}

void main()
{
    lattice_level fine = lattice_level_of(ivec3(args.dims), args.level);
    lattice_block block = lattice_block_of(fine);
    fill_tile(fine, block);
    ivec3 t = quotient_place(gl_LocalInvocationIndex, ivec3(TILE / 2, TILE, TILE));
    t.x = 2 * t.x + (t.y + t.z & 1);
    ivec3 c = block.begin + t;
    if (any(greaterThanEqual(c, fine.size))) {
        return;
    }
    uint i = block.channel + lattice_index(fine, c);
    lattice_stencil k = lattice_stencil_at(i);
    correction[i] = tile_inflow(texelFetch(rhs_words, int(i)).x, tile_index(block, c), k) / k.diagonal;
}
