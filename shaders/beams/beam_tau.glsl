// beam_tau.glsl -- optical depths along a light. Include after medium.glsl.
#ifndef TYN_BEAM_TAU_GLSL
#define TYN_BEAM_TAU_GLSL

// Optical depths along the light up to a point. Scattering depths are those after similarity_clamp.
struct beam_tau {
    vec3 s; // int sigma_s
    vec3 a; // int sigma_a
    vec3 p; // int (1 - f) sigma_s, f = delta_fraction
};
// What is left of the light: exp(-(a + s)); with what was scattered into the forward peak: exp(-(a + p)).

// Mode DENSITY: optical depths of a column density.
beam_tau beam_of_column(float column)
{
    vec3 sigma_s = medium.sigma_s;
    phase p[3] = medium.phase;
    similarity_clamp(sigma_s, p);
    vec3 s = sigma_s * column;
    return beam_tau(s, medium.sigma_a * column, s * (1.0 - delta_fraction(p)));
}

// Mean transmittance of a stretch along the light, from the depth to its centre and half its own depth:
// e^-centre sinh(x) / x without its overflow; x <= centre up to interpolation. Below x = 0.01 it is
// e^-centre within 2e-5, and the quotient loses digits.
float mean_transmittance(float centre, float x)
{
    float wide = max(x, 0.01);
    float mean = (exp(-max(centre - wide, 0.0)) - exp(-(centre + wide))) / (2.0 * wide);
    return x < 0.01 ? exp(-centre) : mean;
}

#endif
