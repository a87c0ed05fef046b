// refine_blend.comp -- from the fit towards the samples themselves, as far as these differ by more than their noise: with many
// samples the picture is theirs. Shrinkage after James and Stein: of the sum over the picture, over a window, of pixels. A thread a
// pixel.
#include "refine.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D fitted_tex;
layout(binding = 1) uniform sampler2D samples_tex;
TYN_READ(2, residuals, refine_residuals residuals[]);
TYN_READ(6, totals, refine_totals totals);
layout(binding = 3, rgba32f) writeonly uniform image2D radiance_image;
layout(binding = 4) uniform sampler2D noise_tex;
layout(binding = 5, rgba32f) uniform image2D error_image;

void main()
{
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, args.picture)) || args.unfinished != 0u) { // an unfinished record fits one group only
        return;
    }
    const ivec2 tiles = ivec2((args.picture + 7u) / 8u);
    const vec2 place = (vec2(pixel) + 0.5) / 8.0 - 0.5;
    const ivec2 first = ivec2(floor(place));
    const vec2 t = place - vec2(first);
    refine_residuals sum = REFINE_NO_RESIDUALS;
    // A tent over 4 x 4 tiles: one tile's 64 pixels are too few to tell noise from error.
    for (int k = 0; k < 16; k++) {
        const ivec2 away = ivec2(k & 3, k >> 2) - 1, at = first + away;
        if (all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, tiles))) {
            const vec2 w = max(1.0 - abs(vec2(away) - t) / 2.0, 0.0);
            sum = refine_add(sum, residuals[uint(at.y * tiles.x + at.x)], w.x * w.y);
        }
    }
    const float share = sum.difference > 0.0 ? clamp(1.0 - args.noise * sum.noise / sum.difference, 0.0, 1.0) : 0.0;
    vec4 fit = texelFetch(fitted_tex, ivec2(pixel), 0);
    fit.rgb *= refine_level(sum, totals.level, 4.0);
    const vec3 found = texelFetch(samples_tex, ivec2(pixel), 0).rgb;
    const bool good = !(any(isnan(found)) || any(isinf(found)));
    imageStore(radiance_image, ivec2(pixel), vec4(good ? mix(fit.rgb, found, share) : fit.rgb, fit.a));
    if (good) {
        const vec3 noise = texelFetch(noise_tex, ivec2(pixel), 0).rgb, error = (1.0 - share) * imageLoad(error_image, ivec2(pixel)).rgb;
        imageStore(error_image, ivec2(pixel), vec4(sqrt(error * error + share * share * noise * noise), 0.0));
    }
}
