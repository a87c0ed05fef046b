// forward_lobe.h -- the part of the Henyey-Greenstein phase function that delta scaling counts as going
// straight on.
//
// The lobe is p h with the window h(theta) = 1 inside theta_1 / 2, 0 outside 3 theta_1 / 2, smoothstep
// between; theta_1 is such that it holds the part f of the scattering.
#pragma once
#include <stdint.h>

// f, the part of the scattering that delta scaling counts as going straight on: delta_fraction of shaders/phase/hg.glsl.
static inline double tyn_delta_fraction(double g)
{
    return g > 0 ? g * g : 0;
}

// Writes the Legendre moments 2 pi int p h P_l dmu of l = 0 .. terms - 1 (the first is f) and returns
// theta_1, radians. 0 < g < 1.
double tyn_lobe_moments(double g, double *moments, uint32_t terms);
