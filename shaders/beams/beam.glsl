// beam.glsl -- optical depth from a directional light to a point.
//
// Include after medium.glsl and define:
//   BEAMS_AT        first binding of the bundle TYN_BEAMS (bundles.h)
//   BEAMS_STORAGE   if its buffer is a storage buffer: a uniform one, read at constant places by every thread, is
//                   much cheaper on a CPU device
//
// The textures hold the integral C of the medium along each ray, the medium being continued beyond the
// faces of its box by its values there. That field has no kinks where neighbouring rays enter the box
// through different faces, as the depth itself has, so it may be interpolated; the depth is
// C(p) - C(e), with e where the ray of p enters the box. The second term is absent for rays that enter
// through the first slice and where the medium is empty at the other faces. If the medium is the same
// everywhere the texture holds its mean, and the depth is that times the exact length: no grid shows.
#ifndef TYN_BEAM_GLSL
#define TYN_BEAM_GLSL
#include "beam_args.h"
#include "beam_tau.glsl"

#ifdef BEAMS_STORAGE
TYN_READ(BEAMS_AT, beams, beam_block beams[]);
#else
TYN_UNIFORM(BEAMS_AT, beams, beam_block beams[TYN_BEAM_MAX_SUNS]);
#endif
// Integrals of the density (mode DENSITY) or of sigma_s, of sigma_a and of (1 - f) sigma_s.
layout(set = 0, binding = BEAMS_AT + 1) uniform sampler3D column_tex;
layout(set = 0, binding = BEAMS_AT + 2) uniform sampler3D tau_a_tex;
layout(set = 0, binding = BEAMS_AT + 3) uniform sampler3D tau_p_tex;

// Distance from where the light enters the box, m.
float beam_length(uint sun, vec3 p)
{
    vec3 length3 = p * beams[sun].clip_scale + beams[sun].clip_offset;
    return max(min(min(length3.x, length3.y), length3.z), 0.0);
}

vec3 beam_uvw(uint sun, vec3 p)
{
    vec3 uvw = vec3(dot(beams[sun].rows[0].xyz, p), dot(beams[sun].rows[1].xyz, p),
                    dot(beams[sun].rows[2].xyz, p)) +
               vec3(beams[sun].rows[0].w, beams[sun].rows[1].w, beams[sun].rows[2].w);
    vec2 period = beams[sun].period;
    vec2 periods = (uvw.xy - beams[sun].period_first) / max(period, vec2(1e-20));
    uvw.xy -= mix(vec2(0.0), floor(periods), greaterThan(period, vec2(0.0))) * period;
    return uvw;
}

// How a depth is put together at a point.
struct beam_place {
    vec3 uvw;     // of p
    vec3 entry;   // of e
    float scale;  // of the texture at uvw
    bool subtract; // the texture at entry
};

// From the distances of p to its entry and to slice 0 along the light.
beam_place beam_place_at(vec3 uvw, float inside, float depth, float z_rate, bool even, bool edges)
{
    // Rounding must not let a ray that enters through slice 0 take a second fetch.
    return beam_place(uvw, uvw - vec3(0.0, 0.0, inside * z_rate), even ? inside : 1.0,
                      edges && !even && depth - inside > 1e-5 * depth);
}

// `p` in the box; positions outside are moved to it (periodic axes wrap).
beam_place beam_place_of(uint sun, vec3 p)
{
    p = clamp(medium_wrap(p), vec3(0.0), medium.extent);
    float depth = dot(beams[sun].depth_row.xyz, p) + beams[sun].depth_row.w;
    return beam_place_at(beam_uvw(sun, p), beam_length(sun, p), depth, beams[sun].z_rate,
                         beams[sun].even != 0u, beams[sun].edges != 0u);
}

// The same along a ray within the box (one period), where all of it is linear in the distance.
struct beam_ray {
    vec3 uvw0, uvw1;       // at distance s: uvw0 + s uvw1
    vec3 length0, length1; // distance of p from its entry: least component of length0 + s length1
    float depth0, depth1;  // distance from slice 0
    float z_rate;
    bool even, edges;
};

beam_ray beam_ray_of(uint sun, vec3 origin, vec3 direction)
{
    beam_ray ray;
    for (int i = 0; i < 3; i++) {
        ray.uvw0[i] = dot(beams[sun].rows[i].xyz, origin) + beams[sun].rows[i].w;
        ray.uvw1[i] = dot(beams[sun].rows[i].xyz, direction);
    }
    ray.length0 = beams[sun].clip_offset + origin * beams[sun].clip_scale;
    ray.length1 = direction * beams[sun].clip_scale;
    ray.depth0 = dot(beams[sun].depth_row.xyz, origin) + beams[sun].depth_row.w;
    ray.depth1 = dot(beams[sun].depth_row.xyz, direction);
    ray.z_rate = beams[sun].z_rate;
    ray.even = beams[sun].even != 0u;
    ray.edges = beams[sun].edges != 0u;
    return ray;
}

beam_place beam_ray_at(const beam_ray ray, float s)
{
    vec3 lengths = ray.length0 + s * ray.length1;
    float inside = max(min(min(lengths.x, lengths.y), lengths.z), 0.0);
    return beam_place_at(ray.uvw0 + s * ray.uvw1, inside, ray.depth0 + s * ray.depth1, ray.z_rate,
                         ray.even, ray.edges);
}

vec3 beam_fetch(sampler3D tex, const beam_place place)
{
    vec3 depth = place.scale * textureLod(tex, place.uvw, 0.0).rgb;
    if (place.subtract) {
        depth = max(depth - textureLod(tex, place.entry, 0.0).rgb, vec3(0.0));
    }
    return depth;
}

// Any mode.
beam_tau beam_depth_at(const beam_place place)
{
    if (medium_mode == TYN_MEDIUM_DENSITY) {
        return beam_of_column(beam_fetch(column_tex, place).r);
    }
    return beam_tau(beam_fetch(column_tex, place), beam_fetch(tau_a_tex, place),
                    beam_fetch(tau_p_tex, place));
}

beam_tau beam_depth(uint sun, vec3 p)
{
    return beam_depth_at(beam_place_of(sun, p));
}

#endif
