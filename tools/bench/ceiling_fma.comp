// ceiling_fma.comp -- as many multiplications and additions as a device can do: chains that wait for nothing but
// themselves.
#version 460
#extension GL_EXT_control_flow_attributes : require

layout(local_size_x = 64) in;

layout(binding = 0, std430) writeonly buffer Result
{
    float result[];
};

layout(push_constant) uniform Args
{
    uint rounds;
};

void main()
{
    vec4 x[3];
    float t = float(gl_GlobalInvocationID.x & 63u) * 0.01;
    [[unroll]] for (int i = 0; i < 3; i++) {
        x[i] = vec4(t, t + 0.1, t + 0.2, t + 0.3) + float(i);
    }
    float a = 0.5 + 1e-3 * t, b = 0.25; // stays near 0.5
    for (uint n = 0u; n < rounds; n++) {
        [[unroll]] for (int k = 0; k < 8; k++) {
            [[unroll]] for (int i = 0; i < 3; i++) {
                x[i] = x[i] * a + b;
            }
        }
    }
    vec4 sum = x[0] + x[1] + x[2];
    result[gl_GlobalInvocationID.x] = sum.x + sum.y + sum.z + sum.w;
}
