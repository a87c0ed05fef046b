// light_cells_blocks.comp -- least and greatest depth in blocks of the atlas, of all sizes.
//
// A thread owns one of the finest blocks, a workgroup one of the largest.
#include "shaders/light/light_cells_args.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D shadow_atlas;
layout(binding = 1, rg32f) uniform writeonly image2D blocks_image0;
layout(binding = 2, rg32f) uniform writeonly image2D blocks_image1;
layout(binding = 3, rg32f) uniform writeonly image2D blocks_image2;
layout(binding = 4, rg32f) uniform writeonly image2D blocks_image3;

shared vec2 ranges[2][8][8]; // of the last level and of the next

vec2 joined(vec2 a, vec2 b)
{
    return vec2(min(a.x, b.x), max(a.y, b.y));
}

vec2 of_four(int from, ivec2 at)
{
    return joined(joined(ranges[from][at.y][at.x], ranges[from][at.y][at.x + 1]),
                  joined(ranges[from][at.y + 1][at.x], ranges[from][at.y + 1][at.x + 1]));
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy), me = ivec2(gl_LocalInvocationID.xy);
    vec2 texel = 1.0 / vec2(textureSize(shadow_atlas, 0));
    vec4 least = vec4(1.0), greatest = vec4(0.0);
    for (int y = 1; y < LIGHT_CELLS_BLOCK; y += 2) {
        for (int x = 1; x < LIGHT_CELLS_BLOCK; x += 2) {
            vec4 four = textureGather(shadow_atlas, vec2(at * LIGHT_CELLS_BLOCK + ivec2(x, y)) * texel);
            least = min(least, four);
            greatest = max(greatest, four);
        }
    }
    vec2 range = vec2(min(min(least.x, least.y), min(least.z, least.w)),
                      max(max(greatest.x, greatest.y), max(greatest.z, greatest.w)));
    imageStore(blocks_image0, at, vec4(range, 0.0, 0.0));
    ranges[0][me.y][me.x] = range;
    barrier();
    if (all(lessThan(me, ivec2(4)))) {
        range = of_four(0, 2 * me);
        imageStore(blocks_image1, ivec2(gl_WorkGroupID.xy) * 4 + me, vec4(range, 0.0, 0.0));
        ranges[1][me.y][me.x] = range;
    }
    barrier();
    if (all(lessThan(me, ivec2(2)))) {
        range = of_four(1, 2 * me);
        imageStore(blocks_image2, ivec2(gl_WorkGroupID.xy) * 2 + me, vec4(range, 0.0, 0.0));
        ranges[0][me.y][me.x] = range;
    }
    barrier();
    if (me == ivec2(0)) {
        imageStore(blocks_image3, ivec2(gl_WorkGroupID.xy), vec4(of_four(0, ivec2(0)), 0.0, 0.0));
    }
}
