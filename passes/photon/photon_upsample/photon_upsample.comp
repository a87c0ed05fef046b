// photon_upsample.comp -- the cache's light at the places of finer cells, led by the medium (Elek et al. 2012, Sec 4.3).
//
// Weights of the 3^3 cells around: f_exp of the distance, an exponential of the mean extinction between the two places,
// truncated at r = 1.5 cells and normalised; times f_lin = 1 - |D(p) - D(q)|, D the density over its largest. The anisotropy of
// cell q goes on as g^delta, delta the difference of the penetration depths.
#include "photon_upsample_args.h"
#include "../common/photon_args.h"
#define MEDIUM_AT 0
#include "shaders/medium/medium.glsl"
#include "shaders/lattice/lattice.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
TYN_ARGS(photon_upsample_args args);
layout(binding = 5) uniform sampler3D cells;
TYN_READ(6, light, photon_light light[]);
layout(binding = 7, rgba32f) uniform writeonly image3D fluence_image;
layout(binding = 8, rgba32f) uniform writeonly image3D way_image;
#include "../common/photon_cells.glsl"

const float GONE = 0.97; // forward lobes this narrow or narrower stay what they are

// Truncated exponential of a distance, normalised to 1 over [0, r], times r.
float f_exp(float d, float extinction, float r)
{
    float x = max(extinction * r, 0.02), edge = exp(-x);
    return max(x * (exp(-x * min(d / r, 1.0)) - edge) / (1.0 - edge - x * edge), 0.0);
}

float coarse_extinction(ivec3 c)
{
    return photon_extinction(c, args.coarse.z, args.channels, args.scaled == 1u);
}

// Cells in which next to nothing of the medium is have no light of their own.
float has_medium(float extinction)
{
    return args.weighted == 0u || extinction > 1e-3 * args.majorant ? 1.0 : 1e-6;
}

photon_light light_of(const lattice_box box, uint lobe, ivec3 c)
{
    return light[lobe * args.coarse.x * args.coarse.y * args.coarse.z + lattice_index(box, c)];
}

// Of the eight cells around, trilinear; of the lobe's direction weighted with its light.
photon_light light_between(const lattice_box box, uint lobe, vec3 x)
{
    ivec3 lo = ivec3(floor(x - 0.5));
    vec3 t = x - 0.5 - vec3(lo);
    photon_light sum = photon_light(vec3(0.0), 0.0, vec3(0.0), 0.0);
    float total = 0.0;
    for (int i = 0; i < 8; i++) {
        ivec3 o = ivec3(i & 1, i >> 1 & 1, i >> 2);
        vec3 w3 = mix(1.0 - t, t, vec3(o));
        ivec3 q = clamp(lo + o, ivec3(0), box.dims - 1);
        float w = w3.x * w3.y * w3.z * has_medium(coarse_extinction(q));
        photon_light l = light_of(box, lobe, q);
        total += w;
        sum.fluence += w * l.fluence;
        sum.order += w * l.order;
        sum.way += w * mean3(l.fluence) * l.way;
    }
    sum.way /= max(mean3(sum.fluence), 1e-37);
    total = max(total, 1e-37);
    sum.fluence /= total;
    sum.order /= total;
    return sum;
}

// The lobe of the mean cosine |way| where light has scattered `delta` times more.
vec3 lobe_after(vec3 way, float moved)
{
    float narrow = length(way);
    return way * (clamp(moved * narrow, 0.0, max(narrow, GONE)) / max(narrow, 1e-20));
}

void main()
{
    ivec3 fine = ivec3(gl_GlobalInvocationID), dims = ivec3(args.dims);
    if (any(greaterThanEqual(fine, ivec3(dims.xy, dims.z * int(args.lobes))))) {
        return;
    }
    uint lobe = uint(fine.z) / args.dims.z;
    lattice_box box = lattice_box_of(medium.extent, ivec3(args.coarse));
    vec3 p = lattice_to_m(lattice_box_of(medium.extent, dims), vec3(fine.xy, fine.z % dims.z) + 0.5);
    p = clamp(p, vec3(0.0), medium.extent);
    vec3 x = lattice_from_m(box, p);
    photon_light l = light_between(box, lobe, x);
    if (args.filter_is == PHOTON_FILTER_DEPTH) {
        medium_point m = medium_sample(p);
        if (args.scaled == 1u) {
            m.sigma_s *= 1.0 - delta_fraction(m.phase);
            m.phase = phase_of_mean_cosine(delta_cosine(m.phase));
        }
        float here = mean3(m.sigma_s + m.sigma_a), g = clamp(mean3(phase_mean_cosine(m.phase)), 0.0, HG_MAX);
        float depth = l.order, r = 1.5 * box.dx, total = 0.0, lobes = 0.0;
        vec3 fluence = vec3(0.0), way = vec3(0.0);
        ivec3 middle = clamp(ivec3(floor(x)), ivec3(0), box.dims - 1);
        for (int i = 0; i < 27; i++) {
            ivec3 q = middle + ivec3(i % 3, i / 3 % 3, i / 9) - 1;
            if (any(lessThan(q, ivec3(0))) || any(greaterThanEqual(q, box.dims))) {
                continue;
            }
            float there = coarse_extinction(q);
            float range = max(1.0 - abs(here - there) / max(args.majorant, 1e-30), 0.0);
            float w = f_exp(distance(p, lattice_to_m(box, vec3(q) + 0.5)), 0.5 * (here + there), r) * range;
            w *= has_medium(there);
            photon_light near = light_of(box, lobe, q);
            total += w;
            fluence += w * near.fluence;
            // The lobe moves on by the scatterings between the two places.
            float delta = depth - near.order;
            float moved = g > 0.01 ? clamp(pow(g, clamp(delta, -64.0, 64.0)), 0.25, 4.0) : 1.0;
            float weight = w * mean3(near.fluence);
            if (args.lobe == PHOTON_LOBE_PRINTED) {
                way += weight * moved * near.way;
                lobes += weight * moved;
            } else {
                way += weight * lobe_after(near.way, moved);
                lobes += weight;
            }
        }
        if (total > 0.0) {
            l.fluence = fluence / total;
            l.way = lobes > 0.0 ? way / lobes : vec3(0.0);
        }
    }
    imageStore(fluence_image, fine, vec4(l.fluence, l.order));
    imageStore(way_image, fine, vec4(l.way, 0.0));
}
