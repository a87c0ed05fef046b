// radial_beam_coefficients.comp -- mean coefficients around local lights; a thread per direction.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define MEDIUM_AT 0
#include "shaders/medium/medium.glsl"
#include "shaders/beams/radial_args.h"
#include "radial_beam_args.h"

layout(local_size_x = RADIAL_GROUP * RADIAL_GROUP) in;
layout(push_constant, scalar) uniform push
{
    radial_beam_args args;
};
layout(set = 0, binding = 5, scalar) readonly buffer radial_buffer
{
    uint radial_count, radial_num_lamps;
    uvec2 radial_pad;
    radial_grid radials[];
};
layout(set = 0, binding = 6, rgba32f) writeonly uniform image3D tau_s_image;
layout(set = 0, binding = 7, rgba32f) writeonly uniform image3D tau_a_image;
layout(set = 0, binding = 8, rgba32f) writeonly uniform image3D tau_p_image;

#define RADIAL_VALUE mat3 // sigma_s, sigma_a, (1 - f) sigma_s

mat3 radial_value(vec3 uvw)
{
    vec3 sigma_s = textureLod(medium_density_tex, uvw, 0.0).rgb;
    vec3 sigma_a = textureLod(medium_sigma_a_tex, uvw, 0.0).rgb;
    vec3 g = textureLod(medium_g_tex, uvw, 0.0).rgb;
    similarity_clamp(sigma_s, g);
    return mat3(sigma_s, sigma_a, sigma_s * (1.0 - delta_fraction(g)));
}

vec4 finite(vec3 v)
{
    return vec4(mix(v, vec3(0.0), bvec3(uvec3(isnan(v)) | uvec3(isinf(v)))), 0.0);
}

void radial_store(ivec3 texel, mat3 value)
{
    imageStore(tau_s_image, texel, finite(value[0]));
    imageStore(tau_a_image, texel, finite(value[1]));
    imageStore(tau_p_image, texel, finite(value[2]));
}
#include "radial_sweep.glsl"

void main()
{
    uint n;
    ivec2 texel;
    if (radial_thread(n, texel)) {
        radial_sweep(n, texel);
    }
}
