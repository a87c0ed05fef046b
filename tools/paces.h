// paces.h -- how fast the device at hand runs the library's own kernels, by kind: what predicted times are scaled by.
#pragma once
#include "app.h"
#include "json_at.h"
#include <tyndall/device.h>

// Of a small cloud of 48^3 voxels under a sun. A device that is 30 times as fast at one kind may be
// 2000 times as fast at another: a solve is some 80 short dispatches that wait for each other, pixels are one wide one,
// and paths diverge. 0: not measured.
typedef struct paces {
    double solve_ms;  // what a cold frame of `pop` takes whatever its pixels
    double pixel_ns;  // and for each pixel
    double sample_ns; // a sample of a pixel of `path`
} paces;

// Seconds on a CPU. Gives the exit code.
int paces_measure(app *a, tyn_device *device, paces *p);

cJSON *paces_json(const paces *p);
static inline paces paces_read(const cJSON *json) // NULL, or null: nothing was measured
{
    return (paces){json_number_at(json, "solve_ms", 0), json_number_at(json, "pixel_ns", 0),
                   json_number_at(json, "sample_ns", 0)};
}

// From $XDG_CACHE_HOME/tyndall if they were measured within a day on this machine, else measured now. Gives the
// exit code.
int paces_known(app *a, tyn_device *device, paces *p);
