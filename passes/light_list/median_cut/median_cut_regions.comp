// median_cut_regions.comp -- cuts the map into regions; one workgroup, which looks for the best cut of a region together.
#include "median_cut_args.h"
#include "shaders/light/sky.glsl"

layout(local_size_x = 64) in;
TYN_ARGS(median_cut_args args);
TYN_READ(0, sums, sky_sum sums[]);
TYN_WRITE(1, constellation, constellation_block constellation);

struct region {
    ivec2 first, end;
    float energy; // luminance of its power; negative: it can not be cut
};

shared region regions[TYN_CONSTELLATION_MAX];
shared float unevenness[SKY_SUMS_WIDTH]; // of each cut

// Polar angle and azimuth of an edge between texels of the sums.
float polar_of(int y)
{
    return SKY_PI * float(y) / float(SKY_SUMS_HEIGHT);
}

float azimuth_of(int x)
{
    return (float(x) / float(SKY_SUMS_WIDTH) - 0.5) * 2.0 * SKY_PI;
}

float solid_angle_of(ivec2 first, ivec2 end)
{
    const float a = polar_of(first.y), b = polar_of(end.y);
    return sky_band(0.5 * (a + b), b - a) * (azimuth_of(end.x) - azimuth_of(first.x));
}

// Of a radiance of 1 everywhere: the integrals of d(solid angle) and of the direction.
sky_sum uniform_sum(ivec2 first, ivec2 end)
{
    const float a = polar_of(first.y), b = polar_of(end.y);
    const float p = azimuth_of(first.x), q = azimuth_of(end.x);
    const float sin2 = 0.5 * (b - a) - 0.25 * (sin(2.0 * b) - sin(2.0 * a)); // of sin^2
    const float cos_sin = 0.5 * (sin(b) * sin(b) - sin(a) * sin(a));
    sky_sum s;
    s.luminance = solid_angle_of(first, end);
    s.power = vec3(s.luminance);
    s.moment = vec3(sin2 * (cos(p) - cos(q)), cos_sin * (q - p), -sin2 * (sin(q) - sin(p)));
    s.pad = 0.0;
    return s;
}

sky_sum entry(int x, int y)
{
    return sums[y * (SKY_SUMS_WIDTH + 1) + x];
}

sky_sum sum_of(ivec2 first, ivec2 end)
{
    if (args.map == 0u) {
        return uniform_sum(first, end);
    }
    const sky_sum a = entry(first.x, first.y), b = entry(end.x, first.y);
    const sky_sum c = entry(first.x, end.y), d = entry(end.x, end.y);
    // What is nearly equal first: of small regions little is left.
    return sky_sum(max((d.power - b.power) - (c.power - a.power), vec3(0.0)),
                   max((d.luminance - b.luminance) - (c.luminance - a.luminance), 0.0),
                   (d.moment - b.moment) - (c.moment - a.moment), 0.0);
}

// Is the region longer along x, where a texel is as wide as the cosine of the latitude makes it?
bool is_wide(const region r)
{
    const float middle = 0.5 * (polar_of(r.first.y) + polar_of(r.end.y));
    const float width = float(r.end.x - r.first.x) / float(SKY_SUMS_WIDTH) * 2.0 * sin(middle);
    const float height = float(r.end.y - r.first.y) / float(SKY_SUMS_HEIGHT);
    const ivec2 texels = r.end - r.first;
    return texels.y < 2 || (texels.x >= 2 && width > height);
}

region region_of(ivec2 first, ivec2 end)
{
    const bool single = all(lessThan(end - first, ivec2(2)));
    const float energy = sum_of(first, end).luminance;
    return region(first, end, single ? -1.0 : energy);
}

constellation_light light_of(const region r)
{
    const sky_sum s = sum_of(r.first, r.end);
    const float middle = 0.5 * (polar_of(r.first.y) + polar_of(r.end.y));
    const float azimuth = 0.5 * (azimuth_of(r.first.x) + azimuth_of(r.end.x));
    const float apart = length(s.moment);
    // Light from all around has no centroid.
    const bool has = apart > 1e-4 * s.luminance;
    const vec3 central = vec3(sin(middle) * sin(azimuth), cos(middle), -sin(middle) * cos(azimuth));
    constellation_light light;
    light.direction = has ? s.moment / apart : central;
    light.luminance = s.luminance;
    light.power = s.power;
    light.solid_angle = solid_angle_of(r.first, r.end);
    light.first = uvec2(r.first);
    light.end = uvec2(r.end);
    return light;
}

void main()
{
    const uint me = gl_LocalInvocationIndex;
    if (me == 0u) {
        regions[0] = region_of(ivec2(0), ivec2(SKY_SUMS_WIDTH, SKY_SUMS_HEIGHT));
    }
    uint count = 1u;
    while (count < args.lights) {
        barrier();
        uint chosen = 0u;
        for (uint i = 1u; i < count; i++) {
            chosen = regions[i].energy > regions[chosen].energy ? i : chosen;
        }
        const region r = regions[chosen];
        if (!(r.energy > 0.0)) { // the same of all threads
            break;
        }
        const bool wide = is_wide(r);
        const int from = wide ? r.first.x : r.first.y, to = wide ? r.end.x : r.end.y;
        for (int cut = from + 1 + int(me); cut < to; cut += 64) {
            const ivec2 end = wide ? ivec2(cut, r.end.y) : ivec2(r.end.x, cut);
            unevenness[cut - from] = abs(2.0 * sum_of(r.first, end).luminance - r.energy);
        }
        barrier();
        int best = 1;
        for (int k = 2; k < to - from; k++) {
            best = unevenness[k] < unevenness[best] ? k : best;
        }
        const int cut = from + best;
        if (me == 0u) {
            regions[chosen] = region_of(r.first, wide ? ivec2(cut, r.end.y) : ivec2(r.end.x, cut));
        }
        if (me == 1u) {
            regions[count] = region_of(wide ? ivec2(cut, r.first.y) : ivec2(r.first.x, cut), r.end);
        }
        count++;
    }
    barrier();
    if (me < count) {
        constellation.lights[me] = light_of(regions[me]);
    }
    if (me == 0u) {
        constellation.count = sum_of(ivec2(0), ivec2(SKY_SUMS_WIDTH, SKY_SUMS_HEIGHT)).luminance > 0.0 ? count : 0u;
    }
}
