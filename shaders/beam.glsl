// beam.glsl -- optical depth from a directional light to a point.
//
// Include after medium.glsl and define the bindings:
//   BEAM_BLOCKS    storage buffer beam_block[]
//   BEAM_COLUMN    sampler: `column` (mode DENSITY) or `tau_s` (mode COEFFICIENTS)
//   BEAM_TAU_A, BEAM_TAU_P   samplers, mode COEFFICIENTS (leave out in kernels that know DENSITY only)
//
// The textures hold the *mean* along the ray since it entered the box, which has no kinks where
// neighbouring rays enter through different faces; the length is exact. So a homogeneous medium is
// exact at any resolution and obliquity, and there are no stair-steps along the box's shadow edges.
#ifndef TYN_BEAM_GLSL
#define TYN_BEAM_GLSL
#include "beam_args.h"

layout(set = 0, binding = BEAM_BLOCKS, scalar) readonly buffer beam_buffer
{
    beam_block beams[];
};
layout(set = 0, binding = BEAM_COLUMN) uniform sampler3D beam_column_tex;
#ifdef BEAM_TAU_A
layout(set = 0, binding = BEAM_TAU_A) uniform sampler3D beam_tau_a_tex;
#endif
#ifdef BEAM_TAU_P
layout(set = 0, binding = BEAM_TAU_P) uniform sampler3D beam_tau_p_tex;
#endif

// Optical depths along the light up to a point. Scattering depths are those after similarity_clamp.
struct beam_tau {
    vec3 s; // int sigma_s
    vec3 a; // int sigma_a
    vec3 p; // int (1 - f) sigma_s, f = g^2 for g > 0, else 0
};
// What is left of the sun: exp(-(a + s)); with what was scattered into the forward peak: exp(-(a + p)).

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
    if (period.x + period.y > 0.0) {
        vec2 periods = (uvw.xy - beams[sun].period_first) / max(period, vec2(1e-20));
        uvw.xy -= mix(vec2(0.0), floor(periods), greaterThan(period, vec2(0.0))) * period;
    }
    return uvw;
}

// Mode DENSITY: column density int density ds, m times texture value. `p` in the box; positions
// outside are moved to it (periodic axes wrap).
float beam_column(uint sun, vec3 p)
{
    p = clamp(medium_wrap(p), vec3(0.0), medium.extent);
    return beam_length(sun, p) * textureLod(beam_column_tex, beam_uvw(sun, p), 0.0).r;
}

// Mode DENSITY: optical depths of a column density.
beam_tau beam_of_column(float column)
{
    vec3 sigma_s = medium.sigma_s, g = medium.g;
    similarity_clamp(sigma_s, g);
    vec3 s = sigma_s * column;
    return beam_tau(s, medium.sigma_a * column, s * (1.0 - delta_fraction(g)));
}

// Either mode.
beam_tau beam_depth(uint sun, vec3 p)
{
    if (medium_mode == TYN_MEDIUM_DENSITY) {
        return beam_of_column(beam_column(sun, p));
    }
    p = clamp(medium_wrap(p), vec3(0.0), medium.extent);
    float length_p = beam_length(sun, p);
    vec3 uvw = beam_uvw(sun, p);
    beam_tau tau = beam_tau(vec3(0.0), vec3(0.0), vec3(0.0));
    tau.s = length_p * textureLod(beam_column_tex, uvw, 0.0).rgb;
#ifdef BEAM_TAU_A
    tau.a = length_p * textureLod(beam_tau_a_tex, uvw, 0.0).rgb;
#endif
#ifdef BEAM_TAU_P
    tau.p = length_p * textureLod(beam_tau_p_tex, uvw, 0.0).rgb;
#endif
    return tau;
}

#endif
