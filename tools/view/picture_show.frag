// picture_show.frag -- a pixel of the window: the method's picture, right of the split the reference's, as seen by the eye.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/colour/display.glsl"
#include "tools/view/picture_args.h"

layout(binding = 0) uniform sampler2D picture;
layout(binding = 1) uniform sampler2D reference;
layout(location = 0) out vec4 color;

layout(push_constant) uniform Args
{
    picture_args args;
};

vec3 tone(vec3 x)
{
    // Values beyond 1e6 are white under any curve; the bound keeps the curve's quotient finite.
    x = clamp(x * args.scale, 0.0, 1e6);
    if (args.curve == PICTURE_CURVE_FILMIC) {
        return display_filmic(x);
    }
    return args.curve == PICTURE_CURVE_REINHARD ? x / (1.0 + x) : min(x, vec3(1.0));
}

void main()
{
    vec2 at = gl_FragCoord.xy / vec2(args.width, args.height);
    vec4 texel = gl_FragCoord.x < args.split ? texture(picture, at) : texture(reference, at);
    vec3 shown;
    if (args.shows == PICTURE_SHOWS_RADIANCE) {
        shown = display_srgb_encode(tone(texel.rgb));
    } else if (args.shows == PICTURE_SHOWS_VALUES) {
        shown = (texel.rgb - args.low) / (args.high - args.low);
    } else {
        bool there = texel.r > 0.0 && texel.r < 3e38;
        shown = vec3(there ? 1.0 - 0.9 * (texel.r - args.low) / (args.high - args.low) : 0.0);
    }
    color = vec4(clamp(shown, 0.0, 1.0) + (display_bayer(uvec2(gl_FragCoord.xy)) - 0.5) / 255.0, 1.0);
}
