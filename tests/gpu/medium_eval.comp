// medium_eval.comp -- the medium at given points.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define MEDIUM_AT 0
#include "shaders/medium/medium.glsl"

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
