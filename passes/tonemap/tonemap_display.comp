// tonemap_display.comp -- one pixel of the display transform.
#include "shaders/colour/display.glsl"
#include "tonemap_args.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2D radiance;
layout(binding = 1, rgba8) uniform writeonly image2D display;

TYN_ARGS(tonemap_args args);

void main()
{
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, imageSize(display)))) {
        return;
    }
    vec4 c = texelFetch(radiance, p, 0);
    float alpha = args.opaque != 0u ? 1.0 : clamp(c.a, 0.0, 1.0);
    // Values beyond 1e6 are white under any curve; the bound keeps the curve's quotient finite.
    vec3 color = clamp(c.rgb * (args.scale / max(alpha, 1e-4)), 0.0, 1e6);
    color = args.filmic != 0u ? display_filmic(color) : min(color, vec3(1.0));
    color = display_srgb_encode(color);
    if (args.dither != 0u) {
        color += (display_bayer(uvec2(p)) - 0.5) / 255.0;
    }
    imageStore(display, p, vec4(color, alpha));
}
