// propagate_rect_shrink.comp -- the medium at a resolution that suits the cells of many grids: a box filter over its
// voxels. Built twice: TYN_DENSITY is defined for mode DENSITY.
#define MEDIUM_AT 0
#include "shaders/medium/medium.glsl"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
#ifdef TYN_DENSITY
layout(set = 0, binding = 5, r32f) uniform writeonly image3D small_image;
#else
layout(set = 0, binding = 5, rgba32f) uniform writeonly image3D small_image;
layout(set = 0, binding = 6, rgba32f) uniform writeonly image3D small_sigma_a_image;
layout(set = 0, binding = 7, rgba32f) uniform writeonly image3D small_g_image;
#endif

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

void main()
{
#ifdef TYN_DENSITY
    ivec3 texel = ivec3(gl_GlobalInvocationID), size = imageSize(small_image);
#else
    ivec3 texel = ivec3(gl_GlobalInvocationID), size = imageSize(small_g_image);
#endif
    if (any(greaterThanEqual(texel, size))) {
        return;
    }
    ivec3 along = shrink_samples(size);
    int count = along.x * along.y * along.z;
#ifdef TYN_DENSITY
    float density = 0.0;
    for (int n = 0; n < count; n++) {
        density += medium_density(shrink_sample(texel, size, along, n));
    }
    imageStore(small_image, texel, vec4(density / float(count)));
#else
    vec3 sigma_s = vec3(0.0), sigma_a = vec3(0.0), g = vec3(0.0);
    for (int n = 0; n < count; n++) {
        medium_point m = medium_sample(shrink_sample(texel, size, along, n));
        sigma_s += m.sigma_s;
        sigma_a += m.sigma_a;
        g += m.sigma_s * phase_mean_cosine(m.phase);
    }
    float each = 1.0 / float(count);
    imageStore(small_image, texel, vec4(sigma_s * each, 0.0));
    imageStore(small_sigma_a_image, texel, vec4(sigma_a * each, 0.0));
    imageStore(small_g_image, texel, vec4(g / max(sigma_s, vec3(1e-30)), 0.0));
#endif
}
