// propagate_rect_shrink_coefficients.comp -- the coefficients at a resolution that suits the cells of
// many grids.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define MEDIUM_AT 0
#include "shaders/medium/medium.glsl"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
layout(set = 0, binding = 5, rgba32f) uniform writeonly image3D out_sigma_s;
layout(set = 0, binding = 6, rgba32f) uniform writeonly image3D out_sigma_a;
layout(set = 0, binding = 7, rgba32f) uniform writeonly image3D out_g;
#include "propagate_shrink.glsl"

void main()
{
    ivec3 texel = ivec3(gl_GlobalInvocationID), size = imageSize(out_g);
    if (any(greaterThanEqual(texel, size))) {
        return;
    }
    ivec3 along = shrink_samples(size);
    vec3 sigma_s = vec3(0.0), sigma_a = vec3(0.0), g = vec3(0.0);
    for (int n = 0; n < along.x * along.y * along.z; n++) {
        medium_point m = medium_sample(shrink_sample(texel, size, along, n));
        sigma_s += m.sigma_s;
        sigma_a += m.sigma_a;
        g += m.sigma_s * m.g;
    }
    float each = 1.0 / float(along.x * along.y * along.z);
    imageStore(out_sigma_s, texel, vec4(sigma_s * each, 0.0));
    imageStore(out_sigma_a, texel, vec4(sigma_a * each, 0.0));
    imageStore(out_g, texel, vec4(g / max(sigma_s, vec3(1e-30)), 0.0));
}
