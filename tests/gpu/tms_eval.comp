// tms_eval.comp -- the kernels of ordinates at given depths, angles and cones.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define TMS 0
#define SCATTER_LUT_BLOCK 1
#include "passes/merge/tms.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint mixed = 0u;
struct point {
    float tau, mu, part; // part: solid angle / (4 pi)
    uint channel;
    float g, tau_p; // mixed only
};
layout(set = 0, binding = 2, scalar) readonly buffer points_buffer { point points[]; };
layout(set = 0, binding = 3, scalar) writeonly buffer results_buffer { float results[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= points.length()) {
        return;
    }
    point p = points[i];
    float level = tms_level(p.part);
    results[i] = mixed == 0u ? tms_kernel(tms_row_of_channel(p.channel), p.mu, p.tau, level)
                             : tms_kernel_mixed(tms_last_of(phase_of_mean_cosine(p.g)), p.mu, p.tau, p.tau_p, level, 1.0 - p.part);
}
