// halve_depth.comp -- see halve_depth.h; one thread a texel of the small image.
#version 460
layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2D full_depth;
layout(binding = 1, r32f) uniform writeonly image2D half_depth;

void main()
{
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, imageSize(half_depth)))) {
        return;
    }
    float a = texelFetch(full_depth, 2 * p, 0).r, b = texelFetch(full_depth, 2 * p + ivec2(1, 0), 0).r;
    float c = texelFetch(full_depth, 2 * p + ivec2(0, 1), 0).r, d = texelFetch(full_depth, 2 * p + 1, 0).r;
    bool least = ((p.x + p.y) & 1) == 0;
    float kept = least ? min(min(a, b), min(c, d)) : max(max(a, b), max(c, d));
    imageStore(half_depth, p, vec4(kept));
}
