// medium_eval.comp -- the medium at given points.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define MEDIUM_BLOCK 0
#define MEDIUM_DENSITY 1
#define MEDIUM_SIGMA_A 2
#define MEDIUM_G 3
#define MEDIUM_EMISSION 4
#include "medium.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 5, scalar) readonly buffer points_buffer { vec3 points[]; };
layout(set = 0, binding = 6, scalar) writeonly buffer results_buffer { medium_point results[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i < points.length()) {
        results[i] = medium_sample(points[i]);
    }
}
