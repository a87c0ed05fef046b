// lattice_relax.comp -- Gauss-Seidel on the cells of one colour of a checkerboard.
#include "shaders/lattice/lattice_args.h"
#include "shaders/common/quotient.glsl"
#include "lattice_levels.glsl"
#define LATTICE_STENCIL_LO 0
#define LATTICE_STENCIL_HI 1
#include "lattice_stencil_texels.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
TYN_ARGS(lattice_level_args args);
layout(binding = 2) uniform samplerBuffer rhs_words;
layout(binding = 3) uniform samplerBuffer correction_words; // the correction: cells of the other colour
TYN_WRITE(4, correction, float correction[]);

float correction_at(uint i)
{
    return texelFetch(correction_words, int(i)).x;
}

#define LATTICE_REPEAT 1
#include "lattice_inflow.glsl"

void main()
{
    lattice_level level = lattice_level_of(ivec3(args.dims), args.level);
    ivec3 c = ivec3(gl_GlobalInvocationID);
    int ch = quotient(c.z, level.size.z);
    c.z -= ch * level.size.z;
    c.x = 2 * c.x + (c.y + c.z + int(args.colour) & 1);
    if (any(greaterThanEqual(c.xy, level.size.xy)) || ch >= int(args.channels)) {
        return;
    }
    uint i = uint(ch) * args.stride + lattice_index(level, c);
    lattice_stencil k = lattice_stencil_at(i);
    float sum = lattice_inflow(texelFetch(rhs_words, int(i)).x, level, c, i, k);
    correction[i] = sum / k.diagonal;
}
