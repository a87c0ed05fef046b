// golden_probe.comp -- how this device rounds: functions, products and sums, and filtering, at many places.
#version 460
#extension GL_EXT_scalar_block_layout : require

layout(local_size_x = 64) in;

layout(binding = 0) uniform sampler3D table;
layout(binding = 1, scalar) readonly buffer points_buffer
{
    vec4 points[];
};
layout(binding = 2, scalar) writeonly buffer results_buffer
{
    vec4 results[];
};

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= uint(points.length())) {
        return;
    }
    vec4 p = points[i];
    float a = p.x * p.y + p.z * p.w - p.x * p.w;
    float b = exp(-4.0 * p.x) + log(0.01 + p.y) + pow(0.1 + p.z, 3.0 * p.w) + exp2(8.0 * p.z - 4.0);
    float c = sin(6.0 * p.x) + cos(6.0 * p.y) + inversesqrt(0.01 + p.z) + sqrt(p.w) + atan(p.x - 0.5, p.y) + acos(p.z);
    float d = textureLod(table, p.xyz, 0.0).x / (0.1 + p.w) + fma(p.x, p.y, p.z) + dot(p.xyz, p.yzw);
    results[i] = vec4(a, b, c, d);
}
