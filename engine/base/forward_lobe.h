// forward_lobe.h -- the part of the Henyey-Greenstein phase function that delta scaling counts as going
// straight on.
//
// The lobe is p h with the window h(theta) = 1 inside theta_1 / 2, 0 outside 3 theta_1 / 2, smoothstep
// between; theta_1 is such that it holds the part f = g^2 of the scattering.
#pragma once
#include <stdint.h>

// Writes the Legendre moments 2 pi int p h P_l dmu of l = 0 .. terms - 1 (the first is g^2) and returns
// theta_1, radians. 0 < g < 1.
double tyn_lobe_moments(double g, double *moments, uint32_t terms);
