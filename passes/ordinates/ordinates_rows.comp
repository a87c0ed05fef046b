// ordinates_rows.comp -- luminance times importance, summed along the rows; a workgroup per row.
#include "shaders/common/uniform_branch.glsl"
#include "shaders/light/environment.glsl"
#include "shaders/light/sky.glsl"
#include "ordinates_args.h"

layout(local_size_x = SKY_SUMS_WIDTH) in;
TYN_ARGS(ordinates_args args);
layout(binding = 0) uniform sampler2D sky;
layout(binding = 1) uniform sampler2D importance_wrapped;
TYN_WRITE(2, weights, float weights[]);

const int LEVEL = 2; // of the sky: SKY_SUMS_WIDTH x SKY_SUMS_HEIGHT

shared float values[SKY_SUMS_WIDTH];

void main()
{
    const int x = int(gl_LocalInvocationIndex), y = int(gl_WorkGroupID.y);
    const ivec2 size = ivec2(SKY_SUMS_WIDTH, SKY_SUMS_HEIGHT);
    float azimuth = ((float(x) + 0.5) / float(size.x) - 0.5) * 2.0 * SKY_PI;
    float polar = (float(y) + 0.5) / float(size.y) * SKY_PI;
    vec3 d = vec3(sin(polar) * sin(azimuth), cos(polar), -sin(polar) * cos(azimuth));
    // The rows are an orthonormal frame: their transpose leads back to M.
    vec3 d_M = args.rows[0].xyz * d.x + args.rows[1].xyz * d.y +
               args.rows[2].xyz * d.z;
    float luminance = uniform_branch(args.mapped == 0u) ? sky_texel_solid_angle(y, size)
                                                : texelFetch(sky, ivec2(x, y), LEVEL).a;
    values[x] = luminance * max(textureLod(importance_wrapped, environment_uv(d_M), 0.0).r, 0.0);
    barrier();
    if (x == 0) {
        uint entry = uint(y + 1) * (SKY_SUMS_WIDTH + 1);
        float sum = 0.0;
        weights[entry] = 0.0;
        for (uint i = 0u; i < SKY_SUMS_WIDTH; i++) {
            sum += values[i];
            weights[entry + i + 1u] = sum;
        }
    }
}
