// selftest_promises.h -- what each method promises in the groups of `tyndall selftest`: a row each.
#pragma once
#include <stdbool.h>

// The largest error in a group of checks; 0: none is promised, and the group leaves the method out. Relative to the
// expected value where nothing else is said. Of a method that tells its standard error four of these come on top.
typedef struct selftest_promise {
    const char *method;
    double furnace;        // absolute: of the worst pixel; of the mean where the method is noisy
    double cube_isotropic; // mean of the picture, g 0
    double cube_forward;   // ... g 0.5
    double cube_once;      // ... g 0.5, of the light that has scattered once
    double
        cube_as_recorded; // ... side view, of cube_recorded: of a method that is far off, but always equally
    double cube_recorded; // that mean, W/(m^2 sr)
    double slabs;         // in units of the flux that comes in
    double half_space;    //
    double airlight;      // light about a lamp that has scattered once
    double point_source;  // fluence about a lamp
    double energy;        // imbalance, in units of the power that comes in
    bool wide_ground;     // wants a ground that is wide, and not one that repeats with the slab
} selftest_promise;

// NULL: the method has no row, which fails the selftest.
const selftest_promise *selftest_promise_of(const char *method);
