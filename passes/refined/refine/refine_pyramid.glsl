// refine_pyramid.glsl -- moments of a tile of 8 x 8 texels, and means of them on three coarser levels.
#include "refine.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba32f) REFINE_MOMENTS_ACCESS uniform image2D moments_image;
shared vec3 tile[REFINE_MOMENTS][64]; // 13.5 KiB of the 16 that Vulkan promises

// Each task is a texel of a coarser level and plane: 16 texels of the first level, 4, 1.
void refine_store_coarser(uint level)
{
    barrier();
    for (uint task = gl_LocalInvocationIndex; task < 21u * uint(REFINE_MOMENTS); task += 64u) {
        const uint plane = task / 21u, k = task % 21u;
        const uint up = k < 16u ? 1u : k < 20u ? 2u : 3u;
        const uint texel = k < 16u ? k : k < 20u ? k - 16u : 0u, side = 8u >> up, width = 1u << up;
        const uvec2 at = uvec2(texel % side, texel / side);
        vec3 sum = vec3(0.0);
        for (uint i = 0u; i < width * width; i++) {
            const uvec2 from = width * at + uvec2(i % width, i / width);
            sum += tile[plane][from.y * 8u + from.x];
        }
        const uvec2 to = side * gl_WorkGroupID.xy + at;
        if (level + up < uint(REFINE_LEVELS) && all(lessThan(to, refine_size(level + up)))) {
            imageStore(moments_image, ivec2(refine_moment(plane) + refine_corner(level + up) + to),
                       vec4(sum / float(width * width), 0.0));
        }
    }
}
