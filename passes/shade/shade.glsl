// shade.glsl -- the light that arrives at a point of a surface.
//
// Light that has not scattered, or scattered forward only, comes straight from suns, lamps and VPLs: e^-tau' of
// it is left (tau' counts forward scattering as none). All else is in the lattice, and so is what VPLs'
// light becomes after it has met a surface.
#ifndef TYN_SHADE_GLSL
#define TYN_SHADE_GLSL
#include "shade_args.h"

layout(constant_id = 1) const uint shade_features = 0u;
layout(push_constant, scalar) uniform Args
{
    shade_args args;
};

#define MEDIUM_BLOCK 0
#define MEDIUM_DENSITY 1
#define BEAM_BLOCKS 2
#define BEAM_UNIFORM
#define BEAM_COLUMN 3
#define BEAM_TAU_A 4
#define BEAM_TAU_P 5
#define RADIAL_BLOCK 6
#define RADIAL_COLUMN 7
#define RADIAL_TAU_A 8
#define RADIAL_TAU_P 9
#define SHADOW_ATLAS 10
#define SHADOW_LIGHTS 11
#include "camera.glsl"
#include "medium.glsl"
#include "beam.glsl"
#include "radial.glsl"
#include "shadow.glsl"
#include "gbuffer.glsl"
#include "vpl.glsl"

layout(binding = 12, scalar) readonly buffer vpl_buffer
{
    uint vpl_count;
    uvec3 vpl_pad;
    radial_light vpls[];
};
layout(binding = 13, scalar) uniform sun_uniform
{
    light_block suns[TYN_LIGHTS_MAX];
};
layout(binding = 14, scalar) uniform light_uniform
{
    light_block lights[TYN_LIGHTS_MAX];
};
layout(binding = 15, scalar) uniform camera_uniform
{
    camera_block camera;
};
layout(binding = 16) uniform sampler2D surface_tex; // gbuffer.glsl
layout(binding = 17) uniform sampler2D albedo_tex;
layout(binding = 18) uniform sampler2D emission_tex;
#define VPL_DISTANCES 19
#include "vpl_visibility.glsl"

bool shade_has(uint feature)
{
    return (shade_features & feature) != 0u;
}

struct shade_point {
    vec3 position; // M
    vec3 normal;   // for shading
    vec3 facet;    // of the triangle: for shadows
};

gbuffer_point shade_sample(ivec2 texel)
{
    return gbuffer_unpack(texelFetch(surface_tex, texel, 0), texelFetch(albedo_tex, texel, 0),
                          texelFetch(emission_tex, texel, 0));
}

// Where the ray of a sample ends.
vec3 shade_position(ivec2 texel, float distance)
{
    camera_ray ray = camera_ray_through(camera, (vec2(texel) + 0.5) / float(args.samples));
    return ray.origin + distance * ray.direction;
}

vec3 shade_left(beam_tau tau)
{
    return exp(-(tau.a + tau.p));
}

// Cosine at which light from `towards` (unit) arrives; none where it comes from behind the facet.
float shade_cosine(shade_point p, vec3 towards)
{
    return dot(p.facet, towards) > 0.0 ? max(dot(p.normal, towards), 0.0) : 0.0;
}

// The way of a sun's light through the medium's box to p: from x to y away from p towards the sun; x >= y: none.
vec2 shade_way(vec3 p, vec3 towards)
{
    vec2 span = ray_box(p, ray_inverse(towards), vec3(0.0), medium.extent);
    return vec2(max(span.x, 0.0), span.y);
}

beam_tau shade_sun_depth(uint n, vec3 p, vec3 towards)
{
    vec2 way = shade_way(p, towards);
    beam_tau none = beam_tau(vec3(0.0), vec3(0.0), vec3(0.0));
    return way.x < way.y ? beam_depth(n, p + way.x * towards) : none;
}

uint shade_sun_light(uint n)
{
    return shade_has(SHADE_MEDIUM) ? beams[n].light : n;
}

vec3 shade_suns(shade_point p)
{
    vec3 sum = vec3(0.0);
    for (uint n = 0u; n < args.num_suns; n++) {
        uint sun = shade_sun_light(n);
        vec3 towards = -suns[sun].direction;
        vec3 light = suns[sun].color * shade_cosine(p, towards);
        if (light.r + light.g + light.b > 0.0) {
            if (shade_has(SHADE_SHADOWS)) {
                light *= shadow_visibility_surface(sun, p.position, p.facet);
            }
            if (shade_has(SHADE_MEDIUM)) {
                beam_tau tau = shade_sun_depth(n, p.position, towards);
                light *= exp(-(tau.a + (shade_has(SHADE_SPREAD) ? tau.s : tau.p)));
            }
            sum += light;
        }
    }
    return sum;
}

// Sunlight that was scattered forward, e^-tau' - e^-tau of it, comes from around the sun: a shadow's edge
// is as soft as the medium is deep. Of SHADE_PATHS places on the way to the light, in directions of the
// forward lobe, the one with this index: is it in the sun?
vec3 shade_spread_suns(shade_point p, uint index)
{
    vec3 sum = vec3(0.0);
    for (uint n = 0u; n < args.num_suns; n++) {
        uint sun = shade_sun_light(n);
        vec3 towards = -suns[sun].direction;
        vec2 way = shade_way(p.position, towards);
        if (way.x >= way.y) {
            continue;
        }
        beam_tau tau = shade_sun_depth(n, p.position, towards);
        vec3 forward = exp(-(tau.a + tau.p)) - exp(-(tau.a + tau.s));
        // f = g^2 is what the depth that counts as scattering leaves out.
        vec3 kept = tau.p / max(tau.s, vec3(1e-20));
        float f = clamp(1.0 - (kept.r + kept.g + kept.b) / 3.0, 0.0, 0.98), g = sqrt(f);
        float along = (float(index) + 0.5) / float(SHADE_PATHS);
        float turn = 2.399963 * float(index); // the golden angle
        float u = fract(0.5 + 0.618034 * float(index));
        // Of Henyey and Greenstein's distribution the most forward part, f of it.
        float h = g > 1e-3 ? (1.0 - f) / (1.0 + g - 2.0 * g * f * u) : 1.0;
        float c = g > 1e-3 ? clamp((1.0 + f - h * h) / (2.0 * g), -1.0, 1.0) : 1.0;
        float s = sqrt(1.0 - c * c);
        vec3 from = vpl_frame(towards) * vec3(s * cos(turn), s * sin(turn), c);
        vec3 at = p.position + mix(way.x, way.y, along) * from;
        float share = shade_cosine(p, from) * shadow_visibility_sun(sun, at);
        sum += suns[sun].color * forward * share;
    }
    return sum / float(SHADE_PATHS);
}

// What is left of a local light at a point that may be outside the medium's box.
vec3 shade_through_radial(uint n, vec3 p)
{
    vec3 o = radials[n].light.position, away = p - o;
    float r = length(away);
    vec3 d = away / max(r, 1e-20);
    vec2 span = ray_box(o, ray_inverse(d), vec3(0.0), medium.extent);
    float inside = min(r, span.y);
    return max(span.x, 0.0) < inside ? shade_left(radial_tau(radial_place_of(n, inside * d, inside)))
                                     : vec3(1.0);
}

// `light` of the scene's lamps, the n-th; its grid is `grid` where there is a medium.
vec3 shade_lamp(shade_point p, light_block light, uint n, uint grid)
{
    vec3 way = light.position - p.position;
    float rr = max(dot(way, way), 1e-12);
    vec3 towards = way * inversesqrt(rr);
    uint kind = light.kind == TYN_LIGHT_KIND_SPOT ? TYN_RADIAL_SPOT : TYN_RADIAL_ISOTROPIC;
    float share = shade_cosine(p, towards) *
                  radial_lobe(kind, light.direction, light.cos_inner, light.cos_outer, -towards);
    if (share <= 0.0) {
        return vec3(0.0);
    }
    vec3 irradiance = light.color * (share / rr);
    if (shade_has(SHADE_SHADOWS)) {
        irradiance *= shadow_visibility_surface(TYN_SHADOW_LAMP(n), p.position, p.facet);
    }
    if (shade_has(SHADE_MEDIUM)) {
        irradiance *= shade_through_radial(grid, p.position);
    }
    return irradiance;
}

vec3 shade_lamps(shade_point p)
{
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < args.num_lamps; i++) {
        // Grids are in the order of the lamps' strength.
        uint lamp = shade_has(SHADE_MEDIUM) ? radials[i].light.light - TYN_SHADOW_LAMP(0u) : i;
        sum += shade_lamp(p, lights[args.num_directional + lamp], lamp, i);
    }
    return sum;
}

// Of VPLs first, first + stride, ...
vec3 shade_vpls(shade_point p, uint first, uint stride)
{
    vec3 sum = vec3(0.0);
    uint count = min(vpl_count, uint(TYN_RADIAL_VPLS_MAX));
    for (uint k = first; k < count; k += stride) {
        float share = vpl_irradiance(vpls[k], p.position, p.normal);
        share = dot(p.facet, vpls[k].position - p.position) > 0.0 ? share : 0.0;
        if (share > 0.0) {
            share *= vpl_visibility(k, vpls[k].axis, p.position - vpls[k].position, p.facet);
        }
        if (share > 0.0) {
            vec3 irradiance = vpls[k].intensity * share;
            if (shade_has(SHADE_MEDIUM)) {
                irradiance *= shade_through_radial(args.num_lamps + k, p.position);
            }
            sum += irradiance;
        }
    }
    return sum;
}

#endif
