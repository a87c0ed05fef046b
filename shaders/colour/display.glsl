// display.glsl -- from scene-linear radiance to what a screen is sent.
#ifndef TYN_DISPLAY_GLSL
#define TYN_DISPLAY_GLSL

// Narkowicz's fit (2015) to the ACES reference and output transforms, per channel: a toe, a shoulder
// that reaches 1 near 6, middle grey kept by the factor 0.6 that the fit is made for.
vec3 display_filmic(vec3 x)
{
    x *= 0.6;
    return clamp((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}

// IEC 61966-2-1.
vec3 display_srgb_encode(vec3 x)
{
    vec3 power = 1.055 * pow(max(x, vec3(0.0031308)), vec3(1.0 / 2.4)) - 0.055;
    return mix(power, 12.92 * x, lessThanEqual(x, vec3(0.0031308)));
}

// 8x8 Bayer matrix: threshold in (0, 1) of a pixel, its bits interleaved in reverse.
float display_bayer(uvec2 p)
{
    uint x = p.x ^ p.y, y = p.y;
    uint v = (x & 1u) << 5 | (y & 1u) << 4 | (x & 2u) << 2 | (y & 2u) << 1 | (x & 4u) >> 1 |
             (y & 4u) >> 2;
    return (float(v) + 0.5) / 64.0;
}

#endif
