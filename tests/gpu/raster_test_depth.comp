// raster_test_depth.comp -- copies a depth image, sampled as float.
#version 460
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D depth;
layout(set = 0, binding = 1, r32f) writeonly uniform image2D result;

void main()
{
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(p, imageSize(result)))) {
        vec4 four = textureGather(depth, (vec2(p) + 1.0) / vec2(imageSize(result))); // w: texel p
        imageStore(result, p, vec4(four.w + 0.0 * texelFetch(depth, p, 0).r));
    }
}
