// shade_gather.comp -- all VPLs' light at a pixel, from what it and its neighbours took: sums of shade_rows.comp along
// a column. Where too few neighbours lie on the same piece of surface, or on one side only and light changes from pixel to
// pixel, the pixel takes all VPLs itself: that is left to shade_vpls.comp.
#include "shade_place.glsl"
#define SHADE_ALONE_COUNT (SHADE_AT + 2)
#define SHADE_ALONE (SHADE_AT + 3)
#include "shade_alone.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = SHADE_AT, rgba32ui) uniform readonly uimage2D part_rows_image;
layout(binding = SHADE_AT + 1, rgba32ui) uniform writeonly uimage2D part_image;
#define SHADE_TENT_IMAGE part_rows_image
#include "shade_tent.glsl"

void main()
{
    ivec2 block = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(block, shade_blocks()))) {
        return;
    }
    shade_part sum = shade_unpack(imageLoad(part_rows_image, block));
    if (sum.along > 0.0 && (shade_has(SHADE_SKY_MAPS) || vpl_count() > SHADE_MOST * shade_side)) {
        sum = shade_tent(block, ivec2(0, 1), sum);
    }
    bool alone = !sum.whole || sum.near && sum.aside;
    sum.whole = true;
    sum.aside = false;
    if (alone) {
        shade_list_alone(block, 0u, shade_has(SHADE_SLICED) ? SHADE_SLICES : 1u, uint(SHADE_MANY));
    }
    imageStore(part_image, block, shade_pack(sum));
}
