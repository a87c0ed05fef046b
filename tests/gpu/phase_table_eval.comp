// phase_table_eval.comp -- evaluation and sampling of a phase function's table at given (1 - mu, u, table).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/common/shared.h"
#define PHASE_TABLES 0
#define PHASE_TABLED true
#include "shaders/phase/phase.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint unused = 0u;
layout(set = 0, binding = 1, scalar) readonly buffer points_buffer { vec4 points[]; };
struct result {
    float phase, sample_one_minus_mu;
};
layout(set = 0, binding = 2, scalar) writeonly buffer results_buffer { result results[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= points.length()) {
        return;
    }
    phase p = phase_of_mean_cosine(0.0);
    p.table = uint(points[i].z);
    results[i] = result(phase_near(p, 1.0, points[i].x), phase_sample(p, points[i].y));
}
