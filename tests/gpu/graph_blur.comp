// graph_blur.comp -- for the test of the graph: dst = (left + right of src) / 2 + bias, wrapping.
#version 460
#extension GL_EXT_scalar_block_layout : require
layout(local_size_x = 8, local_size_y = 4, local_size_z = 1) in;
layout(constant_id = 0) const uint DOUBLE = 0;
layout(set = 0, binding = 0) uniform sampler2D src;
layout(set = 0, binding = 1, r32f) uniform writeonly image2D dst;
layout(set = 0, binding = 2, scalar) buffer readonly Bias { float bias; };
layout(push_constant, scalar) uniform Args { uvec2 size; };

void main()
{
    uvec2 p = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(p, size))) {
        return;
    }
    float l = texelFetch(src, ivec2((p.x + size.x - 1) % size.x, p.y), 0).x;
    float r = texelFetch(src, ivec2((p.x + 1) % size.x, p.y), 0).x;
    imageStore(dst, ivec2(p), vec4((l + r) * (DOUBLE == 1 ? 1.0 : 0.5) + bias));
}
