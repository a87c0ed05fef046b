// shade_gather.comp -- all VPLs' light at a pixel, from what it and its neighbours took: sums of shade_rows.comp along
// a column. Where too few neighbours lie on the same piece of surface the pixel takes all VPLs itself.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define VPL_PLANES 24
#include "shade_place.glsl"
#define WALLS_TABLE 23
#include "shade_rooms.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 21, rgba32ui) uniform readonly uimage2D tent_image;
layout(binding = 22, rgba32ui) uniform writeonly uimage2D indirect_image;
#include "shade_tent.glsl"

void main()
{
    ivec2 block = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(block, shade_blocks()))) {
        return;
    }
    shade_part sum = shade_unpack(imageLoad(tent_image, block));
    if (sum.along > 0.0 && vpl_count > SHADE_MOST * shade_side) {
        sum = shade_tent(block, ivec2(0, 1), sum);
    }
    if (!sum.whole) {
        shade_part part;
        shade_point p = shade_place(block, part);
        shade_point same[SHADE_MANY] = shade_point[](p, p, p, p); // the compiler sees that they are
        float room = shade_has(SHADE_ROOMS) ? shade_room_of(p.position) : -1.0;
        sum.irradiance = shade_vpls(same, float[SHADE_MANY](room, room, room, room), 0u, 1u)[0];
    }
    imageStore(indirect_image, block, shade_pack(sum));
}
