// columns_average.glsl -- where the medium is sampled for its mean over a texel of a coarser grid.
// Include after columns_args.h, with the push constants args.
#ifndef TYN_COLUMNS_AVERAGE_GLSL
#define TYN_COLUMNS_AVERAGE_GLSL

uint columns_average_count()
{
    return args.samples.x * args.samples.y * args.samples.z;
}

// Texture coordinate of sample i of a texel.
vec3 columns_average_uvw(uvec3 texel, uint i)
{
    uvec3 s = uvec3(i % args.samples.x, i / args.samples.x % args.samples.y,
                    i / (args.samples.x * args.samples.y));
    return (vec3(texel) + (vec3(s) + 0.5) / vec3(args.samples)) / vec3(args.size);
}

#endif
