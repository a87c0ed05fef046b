// hg.glsl -- the Henyey-Greenstein lobe and its delta scaling. No bindings.
//
// p(mu) = (1 - g^2) / (4 pi s^3),  s^2 = 1 + g^2 - 2 g mu,  -1 < g < 1,  mu = cosine of the scattering
// angle. Every form below is free of the cancellations of the textbook forms at g -> 0 and |g| -> 1:
// s^2 = (1 - |g|)^2 + 2 |g| (1 -+ mu) has only non-negative terms.
#ifndef TYN_HG_GLSL
#define TYN_HG_GLSL

const float HG_PI = 3.14159265358979;
const float HG_MAX = 0.995; // narrowest lobe that the solvers resolve; see similarity_clamp

// s from 1 - mu, which a caller may know better than mu itself.
float hg_s(float g, float one_minus_mu)
{
    float a = abs(g);
    float away = g >= 0.0 ? one_minus_mu : 2.0 - one_minus_mu;
    return sqrt((1.0 - a) * (1.0 - a) + 2.0 * a * max(away, 0.0));
}

// Phase function, 1/sr. Near the peak of a narrow lobe give 1 - mu = |v - d|^2 / 2, not a rounded mu.
float hg_near(float g, float one_minus_mu)
{
    float s = hg_s(g, one_minus_mu);
    return (1.0 - g) * (1.0 + g) / (4.0 * HG_PI * s * s * s);
}

float hg(float g, float mu)
{
    return hg_near(g, 1.0 - mu);
}

// 1 - mu of a scattering angle below whose cosine the fraction u is scattered, u in [0, 1]. The usual inverse
// (1 + g^2 - ((1 - g^2) / (1 - g + 2 g u))^2) / (2 g) multiplied out, so that g = 0 is no special case
// and a narrow lobe keeps its relative precision.
float hg_sample(float g, float u)
{
    float a = abs(g), v = g >= 0.0 ? u : 1.0 - u; // a backward lobe is the mirrored forward one
    float d = (1.0 - a) + 2.0 * a * v;
    float q = (1.0 - a) / d;
    float one_minus_mu = 2.0 * (1.0 - v) * q * q * (1.0 + a * v);
    return g >= 0.0 ? one_minus_mu : 2.0 - one_minus_mu;
}

// ---- delta scaling ------------------------------------------------------------------------------

// Part of the scattering that counts as going straight on: f = g^2, so that the remaining
// p = f delta + (1 - f) p' has the right first two moments (Joseph, Wiscombe and Weinman 1976); none
// for backward scattering.
float delta_fraction(float g)
{
    float forward = max(g, 0.0);
    return forward * forward;
}

// g of the lobe of which the part f goes straight on.
float delta_lobe(float f)
{
    return sqrt(f);
}

vec3 delta_lobe(vec3 f)
{
    return sqrt(f);
}

// The cosine below which the most forward part of a lobe, f of it, has the share u; g >= 0.
float delta_lobe_cosine(float g, float u)
{
    float f = g * g, h = (1.0 - f) / (1.0 + g - 2.0 * g * f * u);
    return g > 1e-3 ? clamp((1.0 + f - h * h) / (2.0 * g), -1.0, 1.0) : 1.0;
}

#endif
