// ordinates_partition.comp -- cuts the sphere into regions and lists what comes from each.
//
// One workgroup. A region for n ordinates is cut into two for n / 2 and n - n / 2 of them, in
// proportion, until every region has one: all ordinates then have about the same light x importance.
// The axes of the cuts come from a first tree that ignores importance, so that nothing but the map can
// change them.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "scene_args.h"
#include "ordinate_args.h"
#include "ordinates_args.h"
#include "sky_args.h"

layout(local_size_x = TYN_ORDINATES_MAX) in;
layout(push_constant, scalar) uniform arguments
{
    ordinates_args args;
};
layout(binding = 0, scalar) uniform environment_uniform
{
    env_block environment;
};
layout(binding = 1, scalar) readonly buffer sums_buffer
{
    sky_sum sums[];
};
layout(binding = 2, scalar) readonly buffer weights_buffer
{
    float weights[];
};
layout(binding = 3, scalar) writeonly buffer ordinates_buffer
{
    uint count, folded, num_fixed, pad;
    ordinate list[];
};

#include "ordinates.glsl"

const uint LEVELS = 8u; // 2^8 = TYN_ORDINATES_MAX
const float FOUR_PI = 4.0 * SKY_PI;

// The tree as a heap: node i has the children 2 i and 2 i + 1.
shared ordinates_region regions[2 * TYN_ORDINATES_MAX];
shared uint leaves[2 * TYN_ORDINATES_MAX]; // below a node; 0: no node
shared uint first[2 * TYN_ORDINATES_MAX];  // of them
shared uint axes[TYN_ORDINATES_MAX];
shared uint node_of[TYN_ORDINATES_MAX];

// Ordinates before folding.
shared vec4 lights[TYN_ORDINATES_MAX];  // irradiance; its size
shared vec4 moments[TYN_ORDINATES_MAX]; // luminance times direction, map frame; solid angle
shared uint kept[TYN_ORDINATES_MAX];    // 1, or 0 = folded
shared uint heirs[TYN_ORDINATES_MAX];   // who takes the light of a folded one

void grow_tree(ordinates_density density, bool choose_axes)
{
    const uint me = gl_LocalInvocationIndex;
    for (uint i = me; i < 2 * TYN_ORDINATES_MAX; i += TYN_ORDINATES_MAX) {
        leaves[i] = i == 1u ? args.regions : 0u;
        first[i] = 0u;
        regions[i] = ordinates_region(vec2(0.0), vec2(SKY_SUMS_WIDTH, SKY_SUMS_HEIGHT));
    }
    barrier();
    for (uint level = 0u; level < LEVELS; level++) {
        const uint node = (1u << level) + me;
        if (me < 1u << level && leaves[node] > 1u) {
            const uint n = leaves[node], n_lower = n / 2u;
            const float part = float(n_lower) / float(n);
            const ordinates_region r = regions[node];
            if (choose_axes) {
                axes[node] = ordinates_axis(r, part, density);
            }
            const uint axis = axes[node];
            ordinates_region lower, upper;
            ordinates_divide(r, axis, ordinates_cut(r, axis, part, density), lower, upper);
            regions[2u * node] = lower;
            regions[2u * node + 1u] = upper;
            leaves[2u * node] = n_lower;
            leaves[2u * node + 1u] = n - n_lower;
            first[2u * node] = first[node];
            first[2u * node + 1u] = first[node] + n_lower;
        }
        barrier();
    }
}

// What a region carries.
void gather(uint n)
{
    ordinates_region r = regions[node_of[n]];
    const float solid_angle = ordinates_solid_angle(r);
    const vec3 outwards = ordinates_vector(r);
    vec4 power = vec4(0.0);
    vec3 moment = vec3(0.0);
    float brightness = 1.0;
    if (environment.has_map == 0u) {
        power.rgb = vec3(solid_angle);
        moment = outwards;
    } else {
        ordinates_corner_sums(r.to, 1.0, power, moment);
        ordinates_corner_sums(vec2(r.from.x, r.to.y), -1.0, power, moment);
        ordinates_corner_sums(vec2(r.to.x, r.from.y), -1.0, power, moment);
        ordinates_corner_sums(r.from, 1.0, power, moment);
        float mean = sums[(SKY_SUMS_HEIGHT + 1) * ORDINATES_ROW - 1u].luminance / FOUR_PI;
        // A trace of even light: where it is black, the region's middle counts.
        moment = moment / max(mean, 1e-30) + 1e-3 * outwards;
    }
    vec3 light = environment.radiance * power.rgb;
    light -= args.split != 0u ? environment.sky * solid_angle : vec3(0.0);
    lights[n] = vec4(light, sky_luminance(abs(light)));
    moments[n] = vec4(moment, solid_angle);
}

vec3 middle_of(vec3 moment)
{
    float size = length(moment);
    return size > 0.0 ? moment / size : vec3(0.0, 1.0, 0.0);
}

// Those with next to no light go to the nearest one that is kept.
void choose_folded(uint n)
{
    float all = 0.0;
    for (uint i = 0u; i < args.regions; i++) {
        all += lights[i].a;
    }
    kept[n] = lights[n].a > args.fold * all ? 1u : 0u;
    barrier();
    float nearest = -2.0;
    heirs[n] = n;
    vec3 d = middle_of(moments[n].xyz);
    for (uint i = 0u; i < (n < args.regions && kept[n] == 0u ? args.regions : 0u); i++) {
        float cosine = dot(d, middle_of(moments[i].xyz));
        bool nearer = kept[i] != 0u && cosine > nearest;
        nearest = nearer ? cosine : nearest;
        heirs[n] = nearer ? i : heirs[n];
    }
    barrier();
}

void write(uint n)
{
    vec3 light = lights[n].rgb, moment = moments[n].xyz;
    // The angular size of what light there is: means weighted with it.
    vec2 size = lights[n].a * vec2(moments[n].w, 1.0);
    uint place = args.num_fixed;
    for (uint i = 0u; i < args.regions; i++) {
        bool mine = kept[i] == 0u && heirs[i] == n;
        light += mine ? lights[i].rgb : vec3(0.0);
        moment += mine ? moments[i].xyz : vec3(0.0);
        size += mine ? lights[i].a * vec2(moments[i].w, 1.0) : vec2(0.0);
        place += i < n ? kept[i] : 0u;
    }
    vec3 d = -middle_of(moment);
    ordinate o;
    o.irradiance = light;
    o.direction = environment.rows[0].xyz * d.x + environment.rows[1].xyz * d.y +
                  environment.rows[2].xyz * d.z;
    o.solid_angle = size.x / size.y;
    o.mean_cosine = clamp(1.0 - o.solid_angle / FOUR_PI, 0.0, 1.0);
    list[place] = o;
}

// Per sr: `spread` times the mean of what is shared out.
ordinates_density density_of(uint table)
{
    float mean = ordinates_scalar((SKY_SUMS_HEIGHT + 1) * ORDINATES_ROW - 1u, table) / FOUR_PI;
    return ordinates_density(table, mean > 0.0 ? args.spread * mean : 1.0);
}

void main()
{
    const uint me = gl_LocalInvocationIndex;
    grow_tree(density_of(environment.has_map != 0u ? ORDINATES_SUMS : ORDINATES_NO_TABLE), true);
    if (args.weighted != 0u) {
        grow_tree(density_of(ORDINATES_WEIGHTS), false);
    }
    for (uint i = me; i < 2 * TYN_ORDINATES_MAX; i += TYN_ORDINATES_MAX) {
        if (leaves[i] == 1u) {
            node_of[first[i]] = i;
        }
    }
    kept[me] = 0u;
    lights[me] = vec4(0.0);
    moments[me] = vec4(0.0);
    barrier();
    if (me < args.regions) {
        gather(me);
    }
    barrier();
    choose_folded(me);
    if (me < args.regions && kept[me] != 0u) {
        write(me);
    }
    if (me == 0u) {
        uint left = 0u;
        for (uint i = 0u; i < args.regions; i++) {
            left += kept[i];
        }
        count = args.num_fixed + left;
        folded = args.regions - left;
        num_fixed = args.num_fixed;
    }
}
