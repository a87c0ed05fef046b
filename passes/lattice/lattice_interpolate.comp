// lattice_interpolate.comp -- adds the correction of the next coarser level.
#include "shaders/lattice/lattice_args.h"
#include "shaders/common/quotient.glsl"
#include "lattice_levels.glsl"
#define LATTICE_STENCIL_LO 1
#define LATTICE_STENCIL_HI 2
#include "lattice_stencil_texels.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
TYN_ARGS(lattice_level_args args); // level: the fine one
TYN_WRITE(0, correction, float correction[]);
layout(binding = 3) uniform samplerBuffer correction_words; // the same

layout(constant_id = 0) const uint walls = 0;
layout(constant_id = 1) const uint lattice_repeat = 0; // a bit for each axis along which the grid goes on

void main()
{
    lattice_level fine = lattice_level_of(ivec3(args.dims), args.level);
    lattice_level coarse = lattice_level_of(ivec3(args.dims), args.level + 1);
    ivec3 c = ivec3(gl_GlobalInvocationID);
    int ch = quotient(c.z, fine.size.z);
    c.z -= ch * fine.size.z;
    if (any(greaterThanEqual(c.xy, fine.size.xy)) || ch >= int(args.channels)) {
        return;
    }
    uint channel = uint(ch) * args.stride;
    lattice_interpolation from = lattice_interpolation_of(c, coarse.size, lattice_repeat);
    bool blended = true;
    if (walls == 1) {
        uint i = channel + lattice_index(fine, c);
        if (lattice_orphan(lattice_stencil_hi_at(i))) {
            return;
        }
        blended = !lattice_alone(lattice_stencil_lo_at(i));
    }
    float sum = 0.0;
    for (uint corner = 0; corner < 8; corner++) {
        uint i = channel + lattice_index(coarse, blended ? lattice_corner(from, corner) : from.near);
        sum += lattice_corner_weight(corner) * texelFetch(correction_words, int(i)).x;
    }
    uint i = channel + lattice_index(fine, c);
    correction[i] = texelFetch(correction_words, int(i)).x + sum;
}
