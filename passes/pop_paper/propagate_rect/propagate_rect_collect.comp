// propagate_rect_collect.comp -- what a batch of grids sent to the eye, as tiles of an image.
#include "../common/propagate.glsl"
#include "propagate_rect_args.h"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
TYN_READ(0, sum, float sum[]);
layout(set = 0, binding = 1, r32f) uniform writeonly image3D seen_image;
TYN_ARGS(propagate_rect_args args);

void main()
{
    uint groups = propagate_groups(args.along, PROPAGATE_RECT_GROUP);
    uint stack = gl_WorkGroupID.z / groups, tile = args.first * args.channels + stack;
    ivec3 cell = ivec3(gl_GlobalInvocationID.xy,
                       gl_GlobalInvocationID.z - stack * groups * PROPAGATE_RECT_GROUP);
    if (any(greaterThanEqual(uvec3(cell), uvec3(args.cells, args.cells, args.along)))) {
        return;
    }
    ivec3 corner = ivec3(tile % args.tiles, tile / args.tiles, 0) * int(args.cells);
    imageStore(seen_image, corner + cell, vec4(sum[propagate_index(cell, stack, args.cells, args.along)]));
}
