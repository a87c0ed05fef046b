// selftest_promises.c -- see selftest_promises.h.
#include "selftest_promises.h"
#include <stddef.h>
#include <string.h>

static const selftest_promise promises[] = {
    {.method = "pop",
     .furnace = 0.005,
     .cube_isotropic = 0.03,
     .slabs = 0.02,
     .half_space = 0.04,
     .point_source = 0.05,
     .energy = 0.01,
     .wide_ground = true},
    {.method = "path",
     .furnace = 1e-4,
     .cube_forward = 0.001,
     .slabs = 2e-4,
     .half_space = 7e-4,
     .airlight = 1e-3,
     .point_source = 0.002,
     .energy = 0.01},
    {.method = "single", .cube_once = 0.01, .airlight = 0.01},
    {.method = "lpv", .cube_as_recorded = 0.01, .cube_recorded = 0.0372323},
    {.method = "shdom", .cube_isotropic = 0.04},
    {.method = "photon", .cube_as_recorded = 0.01, .cube_recorded = 0.06386},
    {.method = "constellation", .cube_once = 0.01},
    {.method = "gradient", .cube_once = 0.02},
    {.method = "pop-paper", .cube_as_recorded = 0.01, .cube_recorded = 0.0576494},
};

const selftest_promise *selftest_promise_of(const char *method)
{
    for (size_t i = 0; i < sizeof promises / sizeof *promises; i++) {
        if (strcmp(promises[i].method, method) == 0) {
            return &promises[i];
        }
    }
    return NULL;
}
