// gbuffer_resolve.comp -- lists pixels whose samples see several triangles, or one beside nothing, for gbuffer_mixed.comp: on a
// device whose threads run together they would keep their neighbours waiting.
#include "shaders/common/scene_args.h"
#include "shaders/surfaces/gbuffer_edges.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const int samples = 2; // along each side of a pixel
layout(constant_id = 1) const uint row = GBUFFER_ROW;
TYN_UNIFORM(0, camera, camera_block camera);
layout(binding = 1, r32ui) uniform readonly uimage2D seen;
TYN_UPDATE(2, mixed_count, gbuffer_edge_count mixed_count);
layout(binding = 3, scalar) writeonly buffer mixed_buffer
{
    uint mixed[]; // x | y << 16
};

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(camera.size)))) {
        return;
    }
    ivec2 corner = pixel * samples;
    uint index = imageLoad(seen, corner).r;
    bool same = true;
    for (int k = 1; k < samples * samples; k++) {
        same = same && imageLoad(seen, corner + ivec2(k % samples, k / samples)).r == index;
    }
    if (!same) {
        GBUFFER_ADD(n, mixed_count, 1u, 1u, row)
        mixed[n] = uint(pixel.y) << 16 | uint(pixel.x);
    }
}
