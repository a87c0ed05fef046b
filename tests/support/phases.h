// phases.h -- phase functions that tests have in common, as formulas of their own and as a scene takes them.
#pragma once
#include <tyndall/scene.h>

typedef enum phases_kind {
    PHASES_TWO = 0,  // Henyey-Greenstein lobes of 0.85 and -0.3
    PHASES_BOTH,     // ... of +-0.6
    PHASES_DROPLETS, // of 10 micrometres
    PHASES_RAYLEIGH, // by its Legendre moments
    PHASES_ANGLES,   // the first, by values at every degree, closer below ten
    PHASES_COUNT
} phases_kind;
const char *phases_name(phases_kind kind);

// The formula: 1/sr at an angle, radians. `kind`: a phases_kind.
double phases_value(double theta, const void *kind);

// Adds it to the scene; fails the test on any error.
tyn_phase phases_add(tyn_scene *scene, phases_kind kind);
