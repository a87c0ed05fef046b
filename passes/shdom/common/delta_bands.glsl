// delta_bands.glsl -- delta scaling for so many bands of spherical harmonics: f = g^bands goes straight on. No bindings. Include after beam_tau.glsl
// where light is followed.
//
// The cells of the lattice are scaled with f = g^2 (sources.h); of a Henyey-Greenstein lobe both follow from g. What is left has
// the Legendre moments (g^l - f) / (1 - f), none of the first that is left out (Wiscombe 1977).
#include "shaders/phase/phase.glsl"

struct bands_medium {
    float sigma_s, sigma_a, g; // without delta scaling
    float f;
    float extinction; // sigma_a + (1 - f) sigma_s, 1/m
};

float bands_power(float g, int l)
{
    float p = l == 0 ? 1.0 : pow(abs(g), float(l));
    return g < 0.0 && (l & 1) != 0 ? -p : p;
}

// `cell`: texel of lattice_cells.
bands_medium bands_medium_of(vec4 cell, uint bands)
{
    bands_medium m;
    m.g = phase_mean_cosine(phase_of_delta_cosine(cell.z));
    m.sigma_s = cell.x / (1.0 - delta_fraction(m.g));
    m.sigma_a = cell.y;
    m.f = m.g > 0.0 ? bands_power(m.g, int(bands)) : 0.0;
    m.extinction = m.sigma_a + (1.0 - m.f) * m.sigma_s;
    return m;
}

// (1 - f) sigma_s times the moment l, 1/m.
float bands_scattering(const bands_medium m, int l)
{
    return m.sigma_s * (bands_power(m.g, l) - m.f);
}

// Moment l of light that comes from a uniform cone with that mean cosine: to first order in its solid angle, and right for
// l = 1.
float bands_cone(float mean_cosine, int l)
{
    return pow(max(mean_cosine, 1e-6), 0.5 * float(l * (l + 1)));
}

#ifdef TYN_BEAM_TAU_GLSL
// Mean of what is left of a light in a cell of the edge dx.
float bands_transmittance(const beam_tau tau, int ch, const bands_medium m, uint bands, float dx)
{
    float f = tau.s[ch] > 0.0 ? clamp(1.0 - tau.p[ch] / tau.s[ch], 0.0, 1.0) : 0.0; // at two bands
    float scaled = f > 0.0 ? 1.0 - pow(f, 0.5 * float(bands)) : 1.0;
    float own = 0.5 * dx * m.extinction;
    float depth = max(tau.a[ch] + scaled * tau.s[ch], own);
    return mean_transmittance(depth, own);
}
#endif
