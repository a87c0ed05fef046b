// ordinates.glsl -- rectangles of the sky: sums over them, their geometry, cuts that share their light.
//
// Include after the declarations of `environment`, `sums` and `weights`.
//
// A position on the map is in texels of the sums. Down a row it advances with the solid angle, so a
// row's light and its solid angle are shared out alike, and everything is linear within a texel.
#ifndef TYN_ORDINATES_GLSL
#define TYN_ORDINATES_GLSL
#include "sky.glsl"

struct ordinates_region {
    vec2 from, to;
};

// What a cut shares out: light from a table, and `uniform_part` per sr.
#define ORDINATES_NO_TABLE 0u
#define ORDINATES_SUMS 1u    // luminance
#define ORDINATES_WEIGHTS 2u // luminance x importance
struct ordinates_density {
    uint table;
    float uniform_part;
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
    return 2.0 * asin(sqrt(clamp(0.5 * ordinates_drop(y), 0.0, 1.0)));
}

float ordinates_azimuth(float x)
{
    return (x / float(SKY_SUMS_WIDTH) - 0.5) * 2.0 * SKY_PI;
}

float ordinates_solid_angle(ordinates_region r)
{
    return (r.to.x - r.from.x) * (2.0 * SKY_PI / float(SKY_SUMS_WIDTH)) *
           (ordinates_drop(r.to.y) - ordinates_drop(r.from.y));
}

// Integral of the direction over a region, map frame.
vec3 ordinates_vector(ordinates_region r)
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

float ordinates_scalar(uint entry, uint table)
{
    if (table == ORDINATES_NO_TABLE) {
        return 0.0;
    }
    return table == ORDINATES_WEIGHTS ? weights[entry] : sums[entry].luminance;
}

// Light between the map's first corner and p.
float ordinates_corner(vec2 p, uint table)
{
    vec2 f;
    uint e = ordinates_entry(p, f);
    return mix(mix(ordinates_scalar(e, table), ordinates_scalar(e + 1u, table), f.x),
               mix(ordinates_scalar(e + ORDINATES_ROW, table),
                   ordinates_scalar(e + ORDINATES_ROW + 1u, table), f.x),
               f.y);
}

float ordinates_light(ordinates_region r, uint table)
{
    return ordinates_corner(r.to, table) - ordinates_corner(vec2(r.from.x, r.to.y), table) -
           ordinates_corner(vec2(r.to.x, r.from.y), table) + ordinates_corner(r.from, table);
}

float ordinates_mass(ordinates_region r, ordinates_density density)
{
    return ordinates_light(r, density.table) + density.uniform_part * ordinates_solid_angle(r);
}

// All of it: xyz power, w luminance; and the moment.
void ordinates_corner_sums(vec2 p, float sign, inout vec4 power, inout vec3 moment)
{
    vec2 f;
    uint e = ordinates_entry(p, f);
    vec4 share = vec4((1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y);
    for (uint k = 0u; k < 4u; k++) {
        sky_sum s = sums[e + (k & 1u) + (k >> 1) * ORDINATES_ROW];
        power += sign * share[k] * vec4(s.power, s.luminance);
        moment += sign * share[k] * s.moment;
    }
}

// Where `part` of the mass lies to the left of (axis 0) or above (axis 1) the cut.
float ordinates_cut(ordinates_region r, uint axis, float part, ordinates_density density)
{
    float target = part * ordinates_mass(r, density);
    // The bracket shrinks to a piece of one texel, in which mass grows linearly.
    vec2 at = vec2(r.from[axis], r.to[axis]), mass = vec2(0.0, target / part);
    for (int i = 0; i < 8; i++) {
        float middle = max(floor(0.5 * (at.x + at.y)), floor(at.x) + 1.0);
        bool between = middle < at.y;
        ordinates_region piece = r;
        piece.to[axis] = between ? middle : at.y;
        float m = ordinates_mass(piece, density);
        bool left = m < target;
        at = !between ? at : left ? vec2(middle, at.y) : vec2(at.x, middle);
        mass = !between ? mass : left ? vec2(m, mass.y) : vec2(mass.x, m);
    }
    float rise = mass.y - mass.x;
    return mix(at.x, at.y, rise > 0.0 ? clamp((target - mass.x) / rise, 0.0, 1.0) : 0.5);
}

// Solid angle of a region by which its directions miss each other: 0 for a point, least for a cap.
float ordinates_width(ordinates_region r)
{
    return ordinates_solid_angle(r) - length(ordinates_vector(r));
}

void ordinates_divide(ordinates_region r, uint axis, float cut, out ordinates_region lower,
                      out ordinates_region upper)
{
    lower = r;
    upper = r;
    lower.to[axis] = cut;
    upper.from[axis] = cut;
}

// The axis whose cut leaves the more compact pieces: 0 across, 1 down.
uint ordinates_axis(ordinates_region r, float part, ordinates_density density)
{
    vec2 width;
    for (uint axis = 0u; axis < 2u; axis++) {
        ordinates_region lower, upper;
        ordinates_divide(r, axis, ordinates_cut(r, axis, part, density), lower, upper);
        width[axis] = ordinates_width(lower) + ordinates_width(upper);
    }
    // Even maps must not depend on rounding.
    return width.y < 0.999 * width.x ? 1u : 0u;
}

#endif
