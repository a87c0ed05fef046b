// propagate_twin.h -- the six-neighbour propagation on the CPU, in double precision and from the paper's
// own formulas (Elek et al. 2014, Eqs 1-8), one wavelength.
#pragma once
#include <stdbool.h>

typedef enum twin_init {
    TWIN_ENTRY,
    TWIN_TRANSMITTANCE,
    TWIN_ABSORPTION,
    TWIN_FIRST_COLLISION
} twin_init;

// A grid with light of unit irradiance along +z. Arrays of n[0] n[1] n[2], x fastest.
typedef struct twin_grid {
    int n[3];
    double dx; // edge of the cells along the light, m
    const double *sigma_s, *sigma_a, *g;
    twin_init init;
    bool exact_rate, last_event;
    const double *mu;   // cosine between the light and the direction to the eye
    double mean_cosine; // of the light as it enters; 1 = a beam
    // Share of the light from the cell before that surfaces let into each, or NULL.
    const double *lit;
    double across;   // edge of the cells across the light, m; 0 = dx
    bool cell_cones; // the cone of what goes ahead is that of the cell's end, else of 45 degrees
} twin_grid;

// L, a and the sum of what went to the eye (Eq 8) after some iterations.
void twin_propagate(const twin_grid *grid, int iterations, double *light, double *cosine,
                    double *seen);

// Henyey-Greenstein: fraction of directions with a cosine below mu (Eq 1 times 2 pi), and density.
double twin_hg_below(double mu, double g);
double twin_hg(double mu, double g);

// ---- reference states from a prototype (tests/data/propagate_rect_states.bin) -----------------------

enum { STATE_CELLS = 16, STATE_TOTAL = STATE_CELLS * STATE_CELLS * STATE_CELLS, STATE_MAX = 24 };

typedef struct state_record {
    char kind[16], name[16];
    int iteration;
    double g, sigma_t;            // of the case; sigma_t < 0: as the record of kind "sigma_t"
    float values[2][STATE_TOTAL]; // state: L, a; others: values[0]
} state_record;

// Number of records read into a new array (freed by the caller), or 0 with one line on stderr.
int states_load(state_record **records);
const state_record *states_find(const state_record *records, int num, const char *kind,
                                const char *name, int iteration);
