// gradient_field.comp -- the field of radiance towards the eye from samples: Eq 4 of Ren et al. 2008, as a gather.
//
//   L(x) = sum over j of W_j(x) (L_j + (x - x_j) grad L_j) / sum over j of W_j(x),  |x - x_j| < R_j,  W_j(x) = R_j / |x - x_j|
//
// A group of 4 x 4 x 4 cells goes through the points of each grid that may reach it, 64 at a time; each thread loads one, and those that are
// samples are taken by all, in their order: sums do not depend on anything else.
#include "gradient_args.h"
#include "shaders/common/counters.h"
TYN_ARGS(gradient_args args);
#define MEDIUM_BLOCK 0
#include "shaders/medium/medium.glsl"
#include "shaders/lattice/lattice.glsl"
#include "gradient_grid.glsl"

layout(constant_id = 1) const uint gradient_interpolation = GRADIENT_GRADIENT;
layout(constant_id = 2) const uint gradient_bricks = 0u; // 1: it is known where there is no medium

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
layout(binding = 1) uniform usamplerBuffer states_words;
layout(binding = 2) uniform samplerBuffer samples_texels;
layout(binding = 3, rgba32f) uniform writeonly image3D inscatter_image;
TYN_UPDATE(4, counters, counters_block counters);
layout(binding = 5) uniform sampler3D bricks_tex;

shared uint taken[2]; // which of the 64 are samples
shared uint matter;   // 1: there is medium whose light these cells tell
shared vec3 place[GRADIENT_GROUP], light[GRADIENT_GROUP], slope_x[GRADIENT_GROUP], slope_y[GRADIENT_GROUP], slope_z[GRADIENT_GROUP];

struct sums {
    vec3 light;
    float weight;
};

void add(inout sums s, vec3 x, uint n, float radius)
{
    const vec3 away = x - place[n];
    const float d2 = dot(away, away);
    if (gradient_interpolation == GRADIENT_RBF) {
        const float width = args.narrow * radius;
        // Within the valid radius alone, but never 0 there.
        const float w = d2 < radius * radius ? exp(-d2 / (width * width)) + 1e-12 : 0.0;
        s.light += w * light[n];
        s.weight += w;
    } else {
        const float d = max(sqrt(d2), 1e-4 * radius);
        float w = radius / d;
        if (args.fading != 0u) {
            // It vanishes at R, and counts for the volume that the sample stands for: coarse ones do not outweigh the finer ones
            // which they reach.
            const float finer = args.radius / radius;
            w = (w - 1.0) * finer * finer * finer;
        }
        w = d < radius ? w : 0.0;
        s.light += w * gradient_extrapolated(light[n], away.x * slope_x[n] + away.y * slope_y[n] + away.z * slope_z[n]);
        s.weight += w;
    }
}

// Is there medium between two places? All threads of the group ask.
bool any_medium(vec3 low, vec3 high, uint own)
{
    if (own == 0u) {
        matter = gradient_bricks == 0u ? 1u : 0u;
    }
    barrier();
    const ivec3 last = ivec3(medium.bricks) - 1;
    const ivec3 from = clamp(ivec3(floor(low / medium.brick_size)), ivec3(0), last);
    const ivec3 span = clamp(ivec3(floor(high / medium.brick_size)), ivec3(0), last) - from + 1;
    const uint count = gradient_bricks == 0u ? 0u : uint(span.x * span.y * span.z);
    for (uint n = own; n < count; n += GRADIENT_GROUP) {
        const uint row = n / uint(span.x);
        const ivec3 brick = from + ivec3(n % uint(span.x), row % uint(span.y), row / uint(span.y));
        if (texelFetch(bricks_tex, brick, 0).g > 0.0) {
            atomicOr(matter, 1u);
        }
    }
    barrier();
    return matter != 0u;
}

void main()
{
    const ivec3 dims = ivec3(args.x, args.y, args.z);
    const lattice_box box = lattice_box_of(medium.extent, dims);
    const ivec3 texel = ivec3(gl_GlobalInvocationID);
    // A cell more at each face has what is there.
    const vec3 x = clamp(lattice_to_m(box, vec3(texel) - 0.5), vec3(0.0), medium.extent);
    const vec3 low = lattice_to_m(box, vec3(4u * gl_WorkGroupID) - 0.5), high = low + 3.0 * box.dx;
    const uint own = gl_LocalInvocationIndex;
    sums s = sums(vec3(0.0), 0.0);
    // Places are blended between cells.
    const uint levels = any_medium(low - box.dx, high + box.dx, own) ? args.levels : 0u;
    for (uint level = 0u; level < levels; level++) {
        const gradient_grid grid = gradient_grid_of(level);
        const ivec3 from = max(ivec3(ceil((low - grid.radius) / grid.spacing - 0.5)), ivec3(0));
        const ivec3 to = min(ivec3(floor((high + grid.radius) / grid.spacing - 0.5)), grid.size - 1);
        const ivec3 span = max(to - from + 1, ivec3(0));
        const uint count = uint(span.x * span.y * span.z);
        for (uint first = 0u; first < count; first += GRADIENT_GROUP) {
            barrier();
            if (own < 2u) {
                taken[own] = 0u;
            }
            barrier();
            const uint n = min(first + own, count - 1u), row = n / uint(span.x);
            const ivec3 at = from + ivec3(n % uint(span.x), row % uint(span.y), row / uint(span.y));
            const int point = int(grid.first + gradient_index(grid, at));
            const bool is = first + own < count && (texelFetch(states_words, point).r & GRADIENT_IS_SAMPLE) != 0u;
            if (is) {
                atomicOr(taken[own / 32u], 1u << (own & 31u));
            }
            barrier();
            const uint a = taken[0], b = taken[1];
            if (is) {
                const uint before = (1u << (own & 31u)) - 1u;
                const uint slot = own < 32u ? bitCount(a & before) : bitCount(a) + bitCount(b & before);
                place[slot] = gradient_place(grid, at);
                light[slot] = texelFetch(samples_texels, 4 * point).rgb;
                slope_x[slot] = texelFetch(samples_texels, 4 * point + 1).rgb;
                slope_y[slot] = texelFetch(samples_texels, 4 * point + 2).rgb;
                slope_z[slot] = texelFetch(samples_texels, 4 * point + 3).rgb;
            }
            barrier();
            const uint samples = bitCount(a) + bitCount(b);
            for (uint k = 0u; k < samples; k++) {
                add(s, x, k, grid.radius);
            }
        }
    }
    if (any(greaterThanEqual(texel, dims + 2))) {
        return;
    }
    vec3 found = s.light / max(s.weight, 1e-30);
    const float below = light_below(found), above = light_above(found);
    if (below > 0.0) {
        atomicAdd(counters.clamped, 1u);
    }
    TYN_LIGHT_CLAMP_ADD(counters.clamp_0, below, above)
    imageStore(inscatter_image, texel, vec4(max(found, 0.0), 0.0));
}
