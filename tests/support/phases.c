// phases.c -- see phases.h.
#include "phases.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#define PI 3.14159265358979323846

// A lobe of Draine.
static double lobe(double weight, double g, double alpha, double theta)
{
    const double s = sin(0.5 * theta), mu = cos(theta);
    const double s2 = (1 - g) * (1 - g) + 4 * g * s * s;
    return weight * (1 - g * g) * (1 + alpha * mu * mu) /
           (4 * PI * s2 * sqrt(s2) * (1 + alpha * (1 + 2 * g * g) / 3));
}

const char *phases_name(phases_kind kind)
{
    static const char *const names[PHASES_COUNT] = {"two lobes", "forward and back", "droplets",
                                                    "Rayleigh", "angles"};
    return names[kind];
}

double phases_value(double theta, const void *kind)
{
    switch (*(const phases_kind *)kind) {
    case PHASES_BOTH:
        return lobe(0.5, 0.6, 0, theta) + lobe(0.5, -0.6, 0, theta);
    case PHASES_DROPLETS: // the fit's numbers for 10 micrometres
        return lobe(0.5180445681595686, 0.988176691700256, 0, theta) +
               lobe(0.4819554318404314, 0.5556712547839497, 21.995520856274638, theta);
    case PHASES_RAYLEIGH:
        return 3 * (1 + cos(theta) * cos(theta)) / (16 * PI);
    default:
        return lobe(0.9, 0.85, 0, theta) + lobe(0.1, -0.3, 0, theta);
    }
}

tyn_phase phases_add(tyn_scene *scene, phases_kind kind)
{
    enum { FINE = 200, COARSE = 170, COUNT = FINE + COARSE + 1 };
    static const tyn_phase_lobe two[2] = {{.weight = 0.9f, .g = 0.85f},
                                          {.weight = 0.1f, .g = -0.3f}},
                                both[2] = {{.weight = 0.5f, .g = 0.6f},
                                           {.weight = 0.5f, .g = -0.6f}};
    static const double rayleigh[3] = {1, 0, 0.1};
    tyn_phase_lobe droplets[2];
    double angles[COUNT], values[COUNT];
    for (int i = 0; i < COUNT; i++) {
        const double degrees = i < FINE ? i * 10.0 / FINE : i - FINE + 10;
        angles[i] = degrees * PI / 180;
        values[i] = phases_value(angles[i], &kind);
    }
    assert_int_equal(tyn_phase_droplets(10, droplets), TYN_OK);
    const tyn_phase_form forms[PHASES_COUNT] = {
        [PHASES_TWO] = {.count = 2, .lobes = two},
        [PHASES_BOTH] = {.count = 2, .lobes = both},
        [PHASES_DROPLETS] = {.count = 2, .lobes = droplets},
        [PHASES_RAYLEIGH] = {.count = 3, .moments = rayleigh},
        [PHASES_ANGLES] = {.count = COUNT, .angles = angles, .values = values},
    };
    tyn_phase phase = {0};
    assert_int_equal(tyn_scene_add_phase(scene, &forms[kind], "phase", &phase, NULL), TYN_OK);
    assert_true(phase.table > 0);
    return phase;
}
