// diffusion_system.glsl -- cells, their neighbours, and what flows through the faces between them.
#ifndef DIFFUSION_SYSTEM_GLSL
#define DIFFUSION_SYSTEM_GLSL
#include "diffusion_args.h"

TYN_ARGS(diffusion_args args);

const ivec3 FACES[6] = ivec3[](ivec3(-1, 0, 0), ivec3(1, 0, 0), ivec3(0, -1, 0), ivec3(0, 1, 0), ivec3(0, 0, -1),
                               ivec3(0, 0, 1));

// Of a cell in buffers: x is fastest, channels follow each other.
uint system_index(ivec3 cell, uint channel)
{
    return ((channel * args.dims.z + cell.z) * args.dims.y + cell.y) * args.dims.x + cell.x;
}

bool system_within(ivec3 cell)
{
    return all(equal(cell, clamp(cell, ivec3(0), ivec3(args.dims) - 1)));
}

// Power through a face per square metre and difference of fluence, 1: between two cells; at the boundary of one.
float system_between(float d, float other)
{
    return 2.0 * d * other / ((d + other) * args.dx);
}

float system_boundary(float d)
{
    return 2.0 * d / (args.dx + 4.0 * d);
}

// ... of s there, of which `along` stands across the face outwards: so much of it gets out.
float system_boundary_share(float d)
{
    return args.dx / (args.dx + 4.0 * d);
}

#endif
