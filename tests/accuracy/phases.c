// phases.c -- media whose phase functions are tables: fluxes of `path` against doubling (tests/support/doubling.c), pictures of
// `pop` and `single` against `path`.
//
// Asserted: doubling itself gives the fluxes that DISORT gives of Henyey-Greenstein slabs (tests/data/slabs.csv); `path`'s
// reflectances and transmittances of slabs are those of doubling within 3 standard errors, of 0.1 % at most; pictures of
// `pop` are within the bound of one-lobe media (pop_path.c), each printed beside that of the lobe of its mean cosine; a
// table of one lobe gives the lobe's own picture; first scattering is `path`'s; media that overlap are mixed.
#include "bound.h"
#include "doubling.h"
#include "path_run.h"
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
        off = fmax(off, fabs(ours - net));
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
                worst = fmax(worst, fabs(z));
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

// ---- pictures ---------------------------------------------------------------------------------

enum { PIXELS = 64 };

static void make_cube(tyn_scene *scene, tyn_view *view)
{
    const tyn_medium medium = grey_medium(8, 0.2f, 0);
    tyn_scene_init(scene);
    scene_add_box(scene, &medium, (float[]){0, 0, 0}, (float[]){1, 1, 1}, (uint32_t[]){1, 1, 1},
                  NULL);
    scene_add_sun(scene, -2, -5, 3, 3, 2.5f, 2);
    *view = (tyn_view){0};
    view_orthographic(view, (float[]){0.5f, 0.5f, 0.5f}, 4, -2, -5, (float[]){0, 1, 0}, 0.8f,
                      PIXELS);
}

static picture_error compare(path_run *r, const char *name, const tyn_scene *scene,
                             const tyn_view *view, const picture *reference)
{
    picture ours;
    picture_render(&ours, r->dev, "pop", scene, view, NULL, 0);
    const picture_error e = picture_compare(&ours, reference, 8);
    printf("%-28s error %5.2f %% (rel_l1 %5.2f, noise %4.2f, bias %+5.2f)\n", name,
           100 * e.reported, 100 * e.rel_l1, 100 * e.noise, 100 * e.bias);
    picture_free(&ours);
    return e;
}

static void pictures(void **state)
{
    path_run *r = *state;
    double worst = 0;
    for (int kind = 0; kind < PHASES_COUNT; kind++) {
        tyn_scene scene;
        tyn_view view;
        picture reference = {0};
        make_cube(&scene, &view);
        const tyn_phase phase = phases_add(&scene, (phases_kind)kind);
        for (int one = 0; one < 2; one++) {
            char name[64];
            snprintf(name, sizeof name, "%s%s", phases_name((phases_kind)kind),
                     one ? ", one lobe" : "");
            take(&scene, one ? (tyn_phase){.g = phase.g} : phase);
            path_run_picture(r, &reference, &scene, &view, path_effort(1024));
            const picture_error e = compare(r, name, &scene, &view, &reference);
            worst = one ? worst : fmax(worst, e.reported);
        }
        picture_free(&reference);
        tyn_scene_finish(&scene);
    }
    assert_within(worst, 0.12, NULL); // as media of one lobe
}

// A table of a lobe against the lobe itself: `pop` and `single`, under a sun, a lamp and a sky.
static void same_lobe(void **state)
{
    path_run *r = *state;
    const tyn_phase_lobe halves[2] = {{.weight = 0.5f, .g = 0.8f}, {.weight = 0.5f, .g = 0.8f}};
    const tyn_phase_form form = {.count = 2, .lobes = halves};
    for (int lit = 0; lit < 3; lit++) {
        for (int i = 0; i < 2; i++) {
            const char *method = i ? "single" : "pop";
            tyn_scene scene;
            tyn_view view;
            tyn_phase phase;
            picture with[2];
            make_cube(&scene, &view);
            if (lit == 1) {
                scene.num_lights = 0;
                scene_add_lamp(&scene, (float[]){0.2f, 1.3f, 0.4f}, 2);
            } else if (lit == 2) {
                scene_set_sky(&scene, 0.5f);
            }
            assert_int_equal(tyn_scene_add_phase(&scene, &form, "phase", &phase, NULL), TYN_OK);
            for (int table = 0; table < 2; table++) {
                take(&scene, table ? phase : (tyn_phase){.g = 0.8f});
                picture_render(&with[table], r->dev, method, &scene, &view, NULL, 0);
            }
            const picture_error e = picture_compare(&with[1], &with[0], 1);
            printf("a table of one lobe, %s, light %d: rel_l1 %.2g\n", method, lit, e.rel_l1);
            assert_true(e.rel_l1 < 1e-4);
            picture_free(&with[0]);
            picture_free(&with[1]);
            tyn_scene_finish(&scene);
        }
    }
}

// First scattering of `single` against `path`'s layer of it.
static void first_scattering(void **state)
{
    path_run *r = *state;
    double worst = 0;
    for (int kind = 0; kind < PHASES_COUNT; kind++) {
        tyn_scene scene;
        tyn_view view;
        picture ours;
        make_cube(&scene, &view);
        take(&scene, phases_add(&scene, (phases_kind)kind));
        view.max_depth = 1;
        picture reference = {0};
        path_run_picture(r, &reference, &scene, &view, path_effort(64));
        view.max_depth = 0;
        picture_render(&ours, r->dev, "single", &scene, &view, NULL, 0);
        const picture_error e = picture_compare(&ours, &reference, 8);
        printf("%s, once: rel_l1 %.4f, noise %.4f, bias %+.4f\n", phases_name((phases_kind)kind),
               e.rel_l1, e.noise, e.bias);
        worst = fmax(worst, e.reported);
        picture_free(&ours);
        picture_free(&reference);
        tyn_scene_finish(&scene);
    }
    assert_within(worst, 0.01, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(against_disort), cmocka_unit_test(fluxes),
        cmocka_unit_test(mixed),          cmocka_unit_test(same_lobe),
        cmocka_unit_test(pictures),       cmocka_unit_test(first_scattering)};
    setvbuf(stdout, NULL, _IOLBF, 0);
    cmocka_set_test_filter(getenv("TYN_TEST_FILTER"));
    return run_cases(tests, path_run_setup, path_run_teardown);
}
