// beam_eval.comp -- optical depths at given points.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define MEDIUM_BLOCK 0
#include "shaders/medium/medium.glsl"
#define BEAMS_AT 1
#define BEAMS_STORAGE
#include "shaders/beams/beam.glsl"

layout(local_size_x = 64) in;
struct point {
    vec3 p;
    uint sun;
};
layout(set = 0, binding = 5, scalar) readonly buffer points_buffer { point points[]; };
layout(set = 0, binding = 6, scalar) writeonly buffer results_buffer { beam_tau results[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i < points.length()) {
        results[i] = beam_depth(points[i].sun, points[i].p);
    }
}
