// vpl_lights.comp -- one workgroup a VPL: the light that stands for a stratum of elements.
//
// Its power is Z (1 - t) F_0 / W_0 + Z t F_1 / W_1: Z is the stratum's weight; F and W are power and weight of its elements, by
// tents on c = log2(weight / power); t is where the chosen element lies between two tents. An element is chosen by its weight, so
// the mean over choices is the stratum's power. Off the sky c is 0, and the power the stratum's.
//
// Where the VPL is and looks is the mean, by weight, of those elements that lie on one smooth piece of a surface with the chosen
// one: it does not hang between two surfaces. What the medium takes from the light on its way to that place is taken from the
// power; light scattered forward counts as not scattered, as everywhere outside the march.

#define MEDIUM_AT 11
#include "vpl_elements.glsl"
#include "shaders/medium/medium.glsl"
#include "shaders/common/camera.glsl"
#include "shaders/beams/radial_args.h"
#include "shaders/light/shadow_args.h"

layout(local_size_x = VPL_LANES) in;
#define WORKGROUP_SIZE VPL_LANES
#define WORKGROUP_SUM vec4
#include "shaders/common/workgroup.glsl"

TYN_READ(16, weights, float weights[]); // of an element and those before it in its block
TYN_READ(17, blocks, float blocks[]); // weights before each, and the whole
TYN_READ(18, strata, vpl_stratum strata[]);
TYN_UNIFORM(19, suns, light_block suns[TYN_LIGHTS_MAX]);
TYN_UNIFORM(20, lights, light_block lights[TYN_LIGHTS_MAX]);
TYN_UPDATE(21, vpls, uint vpl_count; uint vpl_before; uvec2 vpl_pad; light_block vpls[]);
TYN_ARGS(vpl_args args);

const uint DEPTH_SAMPLES = 256u; // on the way from a light
float most_of(float v)
{
    uint lane = gl_LocalInvocationIndex;
    barrier();
    workgroup_sums[lane].x = v;
    for (uint half_size = VPL_LANES / 2u; half_size > 0u; half_size /= 2u) {
        barrier();
        if (lane < half_size) {
            workgroup_sums[lane].x = max(workgroup_sums[lane].x, workgroup_sums[lane + half_size].x);
        }
    }
    barrier();
    return workgroup_sums[0].x;
}

// The first element of a block with which cumulated weights reach beyond one; rounding may leave none: then the
// last that has a weight.
uint element_of(uint block, float weight)
{
    float start = blocks[block], last = weights[(block + 1u) * VPL_BLOCK - 1u];
    bool none = start + last <= weight;
    uint lo = 0u, hi = VPL_BLOCK - 1u;
    while (lo < hi) {
        uint mid = (lo + hi) / 2u;
        float sum = weights[block * VPL_BLOCK + mid];
        bool beyond = none ? sum >= last : start + sum > weight;
        lo = beyond ? lo : mid + 1u;
        hi = beyond ? mid : hi;
    }
    return lo;
}

// The last block that starts at or before a cumulated weight.
uint block_of(float weight)
{
    uint lo = 0u, hi = plan.num_blocks - 1u;
    while (lo < hi) {
        uint mid = (lo + hi + 1u) / 2u;
        bool before = blocks[mid] <= weight;
        lo = before ? mid : lo;
        hi = before ? hi : mid - 1u;
    }
    return lo;
}

// Optical depth from the light of a map to a place, per channel.
vec3 depth_from_light(uint light, vec3 p)
{
    vec3 towards;
    float reach;
    if (light < TYN_SHADOW_SUNS) {
        towards = -suns[light].direction;
        reach = 1e30;
    } else {
        vec3 way = lights[args.num_suns + light - TYN_SHADOW_SUNS].position - p;
        reach = length(way);
        towards = way / max(reach, 1e-20);
    }
    vec2 span = ray_box(p, ray_inverse(towards), vec3(0.0), medium.extent);
    span = vec2(max(span.x, 0.0), min(span.y, reach));
    float ds = max(span.y - span.x, 0.0) / float(DEPTH_SAMPLES);
    vec3 sigma_t = vec3(0.0);
    for (uint i = gl_LocalInvocationIndex; i < DEPTH_SAMPLES; i += VPL_LANES) {
        medium_point m = medium_sample(p + (span.x + (float(i) + 0.5) * ds) * towards);
        sigma_t += m.sigma_a + delta_scaled(m.sigma_s, m.phase);
    }
    return workgroup_total(vec4(sigma_t * ds, 0.0)).rgb;
}

// The part of an element that is in the stratum: from where, to where, and its weight.
vec3 part_of(uint block, uint element, const vpl_stratum stratum)
{
    uint at = block * VPL_BLOCK + element;
    float before = element > 0u ? weights[at - 1u] : 0.0, after = weights[at];
    vec2 w = blocks[block] + vec2(before, after); // rounded as the ends of strata are
    vec2 part = (vec2(stratum.from, stratum.to) - w.x) / max(w.y - w.x, 1e-30);
    part = clamp(part, 0.0, w.y > w.x ? 1.0 : 0.0);
    return vec3(part, (after - before) * (part.y - part.x));
}

// Does a piece go on from the centre's? Within some 20 degrees of its plane, facing the same way, and not
// farther than connected pieces of that area reach: places on a Hilbert curve that an area A is between are sqrt(6 A) apart at
// most (Bauman 2006), or farther where texels of a map are of unequal areas. In between, partly, so that nothing jumps
// (docs/measurements.md, "Constants").
float same_piece(vec3 offset, vec3 normal, vec3 centre_normal, float area)
{
    float dd = dot(offset, offset);
    float off = abs(dot(centre_normal, offset)) * inversesqrt(max(dd, 1e-36));
    return smoothstep(0.5, 0.8, dot(normal, centre_normal)) * (1.0 - smoothstep(0.15, 0.35, off)) *
           (1.0 - smoothstep(6.0 * area, max(12.0 * area, 1e-36), dd));
}

// Elements that are much farther or darker are none of the chosen one's piece: the mean would be of those that weigh more.
float alike(float doublings)
{
    return 1.0 - smoothstep(0.6, 1.6, abs(doublings));
}

// log2(weight / power) of an element.
float weight_of_power(const vpl_block block, uint element)
{
    if (!vpl_of_sky(block)) {
        return 0.0;
    }
    float power = vpl_power(texelFetch(rsm_flux_tex, vpl_texel(block, element), 0).rgb);
    return power > 0.0 ? log2(max(vpl_weight(block, element, power, args), 1e-37)) - log2(power) : 0.0;
}

void main()
{
    uint index = gl_WorkGroupID.x, lane = gl_LocalInvocationIndex;
    if (vpl_before + index >= vpl_count) {
        return;
    }
    vpl_stratum stratum = strata[index];
    uint first = block_of(stratum.from);

    // The element it lies on the surface of, and how far into it (into a triangle) that is.
    vpl_block block = vpl_block_at(block_of(stratum.at));
    uint at = element_of(block.index, stratum.at);
    float before = at > 0u ? weights[block.index * VPL_BLOCK + at - 1u] : 0.0;
    float weight_at = weights[block.index * VPL_BLOCK + at] - before;
    float inside = (stratum.at - blocks[block.index] - before) / max(weight_at, 1e-30);
    inside = clamp(inside, 0.0, 0.999);
    vpl_piece centre = vpl_piece_of(block, at, vec2(inside, inside + 1e-4), 0u, 1u);

    // What rounding of sums has chosen, not its weight, would have too much power.
    bool by_weight = weight_at > 1e-6 * (stratum.to - stratum.from);
    float chosen = by_weight ? weight_of_power(block, at) : 0.0, least = floor(chosen), beyond = chosen - least;
    vec4 flux = vec4(0.0), next = vec4(0.0); // and the area, m^2
    vec3 counted = vec3(0.0); // weights: of both classes, of all
    for (uint i = first; i < plan.num_blocks && blocks[i] < stratum.to; i++) {
        if (blocks[i + 1u] > blocks[i]) {
            vpl_block b = vpl_block_at(i);
            for (uint e = lane; e < VPL_BLOCK; e += VPL_LANES) {
                vec3 part = part_of(i, e, stratum);
                float share = part.y - part.x;
                if (share > 0.0) {
                    vec4 own = vec4(share * vpl_flux(b, e), vpl_piece_of(b, e, vec2(0.0, share), 0u, 1u).area);
                    float from = weight_of_power(b, e) - least;
                    vec2 tents = max(1.0 - abs(vec2(from, from - 1.0)), 0.0);
                    flux += tents.x * own;
                    next += tents.y * own;
                    counted += part.z * vec3(tents, 1.0);
                }
            }
        }
    }
    flux = workgroup_total(flux);
    next = workgroup_total(next);
    counted = workgroup_total(vec4(counted, 0.0)).xyz;
    flux *= counted.x > 0.0 ? (1.0 - beyond) * counted.z / counted.x : 0.0;
    flux += counted.y > 0.0 ? beyond * counted.z / counted.y * next : vec4(0.0);

    vec4 place = vec4(0.0);  // offset from the centre; weight
    vec4 normal = vec4(0.0); // normal; squared offset
    for (uint i = first; i < plan.num_blocks && blocks[i] < stratum.to; i++) {
        if (blocks[i + 1u] > blocks[i]) {
            vpl_block b = vpl_block_at(i);
            for (uint e = lane; e < VPL_BLOCK; e += VPL_LANES) {
                vec3 part = part_of(i, e, stratum);
                uint pieces = part.y > part.x ? vpl_pieces(b) : 0u;
                float like = pieces > 0u ? alike(weight_of_power(b, e) - chosen) : 0.0;
                for (uint k = 0u; k < pieces; k++) {
                    vpl_piece p = vpl_piece_of(b, e, part.xy, k, pieces);
                    vec3 d = p.position - centre.position;
                    float v = part.z / float(pieces) * like * same_piece(d, p.normal, centre.normal, flux.a);
                    place += v * vec4(d, 1.0);
                    normal += v * vec4(p.normal, dot(d, d) + p.area / (2.0 * VPL_PI));
                }
            }
        }
    }
    place = workgroup_total(place);
    normal = workgroup_total(normal);

    light_block light;
    light.kind = TYN_LIGHT_KIND_COSINE;
    light.shadow = TYN_LIGHT_NO_SHADOW;
    light.cos_inner = 1.0;
    light.cos_outer = 0.0;
    vec3 offset = place.w > 0.0 ? place.xyz / place.w : vec3(0.0);
    light.position = centre.position + offset;
    light.direction = dot(normal.xyz, normal.xyz) > 0.0 ? normalize(normal.xyz) : centre.normal;
    // Of a disc with the area, or with the spread if that is less: a disc of radius r has the mean squared
    // distance r^2 / 2 from its centre.
    float spread = place.w > 0.0 ? normal.w / place.w - dot(offset, offset) : 0.0;
    light.radius = sqrt(min(2.0 * max(spread, 0.0), flux.a / VPL_PI));
    // The mean of a curved or rough piece lies below some of it, which would be in its light's way.
    float above = 0.0;
    for (uint i = first; i < plan.num_blocks && blocks[i] < stratum.to; i++) {
        if (blocks[i + 1u] > blocks[i]) {
            vpl_block b = vpl_block_at(i);
            for (uint e = lane; e < VPL_BLOCK; e += VPL_LANES) {
                vec3 part = part_of(i, e, stratum);
                uint pieces = part.y > part.x ? vpl_pieces(b) : 0u;
                float like = pieces > 0u ? alike(weight_of_power(b, e) - chosen) : 0.0;
                for (uint k = 0u; k < pieces; k++) {
                    vpl_piece p = vpl_piece_of(b, e, part.xy, k, pieces);
                    vec3 d = p.position - centre.position;
                    float v = like * same_piece(d, p.normal, centre.normal, flux.a);
                    above = max(above, min(v, 1.0) * dot(d - offset, light.direction));
                }
            }
        }
    }
    light.position += most_of(above) * light.direction;
    vec3 depth = vec3(0.0);
    if (args.media != 0u && block.index < plan.front && block.map.light < TYN_RSM_SKY) {
        depth = depth_from_light(block.map.light, light.position);
    }
    light.color = flux.rgb * exp(-depth) / VPL_PI;
    if (lane == 0u) {
        vpls[vpl_before + index] = light;
    }
}
