// llc_twin.h -- the lattice solver of passes/lattice once more, on the CPU, in double precision.
//
// Same discrete equations, written from the formulas and sharing no source with the shaders: 14
// lattice lines with linear sources, a diffusion correction by multigrid, Anderson mixing of depth
// 2. One channel. Cell (i, j, k) is element (k * n[1] + j) * n[0] + i.
#pragma once
#include <stdbool.h>

typedef struct llc_twin {
    int n[3];
    double dx;      // m
    double longest; // side of the medium, m
    // Inputs per cell, zero after llc_twin_init.
    double *sigma_s, *sigma_a, *g; // delta-scaled sigma_s', g'; 1/m
    double *emission;              // W/(m^3 sr)
    double (*beam)[4];             // sum E T', sum E T' direction, W/m^2
    double boundary;               // radiance that enters at the box from all sides, W/(m^2 sr)
    // How to solve.
    int cycles;        // V-cycles after each sweep
    bool anderson;     // mix the last three sweeps
    double dense_term; // 0.2: of the diffusion coefficient in dense cells; 0 is unstable
    // The solution.
    double (*m)[4]; // fluence and net flux of the scattered light, W/m^2
    double leak;    // left the box less what entered at it in the last sweep, W
} llc_twin;

void llc_twin_init(llc_twin *t, int nx, int ny, int nz, double dx);
void llc_twin_finish(llc_twin *t);

// One sweep from `in` to `out` (which must differ); returns the leak, W.
double llc_twin_sweep(const llc_twin *t, const double (*in)[4], double (*out)[4]);

// From what enters, as if unhindered: phi = 4 pi boundary, F = 0.
void llc_twin_solve(llc_twin *t, int sweeps);

// (leak + absorbed - made) / (made + entering at the box); made by the beams and by emission.
double llc_twin_imbalance(const llc_twin *t);

// The diffusion correction's equation, A e = b (in W per unit fluence): `cycles` V-cycles from e =
// 0, or successive over-relaxation until the residual is `tolerance` |b|.
void llc_twin_diffusion(const llc_twin *t, const double *b, int cycles, double *e);
int llc_twin_diffusion_sor(const llc_twin *t, const double *b, double tolerance, double *e);
