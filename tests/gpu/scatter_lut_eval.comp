// scatter_lut_eval.comp -- the kernels at given depths and angles.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define SCATTER_LUT 0
#define SCATTER_LUT_BLOCK 1
#define SCATTER_LUT_SOFT true
#include "shaders/phase/scatter_lut.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint mixed = 0u;
struct point {
    float tau, one_minus_mu, g; // g and tau_p: mixed only
    uint channel;
    float tau_p;
    uint sun;
    float cosine; // mixed only
};
layout(set = 0, binding = 2, scalar) readonly buffer points_buffer { point points[]; };
layout(set = 0, binding = 3, scalar) writeonly buffer results_buffer { vec2 results[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= points.length()) {
        return;
    }
    point p = points[i];
    results[i] =
        mixed == 0u
            ? scatter_kernels(scatter_angle_of(p.sun, p.channel, p.one_minus_mu), p.tau)
            : scatter_kernels_mixed(lut.sun_set[p.sun], p.cosine, p.one_minus_mu, phase_of_mean_cosine(p.g), p.tau, p.tau_p);
}
