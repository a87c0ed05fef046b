// refine_apply.comp -- the refined picture: layers of full resolution times coefficients between cells; and how far it, and pop, is
// off. A thread a pixel.
#include "refine.glsl"
#include "shaders/common/counters.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D base_tex;
layout(binding = 1) uniform sampler2D single_tex;
layout(binding = 2) uniform sampler2D final_tex;
TYN_READ(3, totals, refine_totals totals);
layout(binding = 6) uniform sampler2D errors_tex;
layout(binding = 7, rgba32f) writeonly uniform image2D error_image;
layout(binding = 8, rgba32f) writeonly uniform image2D bias_image;
layout(binding = 4, rgba32f) writeonly uniform image2D radiance_image;
TYN_UPDATE(5, counters, counters_block counters);

vec3 coefficients(uint plane, vec2 at)
{
    return textureLod(final_tex, (vec2(float(plane * args.cells.x), 0.0) + at) / vec2(textureSize(final_tex, 0)), 0.0).rgb;
}

void main()
{
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, args.picture)) || args.unfinished != 0u) { // an unfinished record fits one group only
        return;
    }
    const vec4 base = texelFetch(base_tex, ivec2(pixel), 0);
    const vec3 single = texelFetch(single_tex, ivec2(pixel), 0).rgb;
    const vec2 at = clamp((vec2(pixel) + 0.5) / float(2u * args.grid), vec2(0.5), vec2(args.cells) - 0.5);
    const vec3 change = coefficients(0u, at) * base.rgb + coefficients(1u, at) * single + coefficients(2u, at);
    vec3 light = base.rgb + totals.share * change;
    if (any(isnan(light)) || any(isinf(light))) {
        atomicAdd(counters.non_finite, 1u);
        light = base.rgb;
    } else if (any(lessThan(light, vec3(0.0)))) {
        atomicAdd(counters.clamped, 1u);
    }
    light = max(light, 0.0);
    imageStore(radiance_image, ivec2(pixel), vec4(light, base.a));
    const vec2 squares = textureLod(errors_tex, at / float(REFINE_TILE) / vec2(textureSize(errors_tex, 0)), 0.0).rg;
    const vec3 unit = totals.mean * refine_unit(light, totals.mean);
    imageStore(bias_image, ivec2(pixel), vec4(sqrt(squares.x * unit) + args.known * light, 0.0));
    imageStore(error_image, ivec2(pixel), vec4(sqrt(squares.y * unit) + args.known * light, 0.0));
}
