// phase_table.h -- phase functions that are tables: their nodes, moments and forward lobes. All in double precision.
#pragma once
#include <tyndall/scene.h>

// The table of a phase function for shaders (shaders/phase/phase_table.glsl), one row a node: 1 - mu, value (1/sr), part of
// the scattering below that angle, 0.
void tyn_phase_table_rows(const tyn_phase_table *table, float rows[TYN_PHASE_NODES][4]);

double tyn_phase_node_angle(uint32_t node);                    // radians
double tyn_phase_node_away(uint32_t node);                     // 1 - cosine of it
double tyn_phase_table_integral(const tyn_phase_table *table); // over the sphere: 1 of a right one

// All members of the phase function that is table number `index`.
tyn_phase tyn_phase_of_table(const tyn_phase_table *table, uint32_t index);

// theta_1, radians, of the window h (phase.c) through which the part f of the scattering goes.
double tyn_phase_table_window(const tyn_phase_table *table, double f);
// Adds to `moments`, which may hold numbers already, the Legendre moments 2 pi int p h P_l dmu of l = 0 .. terms - 1;
// without a window (theta_1 = 0) those of all of p.
void tyn_phase_table_moments(const tyn_phase_table *table, double theta_1, double *moments,
                             uint32_t terms);
