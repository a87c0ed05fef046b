// path_fluxes.c -- where light of suns and surroundings goes, against closed forms of a cube and of a slab.
#include "path_scene.h"
#include <math.h>

enum { PATHS = 1 << 18 };

// A cube of 1 m in the sun, which shines along +x.
static void make_cube(path_scene *s, float sigma_s, float sigma_a, float g, bool grid)
{
    path_scene_cube(s, sigma_s, sigma_a, g, grid);
    path_scene_sun(s, (float[]){1, 0, 0}, (float[]){1, 2, 3});
}

static void absorption(void **state)
{
    for (int grid = 0; grid < 2; grid++) {
        path_scene s;
        make_cube(&s, 0, 2, 0, grid);
        const tyn_fluxes *f = path_scene_fluxes(*state, &s, PATHS);
        for (int c = 0; c < 3; c++) {
            const double through = (c + 1) * exp(-2);
            path_scene_check("incident", f->mean.incident[c], f->se.incident[c], c + 1);
            path_scene_check("transmitted", f->mean.transmitted[c], f->se.transmitted[c], through);
            path_scene_check("direct", f->mean.direct[c], f->se.direct[c], through);
            path_scene_check("through +x", f->mean.leaving[1][c], f->se.leaving[1][c], through);
            path_scene_check("absorbed", f->mean.absorbed_media[c], f->se.absorbed_media[c],
                             (c + 1) * (1 - exp(-2)));
            assert_true(f->mean.reflected[c] == 0 && f->mean.leaving[0][c] == 0);
        }
    }
}

// What is given less where it went: weights of paths have a quotient.
static double rounding_of_shares(const gpu_test *t)
{
    return gpu_ulps(t, GPU_QUOTIENT);
}

// Without absorption all of it leaves; what has met nothing is Beer's; a cube looks the same from four sides.
static void scattering(void **state)
{
    path_scene s;
    make_cube(&s, 3, 0, 0.5f, true);
    const tyn_fluxes *f = path_scene_fluxes(*state, &s, PATHS);
    for (int c = 0; c < 3; c++) {
        path_scene_check("direct", f->mean.direct[c], f->se.direct[c], (c + 1) * exp(-3));
        path_scene_check("leaves", f->mean.reflected[c] + f->mean.transmitted[c],
                         hypot(f->se.reflected[c], f->se.transmitted[c]), c + 1);
        path_scene_check("missing", f->mean.missing[c],
                         f->se.missing[c] + (c + 1) * rounding_of_shares(*state), 0);
        double faces = 0;
        for (int i = 0; i < 6; i++) {
            faces += f->mean.leaving[i][c];
            assert_true(f->mean.leaving[i][c] > 0.05 * (c + 1));
        }
        path_scene_check("faces", faces, 1e-5, f->mean.reflected[c] + f->mean.transmitted[c]);
        for (int i = 3; i < 6; i++) {
            path_scene_check("sides", f->mean.leaving[i][c],
                             hypot(f->se.leaving[i][c], f->se.leaving[2][c]),
                             f->mean.leaving[2][c]);
        }
        // Through the face where the light enters it goes back.
        path_scene_check("back", f->mean.leaving[0][c], 1e-5, f->mean.reflected[c]);
    }
}

// From all sides: pi times the radiance and the surface; a black cube keeps all but what its depth lets through.
static void surroundings(void **state)
{
    path_scene s;
    path_scene_cube(&s, 0, 1000, 0, false);
    path_scene_sky(&s, 0.5f);
    const tyn_fluxes *f = path_scene_fluxes(*state, &s, PATHS);
    path_scene_check("incident", f->mean.incident[1], f->se.incident[1], 6 * M_PI * 0.5);
    // Mean of 1 - e^-tau over its chords: all but 1 / (4 V/S 1000), nearly.
    assert_true(f->mean.absorbed_media[1] > 0.99 * 6 * M_PI * 0.5);
    path_scene_check("missing", f->mean.missing[1],
                     f->se.missing[1] + 6 * M_PI * 0.5 * rounding_of_shares(*state), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(absorption), cmocka_unit_test(scattering),
                                       cmocka_unit_test(surroundings)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
