// lobe_series.h -- what a medium scatters of a beam or a cone of light, in double precision.
#pragma once

enum { LOBE_TERMS = 1300 };

typedef struct lobe_series {
    double g, f;
    int terms;
    double lobe[LOBE_TERMS], rest[LOBE_TERMS]; // F_l, g^l - F_l
} lobe_series;

// -1 < g <= 0.99.
void lobe_series_make(lobe_series *s, double g);

// c[l] = average of P_l over a cone that covers `part` of the sphere.
void lobe_cone(double part, int terms, double *c);

// sum_l (2l+1)/(4 pi) P_l(mu) c_l (g^l - F_l) / (1 - f) e^{-tau (f - F_l)}: what is scattered out of
// the forward lobes of light from a cone, as a phase function.
double lobe_kernel(const lobe_series *s, const double *c, double tau, double mu);
