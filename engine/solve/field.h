// field.h -- light that has scattered: what a solver fills and views read.
//
// A solver brings moments of the lattice's cells, which views gather for a camera, or straight the radiance that each
// place sends towards the eye.
#pragma once
#include "light/sources.h"

typedef struct tyn_field {
    // Of the lattice; {0} if the solver is another: fluence and net flux, what left the box, what walls absorb.
    tyn_ref moments, leaks, wall_power;
    // Towards the eye, what it is (RAYMARCH_INSCATTER_*), and the size of its cells, m; 0: there is no field.
    tyn_ref inscatter;
    uint32_t inscatter_is;
    float cell;
    bool one_channel; // both have one channel, to be multiplied with `tint`
    float tint[3];
} tyn_field;
