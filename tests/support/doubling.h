// doubling.h -- fluxes of plane-parallel slabs by doubling (Hansen and Travis, "Light scattering in planetary atmospheres",
// 1974, section 3.3), in double precision. It knows nothing of the library.
#pragma once
#include <stdint.h>

// Legendre moments that doubling_fluxes reads: chi_l of p = sum (2 l + 1) / (4 pi) chi_l P_l, l = 0 to DOUBLING_ORDER.
enum { DOUBLING_POINTS = 32, DOUBLING_ORDER = 2 * DOUBLING_POINTS };

// Of parallel light at the cosine `mu0` from above: the parts of its power that leave the slab above and below, the latter
// with what has not scattered. What is forward beyond the order goes straight on (delta-M; Wiscombe 1977).
void doubling_fluxes(const double chi[DOUBLING_ORDER + 1], double tau, double albedo, double mu0,
                     double *reflected, double *transmitted);

// Legendre moments of a phase function of the angle, radians, by Simpson's rule in its square root.
void doubling_moments(double (*phase)(double theta, const void *user), const void *user,
                      double chi[DOUBLING_ORDER + 1]);
