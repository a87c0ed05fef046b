// phases.c -- `path` in media whose phase functions are tables: fluxes of slabs against doubling (tests/support/doubling.c).
//
// Asserted: doubling itself gives the fluxes that DISORT gives of Henyey-Greenstein slabs (tests/data/slabs.csv);
// reflectances and transmittances are those of doubling within 3 standard errors, which are 0.1 % at most; so are those of
// two media that overlap, which count by what they scatter.
#include "bound.h"
#include "doubling.h"
#include "path_run.h"
#include "numbers.h"
#include "phases.h"
#include "skip.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- slabs ------------------------------------------------------------------------------------

static double henyey_greenstein(double theta, const void *g)
{
    const double mean = *(const double *)g, s = sin(0.5 * theta);
    return (1 - mean * mean) / (4 * M_PI * pow((1 - mean) * (1 - mean) + 4 * mean * s * s, 1.5));
}

static void against_disort(void **state)
{
    FILE *f = fopen(TYN_TEST_DATA "/slabs.csv", "r");
    char line[256];
    double off = 0;
    int count = 0;
    (void)state;
    assert_non_null(f);
    while (fgets(line, sizeof line, f)) {
        double tau, g, albedo, mu0, depth, net, up, down, chi[DOUBLING_ORDER + 1];
        if (sscanf(line, "flux,%lf,%lf,%lf,%lf,%lf,,,%lf", &tau, &g, &albedo, &mu0, &depth, &net) !=
            6) {
            continue;
        }
        doubling_moments(henyey_greenstein, &g, chi);
        doubling_fluxes(chi, tau, albedo, mu0, &up, &down);
        const double ours = depth > 0 ? down : 1 - up;
        off = maximum(off, fabs(ours - net));
        count++;
    }
    fclose(f);
    printf("doubling against DISORT, %d fluxes: within %.2g\n", count, off);
    assert_true(count > 20);
    assert_true(off < 2e-5);
}

// 1 m thick, y up, periodic along x and z.
static void make_slab(tyn_scene *scene, double tau, double albedo, double mu0)
{
    tyn_scene_init(scene);
    const tyn_medium medium = grey_medium((float)(tau * albedo), (float)(tau * (1 - albedo)), 0);
    tyn_shape *shape = scene_add_box(scene, &medium, (float[]){0, 0, 0}, (float[]){1, 1, 1},
                                     (uint32_t[]){1, 1, 1}, NULL);
    shape->repeat[0] = shape->repeat[2] = true;
    scene_add_sun(scene, (float)sqrt(1 - mu0 * mu0), (float)-mu0, 0, (float)(1 / mu0),
                  (float)(1 / mu0), (float)(1 / mu0));
}

static void take(tyn_scene *scene, tyn_phase phase)
{
    for (uint32_t i = 0; i < 3 * scene->num_media; i++) {
        scene->media[i / 3].phase[i % 3] = phase;
    }
}

static void fluxes(void **state)
{
    static const double slabs[][3] = {{0.5, 1, 1}, {2, 0.9, 0.5}, {8, 1, 0.7}, {8, 0.99, 1}};
    double worst = 0;
    for (int kind = 0; kind < PHASES_COUNT; kind++) {
        double chi[DOUBLING_ORDER + 1];
        doubling_moments(phases_value, &(phases_kind){(phases_kind)kind}, chi);
        for (size_t i = 0; i < sizeof slabs / sizeof slabs[0]; i++) {
            const double *slab = slabs[i];
            double right[2];
            tyn_scene scene;
            make_slab(&scene, slab[0], slab[1], slab[2]);
            take(&scene, phases_add(&scene, (phases_kind)kind));
            doubling_fluxes(chi, slab[0], slab[1], slab[2], &right[0], &right[1]);
            const tyn_fluxes *x = path_run_fluxes(*state, &scene, path_effort(128));
            for (int below = 0; below < 2; below++) {
                const float *mean = below ? x->mean.transmitted : x->mean.reflected;
                const float *se = below ? x->se.transmitted : x->se.reflected;
                const double incident = (double)x->mean.incident[0];
                const double value = (double)mean[0] / incident, error = (double)se[0] / incident;
                const double z = (value - right[below]) / error;
                printf("%-16s tau %g, albedo %g, mu0 %g, %s: %.5f +- %.5f, %.5f: z %+.2f\n",
                       phases_name((phases_kind)kind), slab[0], slab[1], slab[2], below ? "T" : "R",
                       value, error, right[below], z);
                assert_true(error < 1e-3);
                worst = maximum(worst, fabs(z));
            }
            tyn_scene_finish(&scene);
        }
    }
    assert_within(worst, 3, BOUND_NOISE);
}

// Two media that overlap everywhere are one with the mean of their phase functions, by what they scatter.
static void mixed(void **state)
{
    const double tau = 4, share = 0.25;
    double chi[DOUBLING_ORDER + 1], other[DOUBLING_ORDER + 1], right[2];
    tyn_scene scene;
    make_slab(&scene, tau * share, 1, 1);
    take(&scene, phases_add(&scene, PHASES_BOTH));
    const tyn_medium medium = grey_medium((float)(tau * (1 - share)), 0, 0);
    scene_add_box(&scene, &medium, (float[]){0, 0, 0}, (float[]){1, 1, 1}, (uint32_t[]){1, 1, 1},
                  NULL);
    // Both repeat, or neither may: a wide slab instead.
    for (int i = 0; i < 2; i++) {
        tyn_shape *shape = &scene.shapes[i];
        shape->repeat[0] = shape->repeat[2] = false;
        shape->to_world[0] = shape->to_world[10] = 4e4f;
    }
    const tyn_phase droplets = phases_add(&scene, PHASES_DROPLETS);
    for (int c = 0; c < 3; c++) {
        scene.media[1].phase[c] = droplets;
    }
    doubling_moments(phases_value, &(phases_kind){PHASES_BOTH}, chi);
    doubling_moments(phases_value, &(phases_kind){PHASES_DROPLETS}, other);
    for (int l = 0; l <= DOUBLING_ORDER; l++) {
        chi[l] = share * chi[l] + (1 - share) * other[l];
    }
    doubling_fluxes(chi, tau, 1, 1, &right[0], &right[1]);
    const tyn_fluxes *x = path_run_fluxes(*state, &scene, path_effort(128));
    const double value = (double)x->mean.reflected[0] / (double)x->mean.incident[0];
    const double error = (double)x->se.reflected[0] / (double)x->mean.incident[0];
    const double z = (value - right[0]) / error;
    printf("two media: %.5f +- %.5f, %.5f: z %+.2f\n", value, error, right[0], z);
    assert_within(fabs(z), 3, BOUND_NOISE);
    tyn_scene_finish(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(against_disort), cmocka_unit_test(fluxes),
                                       cmocka_unit_test(mixed)};
    setvbuf(stdout, NULL, _IOLBF, 0);
    cmocka_set_test_filter(getenv("TYN_TEST_FILTER"));
    return run_cases(tests, path_run_setup, path_run_teardown);
}
