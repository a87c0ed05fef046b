// ordinates_region.glsl -- rectangles of the sky and their geometry.
//
// A position on the map is in texels of the sums. Down a row it advances with the solid angle, so a
// row's light and its solid angle are shared out alike, and everything is linear within a texel.
#include "shaders/light/sky.glsl"

struct ordinates_region {
    vec2 from, to;
};

// 1 - cos(theta) at a height.
float ordinates_drop(float y)
{
    float row = min(floor(y), float(SKY_SUMS_HEIGHT - 1)), h = SKY_PI / float(SKY_SUMS_HEIGHT);
    float top = sin(0.5 * row * h), bottom = sin(0.5 * (row + 1.0) * h);
    return 2.0 * mix(top * top, bottom * bottom, y - row);
}

float ordinates_polar(float y)
{
    // The root of 1 may be 1 + 2 ulps on a card, whose arc sine is no number.
    return 2.0 * asin(min(sqrt(max(0.5 * ordinates_drop(y), 0.0)), 1.0));
}

float ordinates_azimuth(float x)
{
    return (x / float(SKY_SUMS_WIDTH) - 0.5) * 2.0 * SKY_PI;
}

float ordinates_solid_angle(const ordinates_region r)
{
    return (r.to.x - r.from.x) * (2.0 * SKY_PI / float(SKY_SUMS_WIDTH)) *
           (ordinates_drop(r.to.y) - ordinates_drop(r.from.y));
}

// Integral of the direction over a region, map frame.
vec3 ordinates_vector(const ordinates_region r)
{
    vec2 polar = vec2(ordinates_polar(r.from.y), ordinates_polar(r.to.y));
    vec2 azimuth = vec2(ordinates_azimuth(r.from.x), ordinates_azimuth(r.to.x));
    vec2 level = 0.5 * (polar - sin(polar) * cos(polar));
    vec2 upright = 0.5 * sin(polar) * sin(polar);
    return vec3((level.y - level.x) * (cos(azimuth.x) - cos(azimuth.y)),
                (upright.y - upright.x) * (azimuth.y - azimuth.x),
                -(level.y - level.x) * (sin(azimuth.y) - sin(azimuth.x)));
}

// First of the four entries around a position, and where between them.
uint ordinates_entry(vec2 p, out vec2 f)
{
    vec2 texel = min(floor(p), vec2(SKY_SUMS_WIDTH - 1, SKY_SUMS_HEIGHT - 1));
    f = p - texel;
    return uint(texel.y) * (SKY_SUMS_WIDTH + 1) + uint(texel.x);
}

const uint ORDINATES_ROW = SKY_SUMS_WIDTH + 1;

// Solid angle of a region by which its directions miss each other: 0 for a point, least for a cap.
float ordinates_width(const ordinates_region r)
{
    return ordinates_solid_angle(r) - length(ordinates_vector(r));
}
