// shade_rows.comp -- Light of VPLs and of the sky summed over the pattern along rows. shade_gather.comp sums these sums along columns.
#include "shade_args.h"
#include "shaders/common/camera.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const int shade_side = SHADE_SIDE; // of the pattern
layout(constant_id = 1) const int shade_step = 1;          // pixels along each side of a block
layout(constant_id = 2) const bool many = false;           // there is more than VPLs to sum
TYN_UNIFORM(0, camera, camera_block camera);
TYN_READ(1, vpls, uint vpl_count);
layout(binding = 2, rgba32ui) uniform readonly uimage2D part_image;
layout(binding = 3, rgba32ui) uniform writeonly uimage2D part_rows_image;
#include "shade_part.glsl"
#define SHADE_TENT_IMAGE part_image
#include "shade_tent.glsl"

void main()
{
    ivec2 block = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(block, shade_blocks()))) {
        return;
    }
    shade_part sum = shade_unpack(imageLoad(part_image, block));
    if (sum.along > 0.0 && (many || vpl_count > SHADE_MOST)) {
        sum = shade_tent(block, ivec2(1, 0), sum);
    }
    imageStore(part_rows_image, block, shade_pack(sum));
}
