// false_colour_show.comp -- the colour of a pixel: from dark blue over green to yellow, as bright as the value is large.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "false_colour_args.h"

layout(local_size_x = 8, local_size_y = 8) in;
TYN_ARGS(false_colour_args args);
layout(binding = 0) uniform sampler2D radiance_tex;
layout(binding = 1) uniform sampler2D transmittance_tex;
layout(binding = 2) uniform sampler2D depth_tex;
layout(binding = 3, rgba32f) uniform writeonly image2D colours_image;

// Knots in linear RGB, evenly spaced in the value.
const vec3 KNOTS[5] = vec3[](vec3(0.058, 0.0003, 0.089), vec3(0.043, 0.084, 0.258), vec3(0.014, 0.283, 0.263),
                             vec3(0.112, 0.584, 0.122), vec3(0.983, 0.799, 0.018));

void main()
{
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, imageSize(colours_image)))) {
        return;
    }
    float t = dot(texelFetch(transmittance_tex, p, 0).rgb, vec3(1.0 / 3.0));
    float value = args.of == FALSE_COLOUR_DISTANCE        ? texelFetch(depth_tex, p, 0).y
                  : args.of == FALSE_COLOUR_TRANSMITTANCE ? t
                                                          : -log(max(t, 1e-30));
    float x = 4.0 * clamp(value / args.most, 0.0, 1.0); // infinity, where nothing is hidden, is the last colour
    int k = min(int(x), 3);
    imageStore(colours_image, p, vec4(mix(KNOTS[k], KNOTS[k + 1], x - float(k)), texelFetch(radiance_tex, p, 0).a));
}
