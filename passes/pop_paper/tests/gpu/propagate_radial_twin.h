// propagate_radial_twin.h -- the six-neighbour propagation around a local light in double precision, from the
// medium's depths and the texels' solid angles.
#pragma once
#include <stdbool.h>

typedef enum radial_twin_scale {
    RADIAL_TWIN_POWER,
    RADIAL_TWIN_RECIPROCAL,
    RADIAL_TWIN_SPACING,
} radial_twin_scale;

typedef struct radial_twin {
    int n, layers;               // of the map along a side; shells and the ball
    double growth;               // of the radii
    const double *start;         // [n^2] power that starts, sr
    const double *solid_angle;   // [n^2]
    const double *tau_s, *tau_a; // [layers][n^2] along the radius; of the ball: twice
    const double *g, *mu;
    const bool *cell;   // in the grid?
    const int *first;   // [n^2] layer in which the light starts
    double mean_cosine; // at the start
    // [layers][n^2] share of the light from further in that surfaces let into each, or NULL.
    const double *lit;
    radial_twin_scale scale;
    bool narrowing, last_event, exact_rate;
} radial_twin;

typedef struct radial_twin_sums {
    double injected, absorbed, escaped, held; // sr; of unit intensity
} radial_twin_sums;

// Texel beside (i, j), a step in x or y, over the edges of the map.
void radial_twin_beside(int n, int i, int j, int dx, int dy, int out[2]);
// Fills [layers][n^2] with the power and mean cosine in the middle of the cells after the last iteration and with
// r^2 L_acc.
radial_twin_sums radial_twin_run(const radial_twin *t, int iterations, double *light,
                                 double *cosine, double *seen);
