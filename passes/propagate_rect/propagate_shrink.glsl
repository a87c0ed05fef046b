// propagate_shrink.glsl -- samples of a box filter over the medium's voxels. No bindings; after medium.glsl.
#ifndef TYN_PROPAGATE_SHRINK_GLSL
#define TYN_PROPAGATE_SHRINK_GLSL

// Samples along each edge of a texel of the smaller image: a trilinear fetch is a mean over two voxels.
ivec3 shrink_samples(ivec3 size)
{
    return ivec3(ceil(0.5 * vec3(medium.size) / vec3(size) - 1e-3));
}

// The n-th of them, in M.
vec3 shrink_sample(ivec3 texel, ivec3 size, ivec3 along, int n)
{
    vec3 part = (vec3(n % along.x, n / along.x % along.y, n / (along.x * along.y)) + 0.5) / vec3(along);
    return (vec3(texel) + part) / vec3(size) * medium.extent;
}

#endif
