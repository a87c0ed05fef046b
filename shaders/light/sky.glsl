// sky.glsl -- solid angles of latitude-longitude texels.
#ifndef TYN_SKY_GLSL
#define TYN_SKY_GLSL
#include "sky_args.h"

const float SKY_PI = 3.14159265359;

float sky_luminance(vec3 rgb)
{
    return dot(rgb, vec3(0.2126, 0.7152, 0.0722));
}

// Integral of sin(theta) over a band of polar angles: solid angle per radian of azimuth.
float sky_band(float middle, float height)
{
    return 2.0 * sin(middle) * sin(0.5 * height);
}

float sky_texel_solid_angle(int row, ivec2 size)
{
    float h = SKY_PI / float(size.y);
    float from_pole = float(min(row, size.y - 1 - row)) + 0.5; // the nearer: sin is exact there
    return sky_band(from_pole * h, h) * 2.0 * SKY_PI / float(size.x);
}

#endif
