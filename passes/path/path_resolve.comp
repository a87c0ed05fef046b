// path_resolve.comp -- merges what the threads of each pixel found into the pixel's running statistics and
// writes the image so far. One thread a pixel, in a fixed order.
#include "shaders/path/path_args.h"
#include "shaders/common/scene_args.h"

layout(local_size_x = 64) in;

TYN_READ(0, partials, path_partial partials[]);
TYN_READ(1, layers, path_partial_layers layers[]);
layout(set = 0, binding = 2, rgba32f) uniform image2D mean_image;
layout(set = 0, binding = 3, rgba32f) uniform image2D low_image;
layout(set = 0, binding = 4, rgba32f) uniform image2D deviation_image;
layout(set = 0, binding = 5, rgba32f) uniform image2D mean_single_image;
layout(set = 0, binding = 6, rgba32f) uniform image2D mean_multiple_image;
layout(set = 0, binding = 7, rgba32f) uniform image2D mean_transmittance_image;
layout(set = 0, binding = 8, rgba32f) uniform writeonly image2D radiance_image;
layout(set = 0, binding = 9, rgba32f) uniform writeonly image2D error_image;
layout(set = 0, binding = 10, rgba32f) uniform writeonly image2D single_image;
layout(set = 0, binding = 11, rgba32f) uniform writeonly image2D multiple_image;
layout(set = 0, binding = 12, rgba32f) uniform writeonly image2D transmittance_image;
TYN_UPDATE(13, queue, uint taken);
layout(binding = 14) uniform sampler2D resumed_tex;
layout(binding = 15) uniform sampler2D resumed_low_tex;
layout(binding = 16) uniform sampler2D resumed_deviation_tex;
layout(binding = 17) uniform sampler2D resumed_single_tex;
layout(binding = 18) uniform sampler2D resumed_multiple_tex;
layout(binding = 19) uniform sampler2D resumed_transmittance_tex;
TYN_ARGS(path_resolve_args args);

// Means of one pixel's layers.
struct layer_means {
    vec3 single, multiple, transmittance;
};

void main()
{
    uint thread = gl_GlobalInvocationID.x;
    if (thread >= args.num) {
        return;
    }
    if (thread == 0u) {
        taken = 0u; // for the next dispatch
    }
    uint element = args.first + thread;
    ivec2 pixel = ivec2(element % args.width, element / args.width);

    // What the threads of this record found. Chan, Golub and LeVeque's merge of means and sums of squared
    // deviations.
    vec4 sample_mean = vec4(0.0);
    vec3 sample_deviation = vec3(0.0);
    float added = 0.0;
    layer_means found = layer_means(vec3(0.0), vec3(0.0), vec3(0.0));
    for (uint i = thread * args.slots; i < (thread + 1u) * args.slots; i++) {
        float n = float(partials[i].count);
        if (n == 0.0) {
            continue;
        }
        float share = n / (added + n);
        vec4 delta = vec4(partials[i].mean, partials[i].alpha) - sample_mean;
        sample_mean += delta * share;
        sample_deviation += partials[i].deviation + delta.rgb * delta.rgb * (added * share);
        if (args.layers != 0u) {
            found.single += (layers[i].single - found.single) * share;
            found.multiple += (layers[i].multiple - found.multiple) * share;
            found.transmittance += (layers[i].transmittance - found.transmittance) * share;
        }
        added += n;
    }

    vec4 mean = vec4(0.0), low = vec4(0.0);
    vec3 deviation = vec3(0.0);
    float before = float(args.samples_before);
    if (args.resumed != 0u) {
        vec4 deviation_alpha = texelFetch(resumed_deviation_tex, pixel, 0);
        mean = vec4(texelFetch(resumed_tex, pixel, 0).rgb, deviation_alpha.a);
        low = texelFetch(resumed_low_tex, pixel, 0);
        deviation = deviation_alpha.rgb;
    } else if (args.samples_before > 0u) {
        mean = imageLoad(mean_image, pixel);
        low = imageLoad(low_image, pixel);
        deviation = imageLoad(deviation_image, pixel).rgb;
    }
    float total = max(before + added, 1.0);
    vec4 delta = sample_mean - mean;
    deviation += sample_deviation + delta.rgb * delta.rgb * (before * added / total);
    // Kahan: `low` keeps what single precision loses of the ever smaller steps.
    precise vec4 step_kept = delta * (added / total) - low;
    precise vec4 mean_next = mean + step_kept;
    precise vec4 low_next = (mean_next - mean) - step_kept;
    mean = mean_next;
    imageStore(mean_image, pixel, mean_next);
    imageStore(low_image, pixel, low_next);
    imageStore(deviation_image, pixel, vec4(deviation, mean.a));

    float alpha = args.opaque != 0u ? 1.0 : clamp(mean.a, 0.0, 1.0);
    imageStore(radiance_image, pixel, vec4(mean.rgb, alpha));
    // One standard error of the mean. A single sample says nothing about its spread: its size stands in.
    vec3 error = total > 1.5 ? sqrt(max(deviation, 0.0) / (total * (total - 1.0))) : abs(mean.rgb);
    imageStore(error_image, pixel, vec4(error, 0.0));

    if (args.layers != 0u) {
        layer_means now = layer_means(vec3(0.0), vec3(0.0), vec3(0.0));
        if (args.resumed != 0u) {
            now = layer_means(texelFetch(resumed_single_tex, pixel, 0).rgb, texelFetch(resumed_multiple_tex, pixel, 0).rgb,
                              texelFetch(resumed_transmittance_tex, pixel, 0).rgb);
        } else if (args.samples_before > 0u) {
            now = layer_means(imageLoad(mean_single_image, pixel).rgb, imageLoad(mean_multiple_image, pixel).rgb,
                              imageLoad(mean_transmittance_image, pixel).rgb);
        }
        float share = added / total;
        now.single += (found.single - now.single) * share;
        now.multiple += (found.multiple - now.multiple) * share;
        now.transmittance += (found.transmittance - now.transmittance) * share;
        imageStore(mean_single_image, pixel, vec4(now.single, 1.0));
        imageStore(mean_multiple_image, pixel, vec4(now.multiple, 1.0));
        imageStore(mean_transmittance_image, pixel, vec4(now.transmittance, 1.0));
        imageStore(single_image, pixel, vec4(now.single, 1.0));
        imageStore(multiple_image, pixel, vec4(now.multiple, 1.0));
        imageStore(transmittance_image, pixel, vec4(now.transmittance, 1.0));
    }
}
