// vpl_eval.comp -- vpl.glsl and disc.glsl at points, for the test of them.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "passes/shade/vpl.glsl"
#include "passes/lattice_lamps/disc.glsl"

layout(local_size_x = 64) in;
struct point {
    vec3 p, n, position, axis;
    float radius;
};
layout(binding = 0, scalar) readonly buffer point_buffer
{
    point points[];
};
layout(binding = 1, scalar) writeonly buffer result_buffer
{
    vec2 results[]; // irradiance on the plane, fluence
};

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i < uint(points.length())) {
        point q = points[i];
        light_block light =
            light_block(q.position, TYN_LIGHT_KIND_COSINE, vec3(1.0), 1.0, q.axis, 0.0, q.radius, TYN_LIGHT_NO_SHADOW, 1.0, 0u);
        results[i] = vec2(vpl_irradiance(light, q.p, q.n), disc_light_at(q.p - q.position, q.axis, q.radius).fluence);
    }
}
