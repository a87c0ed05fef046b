// gbuffer_sample.glsl -- what both steps of the G-buffer that follow the drawing read and write.
#include "shaders/common/scene_args.h"
#include "shaders/surfaces/gbuffer_edges.glsl"

layout(constant_id = 0) const uint textured = 1u;
layout(constant_id = 1) const int samples = 2; // along each side of a pixel
layout(constant_id = 2) const uint row = GBUFFER_ROW;
TYN_UNIFORM(0, camera, camera_block camera);
#define GEOMETRY_AT 1
#define MATERIALS_AT 5
#define GBUFFER_TEXTURED (textured != 0u)
#define GBUFFER_SAMPLES samples
#include "shaders/surfaces/gbuffer_triangle.glsl"
layout(set = 0, binding = 8, r32ui) uniform readonly uimage2D seen;
layout(set = 0, binding = 9, r32f) uniform writeonly image2D distances_image;
layout(set = 0, binding = 10, rgba32ui) uniform writeonly uimage2D facing_image;
layout(set = 0, binding = 11, rgba32ui) uniform writeonly uimage2D colours_image;
TYN_UPDATE(12, mixed_count, gbuffer_edge_count mixed_count);
layout(set = 0, binding = 13, scalar) buffer mixed_buffer // as edges, of pixels whose samples see several triangles
{
    uint mixed[];
};

ivec2 texel_of(ivec2 corner, int k)
{
    return corner + ivec2(k % samples, k / samples);
}

// What a pixel shows whose samples all lie on one piece of surface: `p` is of the first, with means of the others.
void store_whole(ivec2 pixel, const gbuffer_point p)
{
    imageStore(facing_image, pixel, gbuffer_facing_pack(gbuffer_facing(GBUFFER_WHOLE, 0, p.normal, p.facet)));
    imageStore(colours_image, ivec2(pixel.x * gbuffer_texels(samples), pixel.y), gbuffer_pack(p.colours));
}
