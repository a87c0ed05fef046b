// photon_upsample.comp -- the cache's light at the places of finer cells, led by the medium (Elek et al. 2012, Sec 4.3).
//
// Weights of the 3^3 cells around: f_exp of the distance, an exponential of the mean extinction between the two places,
// truncated at r = 1.5 cells and normalised; times f_lin = 1 - |D(p) - D(q)|, D the density over its largest. The anisotropy of
// cell q goes on as g^delta, delta the difference of the penetration depths.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "photon_upsample_args.h"
#include "shaders/photon/photon_args.h"
#define MEDIUM_AT 0
#include "shaders/medium/medium.glsl"
#include "shaders/lattice/lattice.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
TYN_ARGS(photon_upsample_args args);
layout(binding = 5) uniform sampler3D cells;
TYN_READ(6, light, photon_light light[]);
layout(binding = 7, rgba32f) uniform writeonly image3D sun_light_image;
layout(binding = 8, rgba32f) uniform writeonly image3D sky_light_image;
layout(binding = 9, rgba32f) uniform writeonly image3D sky_way_image;

const float GONE = 0.97; // forward lobes this narrow or narrower stay what they are

float mean3(vec3 v)
{
    return (v.x + v.y + v.z) * (1.0 / 3.0);
}

// Truncated exponential of a distance, normalised to 1 over [0, r], times r.
float f_exp(float d, float extinction, float r)
{
    float x = max(extinction * r, 0.02), edge = exp(-x);
    return max(x * (exp(-x * min(d / r, 1.0)) - edge) / (1.0 - edge - x * edge), 0.0);
}

// Mean extinction of a cell of the cache, 1/m.
float coarse_extinction(ivec3 c)
{
    float sum = 0.0;
    for (uint ch = 0u; ch < args.channels; ch++) {
        vec4 cell = texelFetch(cells, c + ivec3(0, 0, int(ch * args.coarse.z)), 0);
        sum += cell.x / (1.0 - delta_fraction(phase_of_delta_cosine(cell.z))) + cell.y;
    }
    return sum / float(args.channels);
}

photon_light light_of(lattice_box box, ivec3 c)
{
    return light[lattice_index(box, clamp(c, ivec3(0), box.dims - 1))];
}

// Of the eight cells around, trilinear: the penetration depth alone, or all.
photon_light light_between(lattice_box box, vec3 x)
{
    ivec3 lo = ivec3(floor(x - 0.5));
    vec3 t = x - 0.5 - vec3(lo);
    photon_light sum = photon_light(vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0);
    vec2 weights = vec2(0.0);
    for (int i = 0; i < 8; i++) {
        ivec3 o = ivec3(i & 1, i >> 1 & 1, i >> 2);
        vec3 w3 = mix(1.0 - t, t, vec3(o));
        float w = w3.x * w3.y * w3.z;
        photon_light l = light_of(box, lo + o);
        sum.sun += w * l.sun;
        sum.sky += w * l.sky;
        sum.order += w * l.order;
        sum.cosine += w * mean3(l.sun) * l.cosine;
        sum.way += w * mean3(l.sky) * l.way;
    }
    sum.cosine /= max(mean3(sum.sun), 1e-37);
    sum.way /= max(mean3(sum.sky), 1e-37);
    return sum;
}

void main()
{
    ivec3 fine = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(fine, ivec3(args.dims)))) {
        return;
    }
    lattice_box box = lattice_box_of(medium.extent, ivec3(args.coarse));
    vec3 p = lattice_to_m(lattice_box_of(medium.extent, ivec3(args.dims)), vec3(fine) + 0.5);
    p = clamp(p, vec3(0.0), medium.extent);
    vec3 x = lattice_from_m(box, p);
    photon_light l = light_between(box, x);
    if (args.filter_is == PHOTON_FILTER_DEPTH) {
        medium_point m = medium_sample(p);
        float here = mean3(m.sigma_s + m.sigma_a), g = clamp(mean3(phase_mean_cosine(m.phase)), 0.0, HG_MAX);
        float depth = l.order, r = 1.5 * box.dx, total = 0.0, lobes = 0.0, skies = 0.0;
        vec3 sun = vec3(0.0), sky = vec3(0.0), way = vec3(0.0);
        float cosine = 0.0;
        ivec3 middle = clamp(ivec3(floor(x)), ivec3(0), box.dims - 1);
        for (int i = 0; i < 27; i++) {
            ivec3 q = middle + ivec3(i % 3, i / 3 % 3, i / 9) - 1;
            if (any(lessThan(q, ivec3(0))) || any(greaterThanEqual(q, box.dims))) {
                continue;
            }
            float there = coarse_extinction(q);
            float range = max(1.0 - abs(here - there) / max(args.majorant, 1e-30), 0.0);
            float w = f_exp(distance(p, lattice_to_m(box, vec3(q) + 0.5)), 0.5 * (here + there), r) * range;
            photon_light near = light_of(box, q);
            total += w;
            sun += w * near.sun;
            sky += w * near.sky;
            // The lobe moves on by the scatterings between the two places.
            float delta = depth - near.order;
            float moved = g > 0.01 ? clamp(pow(g, clamp(delta, -64.0, 64.0)), 0.25, 4.0) : 1.0;
            float weight = w * mean3(near.sun);
            if (args.lobe == PHOTON_LOBE_PRINTED) {
                cosine += weight * moved * near.cosine;
                lobes += weight * moved;
            } else {
                cosine += weight * clamp(moved * near.cosine, -0.999, max(near.cosine, GONE));
                lobes += weight;
            }
            way += w * mean3(near.sky) * near.way;
            skies += w * mean3(near.sky);
        }
        if (total > 1e-6) {
            l.sun = sun / total;
            l.sky = sky / total;
            l.cosine = lobes > 0.0 ? cosine / lobes : 0.0;
            l.way = skies > 0.0 ? way / skies : vec3(0.0);
        }
    }
    imageStore(sun_light_image, fine, vec4(l.sun, l.cosine));
    imageStore(sky_light_image, fine, vec4(l.sky, l.order));
    imageStore(sky_way_image, fine, vec4(l.way, 0.0));
}
