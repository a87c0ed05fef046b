// ceiling_trilinear.comp -- as many trilinear fetches of single floats as a device can do: every thread walks
// a ray of its own through 64^3 texels, a texel a step, neighbours side by side, as a march does.
#version 460

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0, std430) writeonly buffer Result
{
    float result[];
};
layout(binding = 1) uniform sampler3D volume;

layout(push_constant) uniform Args
{
    uint rounds;
};

void main()
{
    uvec2 p = gl_GlobalInvocationID.xy;
    vec3 at = vec3(0.0, (vec2(p) + 0.5) / 256.0), along = vec3(1.0 / 64.0, 0.0, 0.0); // x wraps
    float sum = 0.0;
    for (uint n = 0u; n < rounds; n++) {
        sum += textureLod(volume, at, 0.0).r;
        sum += textureLod(volume, at + along, 0.0).r;
        sum += textureLod(volume, at + 2.0 * along, 0.0).r;
        sum += textureLod(volume, at + 3.0 * along, 0.0).r;
        at.x = fract(at.x + 4.0 / 64.0);
    }
    result[p.y * 256u + p.x] = sum;
}
