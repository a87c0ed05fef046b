// phase.glsl -- the phase function of a medium: evaluation, sampling, delta scaling.
//
// All that shaders know of the parameters of a phase function is in this folder; its twin in C is engine/scene/phase.c.
// It is a Henyey-Greenstein lobe, or a table. Arrays of three are of the colour channels.
//
// No bindings, but where tables are evaluated: a kernel defines PHASE_TABLES, the binding of its port "phases", and
// PHASE_TABLED, an expression that is false if no medium has a table. In others a table counts as the Henyey-Greenstein
// lobe of its mean cosine wherever it is evaluated; what delta scaling takes of it is known everywhere.
#ifndef TYN_PHASE_GLSL
#define TYN_PHASE_GLSL
#include "hg.glsl"
#include "phase_args.h"
#ifdef PHASE_TABLES
#include "phase_table.glsl"
#endif

// ---- evaluation ---------------------------------------------------------------------------------

// The phase function, 1/sr, from 1 - mu; mu = cosine of the scattering angle. Give 1 - mu = |v - d|^2 / 2, which does
// not cancel near the peak of a narrow lobe. Averaged over a light that is a soft round spot around its direction, with
// the mean cosine `spot`: 1 = a point. Tables are not averaged.
float phase_near(const phase p, float spot, float one_minus_mu)
{
#ifdef PHASE_TABLES
    if (PHASE_TABLED && p.table != 0u) {
        return phase_table_near(p.table, one_minus_mu);
    }
#endif
    return hg_near(p.g * spot, one_minus_mu);
}

// 1 - mu of a scattering angle that is distributed as the phase function, from a uniform number.
float phase_sample(const phase p, float u)
{
#ifdef PHASE_TABLES
    if (PHASE_TABLED && p.table != 0u) {
        return phase_table_sample(p.table, u);
    }
#endif
    return hg_sample(p.g, u);
}

// ---- mean cosine --------------------------------------------------------------------------------

float phase_mean_cosine(const phase p)
{
    return p.g;
}

vec3 phase_mean_cosine(phase p[3])
{
    return vec3(phase_mean_cosine(p[0]), phase_mean_cosine(p[1]), phase_mean_cosine(p[2]));
}

// The Henyey-Greenstein phase function of a mean cosine: where media are unequal their image "g" holds mean cosines.
phase phase_of_mean_cosine(float g)
{
    return phase(g, 0u, 0.0, 0.0, 0.0, 0u);
}

phase[3] phase_of_mean_cosine(vec3 g)
{
    return phase[3](phase_of_mean_cosine(g.x), phase_of_mean_cosine(g.y), phase_of_mean_cosine(g.z));
}

// ---- channels -----------------------------------------------------------------------------------

// Of the channel whose component of `channel` is 1, the others 0.
phase phase_select(phase p[3], vec3 channel)
{
    phase of = phase_of_mean_cosine(dot(vec3(p[0].g, p[1].g, p[2].g), channel));
#ifdef PHASE_TABLES
    if (PHASE_TABLED) {
        of = channel.x > 0.5 ? p[0] : channel.y > 0.5 ? p[1] : p[2];
    }
#endif
    return of;
}

// ---- delta scaling ------------------------------------------------------------------------------

// Part of the scattering that counts as going straight on.
float delta_fraction(const phase p)
{
    return p.table != 0u ? p.delta : delta_fraction(p.g);
}

vec3 delta_fraction(phase p[3])
{
    return vec3(delta_fraction(p[0]), delta_fraction(p[1]), delta_fraction(p[2]));
}

// Mean cosine of what is left, (g - f) / (1 - f): of a lobe g / (1 + g) for g > 0, else g.
float delta_cosine(const phase p)
{
    return p.table != 0u ? (p.g - p.delta) / (1.0 - p.delta) : p.g / (1.0 + max(p.g, 0.0));
}

vec3 delta_cosine(phase p[3])
{
    return vec3(delta_cosine(p[0]), delta_cosine(p[1]), delta_cosine(p[2]));
}

// The Henyey-Greenstein phase function of which that mean cosine is left.
phase phase_of_delta_cosine(float scaled)
{
    return phase_of_mean_cosine(scaled > 0.0 ? min(scaled / (1.0 - scaled), HG_MAX) : scaled);
}

// Mean cosine of the narrowest forward lobe, >= 0.
float phase_forward_cosine(const phase p)
{
    return p.table != 0u ? p.forward : max(p.g, 0.0);
}

// A lobe that points backward: its moments are those of the lobe as it is seen from behind (tyn_phase_moments).
bool phase_is_backward(const phase p)
{
    return p.table == 0u && p.g < 0.0;
}

// A lobe narrower than HG_MAX is replaced by that one with as much less scattering that the transport
// coefficient sigma_s (1 - g) stays: the widths differ by a third of a degree. What is seen *through*
// the medium (transmittance, background) keeps the true sigma_s. Tables are as they are.
void similarity_clamp(inout float sigma_s, inout phase p)
{
    if (p.table == 0u) {
        sigma_s *= min(1.0, (1.0 - p.g) / (1.0 - HG_MAX));
        p.g = min(p.g, HG_MAX);
    }
}

void similarity_clamp(inout vec3 sigma_s, inout phase p[3])
{
    similarity_clamp(sigma_s.x, p[0]);
    similarity_clamp(sigma_s.y, p[1]);
    similarity_clamp(sigma_s.z, p[2]);
}

// sigma_s' = (1 - f) sigma_s of what similarity_clamp leaves.
vec3 delta_scaled(vec3 sigma_s, phase p[3])
{
    similarity_clamp(sigma_s, p);
    return sigma_s * (1.0 - delta_fraction(p));
}

#endif
