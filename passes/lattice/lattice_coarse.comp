// lattice_coarse.comp -- the V-cycle on all levels small enough for one workgroup's shared memory.
//
// One workgroup per channel. The first level's right hand side comes from its image, as do all stencils;
// the corrections of all levels and the other right hand sides are in shared memory.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lattice_args.h"
#include "lattice_levels.glsl"
#include "lattice_stencil.glsl"

layout(local_size_x = LATTICE_COARSE_GROUP) in;
layout(push_constant, scalar) uniform push
{
    lattice_level_args args; // level: the first that is solved here
};
layout(binding = 0) uniform sampler3D stencil_lo;
layout(binding = 1) uniform sampler3D stencil_hi;
layout(binding = 2) uniform sampler3D rhs_image;
layout(binding = 3, r32f) uniform image3D correction_image;

// Each level has 1/8 of the cells of the one before; 1/4 in a box one cell thin; and 1/2 in one that is
// thin along two axes, which has at most 64 cells to begin with. So 3/8 more hold all levels.
shared float correction[LATTICE_COARSE_CELLS * 11 / 8];
shared float rhs[LATTICE_COARSE_CELLS * 3 / 8];

const uint RELAXATIONS = 2;
const uint COARSEST_RELAXATIONS = 32;

ivec3 size;    // of the level at work
ivec3 texel_0; // its cell (0, 0, 0) in the images
uint first;    // in `correction`
bool top;      // its right hand side is in the image

uint cells_of(ivec3 s)
{
    return uint(s.x * s.y * s.z);
}

void enter(uint level)
{
    first = 0;
    for (uint l = args.level; l < level; l++) {
        first += cells_of(lattice_level_of(ivec3(args.dims), l).size);
    }
    lattice_level at = lattice_level_of(ivec3(args.dims), level);
    size = at.size;
    texel_0 = at.offset + ivec3(0, 0, int(gl_WorkGroupID.x * args.dims.z));
    top = level == args.level;
}

uint first_rhs() // of the level at work, not the top one
{
    return first - cells_of(lattice_level_of(ivec3(args.dims), args.level).size);
}

ivec3 cell_of(uint i)
{
    return ivec3(i % size.x, i / size.x % size.y, i / (size.x * size.y));
}

uint index_of(ivec3 c)
{
    return first + uint((c.z * size.y + c.y) * size.x + c.x);
}

// Right hand side plus what flows in from the neighbours.
float inflow(ivec3 c, lattice_stencil k)
{
    float sum = top ? texelFetch(rhs_image, texel_0 + c, 0).r : rhs[index_of(c) - first + first_rhs()];
    uint i = index_of(c), step_y = size.x, step_z = size.x * size.y;
    sum += c.x > 0 ? k.lo.x * correction[i - 1] : 0.0;
    sum += c.x < size.x - 1 ? k.hi.x * correction[i + 1] : 0.0;
    sum += c.y > 0 ? k.lo.y * correction[i - step_y] : 0.0;
    sum += c.y < size.y - 1 ? k.hi.y * correction[i + step_y] : 0.0;
    sum += c.z > 0 ? k.lo.z * correction[i - step_z] : 0.0;
    sum += c.z < size.z - 1 ? k.hi.z * correction[i + step_z] : 0.0;
    return sum;
}

lattice_stencil stencil_at(ivec3 c)
{
    return lattice_stencil_of(texelFetch(stencil_lo, texel_0 + c, 0), texelFetch(stencil_hi, texel_0 + c, 0));
}

void relax(uint times)
{
    ivec3 half_size = ivec3((size.x + 1) / 2, size.yz);
    uint n = cells_of(half_size);
    for (uint t = 0; t < 2 * times; t++) {
        for (uint i = gl_LocalInvocationIndex; i < n; i += LATTICE_COARSE_GROUP) {
            ivec3 c = ivec3(0, i / half_size.x % half_size.y, i / (half_size.x * half_size.y));
            c.x = 2 * int(i % half_size.x) + (c.y + c.z + int(t) & 1);
            if (c.x < size.x) {
                lattice_stencil k = stencil_at(c);
                correction[index_of(c)] = inflow(c, k) / k.diagonal;
            }
        }
        barrier();
    }
}

// Residual of the level at work, summed into the right hand side of the next.
void restrict_to_next(uint level)
{
    ivec3 coarse = lattice_level_of(ivec3(args.dims), level + 1).size;
    uint next = first + cells_of(size);
    uint next_rhs = top ? 0 : first_rhs() + cells_of(size);
    for (uint i = gl_LocalInvocationIndex; i < cells_of(coarse); i += LATTICE_COARSE_GROUP) {
        ivec3 c = ivec3(i % coarse.x, i / coarse.x % coarse.y, i / (coarse.x * coarse.y));
        float sum = 0.0;
        for (int child = 0; child < 8; child++) {
            ivec3 f = 2 * c + ivec3(child & 1, child >> 1 & 1, child >> 2);
            if (all(lessThan(f, size))) {
                lattice_stencil k = stencil_at(f);
                sum += inflow(f, k) - k.diagonal * correction[index_of(f)];
            }
        }
        rhs[next_rhs + i] = sum;
        correction[next + i] = 0.0;
    }
    barrier();
}

void interpolate_from_next(uint level)
{
    ivec3 coarse = lattice_level_of(ivec3(args.dims), level + 1).size;
    uint next = first + cells_of(size);
    for (uint i = gl_LocalInvocationIndex; i < cells_of(size); i += LATTICE_COARSE_GROUP) {
        lattice_interpolation from = lattice_interpolation_of(cell_of(i), coarse);
        float sum = 0.0;
        for (uint corner = 0; corner < 8; corner++) {
            ivec3 q = lattice_corner(from, corner);
            sum += lattice_corner_weight(corner) * correction[next + (q.z * coarse.y + q.y) * coarse.x + q.x];
        }
        correction[first + i] += sum;
    }
    barrier();
}

void main()
{
    uint level = args.level;
    enter(level);
    for (uint i = gl_LocalInvocationIndex; i < cells_of(size); i += LATTICE_COARSE_GROUP) {
        correction[i] = imageLoad(correction_image, texel_0 + cell_of(i)).r;
    }
    barrier();
    for (; level + 1 < args.levels; level++) {
        enter(level);
        relax(RELAXATIONS);
        restrict_to_next(level);
    }
    enter(level);
    relax(COARSEST_RELAXATIONS);
    while (level > args.level) {
        level--;
        enter(level);
        interpolate_from_next(level);
        relax(RELAXATIONS);
    }
    for (uint i = gl_LocalInvocationIndex; i < cells_of(size); i += LATTICE_COARSE_GROUP) {
        imageStore(correction_image, texel_0 + cell_of(i), vec4(correction[i]));
    }
}
