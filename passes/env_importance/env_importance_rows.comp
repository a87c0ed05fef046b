// env_importance_rows.comp -- sums along the rows; a workgroup per row.
#include "shaders/light/sky.glsl"

layout(local_size_x = SKY_SUMS_WIDTH) in;
layout(binding = 0, rgba32f) uniform readonly image2D sky;
TYN_WRITE(1, sums, float sums[]); // 8 of each sky_sum

shared float values[8][SKY_SUMS_WIDTH];

void main()
{
    const int x = int(gl_LocalInvocationIndex), y = int(gl_WorkGroupID.y);
    const ivec2 fine = ivec2(SKY_WIDTH, SKY_HEIGHT);
    const ivec2 ratio = fine / ivec2(SKY_SUMS_WIDTH, SKY_SUMS_HEIGHT);
    vec3 power = vec3(0.0), moment = vec3(0.0);
    float luminance = 0.0;
    for (int j = y * ratio.y; j < (y + 1) * ratio.y; j++) {
        float solid_angle = sky_texel_solid_angle(j, fine);
        float polar = (float(j) + 0.5) * SKY_PI / float(fine.y);
        for (int i = x * ratio.x; i < (x + 1) * ratio.x; i++) {
            vec4 texel = imageLoad(sky, ivec2(i, j));
            float azimuth = ((float(i) + 0.5) / float(fine.x) - 0.5) * 2.0 * SKY_PI;
            power += solid_angle * texel.rgb;
            luminance += texel.a;
            moment +=
                texel.a * vec3(sin(polar) * sin(azimuth), cos(polar), -sin(polar) * cos(azimuth));
        }
    }
    for (int c = 0; c < 3; c++) {
        values[c][x] = power[c];
        values[4 + c][x] = moment[c];
    }
    values[3][x] = luminance;
    values[7][x] = 0.0;
    barrier();
    // Entry (0, y + 1) is zero.
    if (x < 8) {
        uint entry = uint(y + 1) * (SKY_SUMS_WIDTH + 1) * 8u + uint(x);
        float sum = 0.0;
        sums[entry] = 0.0;
        for (uint i = 0u; i < SKY_SUMS_WIDTH; i++) {
            sum += values[x][i];
            sums[entry + (i + 1u) * 8u] = sum;
        }
    }
}
