// radial_eval.comp -- optical depths between local lights and given points.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define MEDIUM_BLOCK 0
#include "shaders/medium/medium.glsl"
#define RADIALS_AT 1
#define RADIALS_STORAGE
#include "shaders/beams/radial.glsl"

layout(local_size_x = 64) in;
struct point {
    vec3 p;
    uint light;
};
layout(set = 0, binding = 5, scalar) readonly buffer points_buffer { point points[]; };
layout(set = 0, binding = 6, scalar) writeonly buffer results_buffer { beam_tau results[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i < points.length()) {
        vec3 away = points[i].p - radials[points[i].light].light.position;
        results[i] = radial_tau(radial_place_of(points[i].light, away, length(away)));
    }
}
