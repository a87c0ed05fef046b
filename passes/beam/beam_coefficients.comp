// beam_coefficients.comp -- coefficients integrated along each sun; x, y: column, z: sun.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define MEDIUM_AT 0
#include "shaders/medium/medium.glsl"
#include "shaders/beams/beam_args.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 5, scalar) buffer beam_buffer
{
    beam_block beams[];
};
layout(set = 0, binding = 6, rgba32f) writeonly uniform image3D tau_s_image;
layout(set = 0, binding = 7, rgba32f) writeonly uniform image3D tau_a_image;
layout(set = 0, binding = 8, rgba32f) writeonly uniform image3D tau_p_image;

#define BEAM_VALUE mat3x4 // sigma_s, sigma_a, (1 - f) sigma_s; w is the mean of the channels

vec4 with_mean(vec3 v)
{
    return vec4(v, (v.x + v.y + v.z) / 3.0);
}

mat3x4 beam_value(vec3 uvw)
{
    vec3 sigma_s = textureLod(medium_density_tex, uvw, 0.0).rgb;
    vec3 sigma_a = textureLod(medium_sigma_a_tex, uvw, 0.0).rgb;
    vec3 g = textureLod(medium_g_tex, uvw, 0.0).rgb;
    similarity_clamp(sigma_s, g);
    return mat3x4(with_mean(sigma_s), with_mean(sigma_a), with_mean(sigma_s * (1.0 - delta_fraction(g))));
}

vec4 finite(vec4 v)
{
    return mix(v, vec4(0.0), bvec4(uvec4(isnan(v)) | uvec4(isinf(v))));
}

bool beam_any(mat3x4 value)
{
    return value[0].w + value[1].w > 0.0;
}

void beam_store(ivec3 texel, mat3x4 value)
{
    imageStore(tau_s_image, texel, finite(value[0]));
    imageStore(tau_a_image, texel, finite(value[1]));
    imageStore(tau_p_image, texel, finite(value[2]));
}
#include "beam_sweep.glsl"

void main()
{
    uvec2 column = gl_GlobalInvocationID.xy;
    uint sun = gl_WorkGroupID.z;
    if (all(lessThan(column, beams[sun].nodes.xy)) && beam_sweep(beams[sun], column)) {
        atomicOr(beams[sun].edges, 1u);
    }
}
