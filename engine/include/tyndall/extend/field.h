// field.h -- light that has scattered: what a solver fills and views read. Tier 8.
//
// A solver is what a method calls between its sources and its views. It reads tyn_sources, adds its passes, and brings
// moments of the lattice's cells, which views gather for a camera, answer probes with and balance; or straight the radiance
// that each place sends towards the eye, which pictures then take; or both.
#pragma once
#include "sources.h"
#include "shaders/march/inscatter.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct tyn_field {
    // Of the lattice (tyn_sources.lattice); {0} if the solver has another field. 3D, RGBA32F, as large as lattice.cells,
    // channels stacked along z as there: fluence phi (x) and net flux (y, z, w along the axes of M) in W/m^2, means over
    // the cell, of light that has scattered, was emitted, or came in from all sides; not of light that is in
    // lattice.source. The picture takes (phi + 3 g' v.F) / (4 pi) for the radiance that scatters into direction v.
    tyn_ref moments;
    // For a balance: float[] of net power that leaves the box, W, all of it to be summed; and of power that walls take,
    // vec2[channel][cell]: absorbed, and 0. {0}: tyn_add_balance must not be called.
    tyn_ref leaks, wall_power;
    // What the picture takes in place of moments, if it is there: 3D, RGBA32F (one_channel: R32F), light that is scattered towards the eye, W/(m^2 sr) (per metre:
    // W/(m^3 sr)), over the medium's box with one cell more at each face (lattice_inscatter_uvw of
    // shaders/lattice/lattice.glsl); and what it is, TYN_INSCATTER_*.
    tyn_ref inscatter;
    uint32_t inscatter_is;
    float cell;       // the size of its cells, m; 0: there is no field
    bool one_channel; // moments and inscatter have one channel, to be multiplied with `tint`
    float tint[3];
} tyn_field;

// The solver of "pop": moments of all light on the lattice that tyn_add_cells has filled.
TYN_API void tyn_solve_lattice(tyn_graph *g, const tyn_job *job, const tyn_sources *s,
                               tyn_field *field);
#define TYN_LATTICE_PASSES(X) X(lattice)

#ifdef __cplusplus
}
#endif
