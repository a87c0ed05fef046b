// medium_eval.comp -- the medium at given points.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define MEDIUM_AT 0
#include "shaders/medium/medium.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 5, scalar) readonly buffer points_buffer { vec3 points[]; };
layout(set = 0, binding = 6, scalar) writeonly buffer results_buffer { vec3 results[][4]; }; // sigma_s, sigma_a, mean cosines, emission

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i < points.length()) {
        medium_point m = medium_sample(points[i]);
        results[i] = vec3[4](m.sigma_s, m.sigma_a, phase_mean_cosine(m.phase), m.emission);
    }
}
