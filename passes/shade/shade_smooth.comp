// shade_smooth.comp -- where blocks of several pixels have one place for smooth light: that of the lattice, and of suns
// what the medium scattered forward, added to that of VPLs.
#include "shade_place.glsl"
#include "shade_piece.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = SHADE_PIECE_AT, rgba32ui) uniform writeonly uimage2D part_rows_image;

void main()
{
    ivec2 block = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(block, shade_blocks()))) {
        return;
    }
    shade_part part;
    shade_point p = shade_place(block, part);
    if (shade_has(SHADE_SHARED)) {
        part.irradiance = shade_unpack(imageLoad(part_image, block)).irradiance;
    }
    if (part.along > 0.0) {
        part.irradiance += smooth_light_at(p);
        part.facet = p.normal; // surfaces look for those that face the same way
    }
    imageStore(part_rows_image, block, shade_pack(part));
}
