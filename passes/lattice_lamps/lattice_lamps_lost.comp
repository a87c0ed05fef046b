// lattice_lamps_lost.comp -- what a local light loses in the medium on its way, and what of its light comes into it.
//
// One workgroup per light and channel. What a light within the box loses is its power times the mean
// of 1 - e^-tau' over its directions; of one outside the integral over the faces where its light leaves
// the box, both as if nothing stood before the lights. Sums have a fixed order: every thread its own terms, then pairwise.
#include "shaders/lattice/lattice_args.h"
#define MEDIUM_BLOCK 0
#define RADIALS_AT 1
#define RADIALS_STORAGE
#include "shaders/medium/medium.glsl"
#include "shaders/beams/radial.glsl"
#include "shaders/lattice/lattice.glsl"
#include "shaders/lattice/lattice_sweep.glsl"

layout(local_size_x = LATTICE_SUN_GROUP) in;
#define WORKGROUP_SIZE LATTICE_SUN_GROUP
#define WORKGROUP_SUM vec2
#include "shaders/common/workgroup.glsl"
TYN_ARGS(lattice_lamps_args args);
TYN_WRITE(5, losses, vec4 losses[]); // as lattice_lamp_power, without a scale

float lost_at(uint n, vec3 away, float r, uint ch)
{
    beam_tau tau = radial_tau(radial_place_of(n, away, r));
    float t = tau.a[ch] + tau.p[ch];
    return t < 0.01 ? t * (1.0 - 0.5 * t * (1.0 - t / 3.0)) : 1.0 - exp(-t);
}

// Shares of one direction in the light's power and in what is lost of it.
vec2 of_direction(uint n, uint i, uint side, uint ch)
{
    vec3 m = octahedral_point(octahedral_texel(ivec2(i % side, i / side), int(side)));
    vec3 r0 = radials[n].to_map[0], r1 = radials[n].to_map[1], r2 = radials[n].to_map[2];
    vec3 q = r0 * (m.x / dot(r0, r0)) + r1 * (m.y / dot(r1, r1)) + r2 * (m.z / dot(r2, r2));
    float size = length(q), solid_angle = 1.0 / (size * size * size);
    vec3 d = q / size, origin = radials[n].light.position;
    float share = radial_share(n, d, 1.0) * solid_angle;
    if (share <= 0.0) {
        return vec2(0.0);
    }
    vec3 way = mix(medium.extent - origin, -origin, lessThan(d, vec3(0.0))) /
               mix(d, vec3(1e-20), lessThan(abs(d), vec3(1e-20)));
    float r = max(min(way.x, min(way.y, way.z)), 0.0);
    return share * vec2(1.0, lost_at(n, r * d, r, ch));
}

// Power through the i-th piece of the faces, and what was lost of it before, per W/sr.
vec2 of_face(uint n, uint i, uint side, uint ch)
{
    uint axis = i / (2u * side * side), u = (axis + 1u) % 3u, v = (axis + 2u) % 3u;
    vec3 p;
    p[axis] = (i / (side * side) & 1u) == 0u ? 0.0 : medium.extent[axis];
    p[u] = (float(i % side) + 0.5) / float(side) * medium.extent[u];
    p[v] = (float(i / side % side) + 0.5) / float(side) * medium.extent[v];
    vec3 away = p - radials[n].light.position;
    float r = length(away), cosine = (p[axis] > 0.0 ? away[axis] : -away[axis]) / max(r, 1e-20);
    float area = medium.extent[u] * medium.extent[v] / float(side * side);
    float share = cosine > 0.0 ? radial_share(n, away, r) * cosine * area / (r * r) : 0.0;
    return share > 0.0 ? share * vec2(1.0, lost_at(n, away, r, ch)) : vec2(0.0);
}

void main()
{
    uint n = gl_WorkGroupID.x, ch = gl_WorkGroupID.y;
    if (n >= radial_count) {
        return;
    }
    bool inside = radials[n].inside != 0u;
    uint side = n < args.num_fine ? 64u : n < args.num_lamps ? 32u : 16u;
    uint count = side * side * (inside ? 1u : 6u);
    vec2 sum = vec2(0.0);
    for (uint i = gl_LocalInvocationIndex; i < count; i += LATTICE_SUN_GROUP) {
        sum += inside ? of_direction(n, i, side, ch) : of_face(n, i, side, ch);
    }
    vec2 total = workgroup_total(sum);
    if (inside) { // the power is known
        float exact = light_lobe_integral(radials[n].light);
        total *= total.x > 0.0 ? exact / total.x : 0.0;
    }
    if (gl_LocalInvocationIndex == 0u) {
        float e = lattice_channel(radials[n].light.color, args.channels, ch, args.tint);
        losses[n * args.channels + ch] = e * vec4(inside ? 0.0 : total.x, inside ? total.x : 0.0, total.y, 0.0);
    }
}
