// beam_tau.glsl -- optical depths along a light. Include after medium.glsl.
#ifndef TYN_BEAM_TAU_GLSL
#define TYN_BEAM_TAU_GLSL

// Optical depths along the light up to a point. Scattering depths are those after similarity_clamp.
struct beam_tau {
    vec3 s; // int sigma_s
    vec3 a; // int sigma_a
    vec3 p; // int (1 - f) sigma_s, f = g^2 for g > 0, else 0
};
// What is left of the light: exp(-(a + s)); with what was scattered into the forward peak: exp(-(a + p)).

// Mode DENSITY: optical depths of a column density.
beam_tau beam_of_column(float column)
{
    vec3 sigma_s = medium.sigma_s, g = medium.g;
    similarity_clamp(sigma_s, g);
    vec3 s = sigma_s * column;
    return beam_tau(s, medium.sigma_a * column, s * (1.0 - delta_fraction(g)));
}

#endif
