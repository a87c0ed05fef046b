// path_phase.glsl -- directions of paths: Henyey-Greenstein and its light-lobe mixture.
#ifndef TYN_PATH_PHASE_GLSL
#define TYN_PATH_PHASE_GLSL
#include "shaders/phase/hg.glsl"

// Phase function of each channel, 1/sr, between two unit directions of travel.
vec3 phase(vec3 g, vec3 before, vec3 after)
{
    vec3 apart = before - after;
    float one_minus_mu = 0.5 * dot(apart, apart); // does not cancel in the narrow peak
    return vec3(hg_near(g.x, one_minus_mu), hg_near(g.y, one_minus_mu), hg_near(g.z, one_minus_mu));
}

// Unit vector about `axis`, distributed as the phase function, from two uniform numbers.
vec3 phase_sample(float g, vec3 axis, vec2 u)
{
    float one_minus_mu = hg_sample(g, u.x);
    float across = sqrt(max(one_minus_mu * (2.0 - one_minus_mu), 0.0)), azimuth = 2.0 * HG_PI * u.y;
    // Duff et al., "Building an orthonormal basis, revisited" (JCGT 6(1), 2017).
    float sign_z = axis.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (sign_z + axis.z), b = axis.x * axis.y * a;
    vec3 t = vec3(1.0 + sign_z * axis.x * axis.x * a, sign_z * b, -sign_z * axis.x);
    vec3 s = vec3(b, sign_z + axis.y * axis.y * a, -axis.y);
    vec3 d = (1.0 - one_minus_mu) * axis + across * (cos(azimuth) * t + sin(azimuth) * s);
    return d * (1.5 - 0.5 * dot(d, d)); // rounding alone is to be undone: one Newton step
}

// pdf of `d` in the mixture: the phase function (value `forward`) or, with probability `c`, the lobes of g and
// g^2 about `light` (unit, towards the light). For backward scattering the lobes are uniform.
vec3 mixture_pdf(vec3 g, vec3 forward, vec3 light, vec3 d, float c)
{
    vec3 lobe = max(g, vec3(0.0));
    return mix(forward, 0.5 * (phase(lobe, light, d) + phase(lobe * lobe, light, d)), c);
}

vec3 mixture_sample(float g, vec3 way, vec3 light, float c, float u, vec2 v)
{
    float lobe = max(g, 0.0);
    bool aside = u < c;
    return phase_sample(aside ? (u < 0.5 * c ? lobe : lobe * lobe) : g, aside ? light : way, v);
}

#endif
