// fluxes.c -- `path`'s fluxes of light that is followed from suns and surroundings: against slabs
// (tests/data/slabs.csv, from DISORT), over a ground (../shared/reference/slab_ground_flux.csv; skipped where absent),
// the faces of a cube (cube_face_flux.csv there), closed forms, and the same scene seen by paths that look for the
// light (the balance).
//
// Asserted: all within 4 standard errors, which are at most 0.5 % of what is incident; what enters is what leaves and
// is absorbed: exactly where nothing is absorbed, else within 4 standard errors of paths that roulette has ended.
#include "path_run.h"
#include "gpu_test.h"
#include "npy.h"
#include "skip.h"
#include "solids.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void close_to(const char *what, double value, double se, double exact, double exact_se)
{
    const double error = hypot(se, exact_se), z = error > 0 ? (value - exact) / error : 0;
    printf("%-40s %.5f +- %.5f, %.5f: z %+.2f\n", what, value, se, exact, z);
    assert_true(se <= 5e-3);
    assert_true(fabs(value - exact) <= 4 * error + 1e-5);
}

// Of a channel, parts of the incident power.
static double part(const tyn_fluxes *f, const float *value, int c)
{
    return (double)value[c] / (double)f->mean.incident[c];
}

static void check_energy(const tyn_fluxes *f, bool absorbs)
{
    for (int c = 0; c < 3; c++) {
        const double missing = fabs(part(f, f->mean.missing, c)), se = part(f, f->se.missing, c);
        assert_true(missing <= (absorbs ? 4 * se : 0) + 1e-5);
        double faces = 0;
        for (int i = 0; i < 6; i++) {
            faces += part(f, f->mean.leaving[i], c);
        }
        const double out = part(f, f->mean.reflected, c) + part(f, f->mean.transmitted, c);
        assert_true(fabs(faces - out) <= 1e-5);
    }
}

// ---- slabs ------------------------------------------------------------------------------------

// 1 m thick, y up, periodic along x and z; `graded`: the depth is of a grid, denser below.
static void make_slab(tyn_scene *scene, float tau, float g, float albedo, bool graded)
{
    enum { SIZE = 24 };
    float grid[SIZE];
    const uint32_t size[3] = {1, SIZE, 1};
    for (int i = 0; i < SIZE; i++) {
        grid[i] = 2 * ((float)(SIZE - i) - 0.5f) / SIZE; // mean 1, also between the voxels' middles
    }
    tyn_scene_init(scene);
    const tyn_medium medium = grey_medium(tau * albedo, tau * (1 - albedo), g);
    tyn_shape *shape = scene_add_box(scene, &medium, (float[]){0, 0, 0}, (float[]){1, 1, 1}, size,
                                     graded ? grid : NULL);
    shape->repeat[0] = shape->repeat[2] = true;
}

static void light_slab(tyn_scene *scene, float mu0)
{
    scene_add_sun(scene, sqrtf(1 - mu0 * mu0), -mu0, 0, 1 / mu0, 1 / mu0, 1 / mu0);
}

static void slabs(void **state)
{
    FILE *f = fopen(TYN_TEST_DATA "/slabs.csv", "r");
    assert_non_null(f);
    char line[256];
    for (uint32_t i = 0; fgets(line, sizeof line, f); i++) {
        float tau, g, albedo, mu0, depth;
        double net;
        if (sscanf(line, "flux,%f,%f,%f,%f,%f,,,%lf", &tau, &g, &albedo, &mu0, &depth, &net) != 6 ||
            tau > 20) {
            continue;
        }
        tyn_scene scene;
        make_slab(&scene, tau, g, albedo, i % 2);
        light_slab(&scene, mu0);
        const tyn_fluxes *x = path_run_fluxes(*state, &scene, path_effort(12));
        char name[96];
        snprintf(name, sizeof name, "slab %g, g %g, albedo %g, mu0 %g, %s", (double)tau, (double)g,
                 (double)albedo, (double)mu0, depth > 0 ? "below" : "above");
        const bool below = depth > 0;
        close_to(name, below ? part(x, x->mean.transmitted, 0) : 1 - part(x, x->mean.reflected, 0),
                 part(x, below ? x->se.transmitted : x->se.reflected, 0), net, 1e-6);
        if (below && tau < 5) {
            const double direct = exp(-(double)tau / (double)mu0);
            close_to("  of it direct", part(x, x->mean.direct, 0), part(x, x->se.direct, 0), direct,
                     1e-6);
        }
        check_energy(x, albedo < 1);
        tyn_scene_finish(&scene);
    }
    fclose(f);
}

// Skips the test where it is absent.
static FILE *open_reference(const char *name)
{
    char path[512];
    FILE *f = shared_path(path, sizeof path, name) ? fopen(path, "r") : NULL;
    if (!f) {
        skip_without(name);
    }
    return f;
}

static void ground(void **state)
{
    FILE *f = open_reference("reference/slab_ground_flux.csv");
    char line[512];
    double reflected = 0;
    for (int i = 0; fgets(line, sizeof line, f);) {
        double tau, g, albedo, mu0, surface, depth, direct, down, up;
        if (sscanf(line, "%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf", &tau, &g, &albedo, &mu0, &surface,
                   &depth, &direct, &down, &up) != 9 ||
            tau > 5) {
            continue;
        }
        reflected = depth == 0 ? up : reflected;
        if (depth < 1 || i++ % 7) {
            continue;
        }
        tyn_scene scene;
        make_slab(&scene, (float)tau, (float)g, (float)albedo, false);
        light_slab(&scene, (float)mu0);
        const float a = (float)surface;
        uint32_t material = solids_material(&scene, (float[]){a, a, a}, (float[]){0, 0, 0});
        solids_quad(&scene, (float[]){0, 0, 0}, (float[]){0, 0, 1}, (float[]){1, 0, 0}, material);
        const tyn_fluxes *x = path_run_fluxes(*state, &scene, path_effort(12));
        char name[96];
        snprintf(name, sizeof name, "ground, slab %g, g %g, albedo %g, mu0 %g: R", tau, g, albedo,
                 mu0);
        close_to(name, part(x, x->mean.reflected, 0), part(x, x->se.reflected, 0), reflected, 1e-6);
        close_to("  arrives at the ground", part(x, x->mean.arriving_surfaces, 0),
                 part(x, x->se.arriving_surfaces, 0), direct + down, 1e-6);
        assert_true(part(x, x->mean.transmitted, 0) == 0);
        check_energy(x, true);
        tyn_scene_finish(&scene);
    }
    fclose(f);
}

// ---- a cube -----------------------------------------------------------------------------------

static void cube(void **state)
{
    FILE *f = open_reference("reference/cube_face_flux.csv");
    char line[256];
    double last_g = NAN;
    tyn_fluxes x = {0};
    while (fgets(line, sizeof line, f)) {
        double g, power, se;
        char face[64];
        if (sscanf(line, "%lf,%63[^,],%lf,%lf", &g, face, &power, &se) != 4) {
            continue;
        }
        if (!(g == last_g)) {
            tyn_scene scene;
            tyn_scene_init(&scene);
            const tyn_medium medium = grey_medium(4, 0, (float)g);
            scene_add_box(&scene, &medium, (float[]){0, 0, 0}, (float[]){1, 1, 1},
                          (uint32_t[]){1, 1, 1}, NULL);
            scene_add_sun(&scene, 1, 0, 0, 1, 1, 1);
            x = *path_run_fluxes(*state, &scene, path_effort(32));
            check_energy(&x, false);
            tyn_scene_finish(&scene);
            last_g = g;
        }
        double value = 0, error = 0;
        if (strstr(face, "direct")) {
            value = part(&x, x.mean.direct, 0);
            error = part(&x, x.se.direct, 0);
        } else if (strcmp(face, "absorbed") != 0) {
            const int i = strstr(face, "entry")  ? 0
                          : strstr(face, "exit") ? 1
                                                 : 2 + 2 * (face[0] == 'z') + (face[2] == '1');
            value = part(&x, x.mean.leaving[i], 0) - (i == 1 ? part(&x, x.mean.direct, 0) : 0);
            error = part(&x, x.se.leaving[i], 0);
        }
        char name[96];
        snprintf(name, sizeof name, "cube, g %g, %s", g, face);
        close_to(name, value, error, power, se);
    }
    fclose(f);
}

// ---- surroundings -----------------------------------------------------------------------------

// A constant sky, or a map that is as constant, around a slab that absorbs: T = 2 E3(tau).
static void sky(void **state)
{
    const double twice_e3 = 0.2193839344; // tau 1
    for (int map = 0; map < 2; map++) {
        tyn_scene scene;
        make_slab(&scene, 1, 0, 0, map);
        scene_set_sky(&scene, 2);
        if (map) {
            enum { TEXELS = 32 * 16 };
            scene.environment.size[0] = 32;
            scene.environment.size[1] = 16;
            scene.environment.data = malloc(3 * TEXELS * sizeof(float));
            for (int i = 0; i < 3 * TEXELS; i++) {
                scene.environment.data[i] = 1;
            }
        }
        const tyn_fluxes *x = path_run_fluxes(*state, &scene, path_effort(64));
        close_to(map ? "even map: T" : "sky: T", part(x, x->mean.transmitted, 0),
                 part(x, x->se.transmitted, 0), twice_e3, 0);
        close_to("  incident, W / (4 pi)", (double)x->mean.incident[0] / (4 * M_PI),
                 (double)x->se.incident[0] / (4 * M_PI), 1, 0);
        check_energy(x, true);
        tyn_scene_finish(&scene);
    }
}

// ---- from both ends ---------------------------------------------------------------------------

// Two media of several colours that overlap, a coloured sun and a sky: what is absorbed does not depend on where
// paths start. The balance has no standard error of its own for it; that of its sum is larger.
static void reciprocity(void **state)
{
    tyn_scene scene;
    tyn_scene_init(&scene);
    tyn_medium medium = grey_medium(1, 0.5f, 0.6f);
    medium.sigma_s[0] = 0.5f;
    medium.sigma_s[2] = 2;
    medium.phase[2].g = 0.2f;
    const uint32_t size[3] = {1, 1, 1};
    scene_add_box(&scene, &medium, (float[]){0, 0, 0}, (float[]){2, 2, 2}, size, NULL);
    medium.sigma_a[0] = 1.5f;
    medium.phase[0].g = -0.3f;
    scene_add_box(&scene, &medium, (float[]){1, 1, 1}, (float[]){3, 3, 3}, size, NULL);
    scene_add_sun(&scene, 0.36f, -0.8f, 0.48f, 4, 3, 2);
    scene_set_sky(&scene, 0.3f);
    const tyn_fluxes x = *path_run_fluxes(*state, &scene, path_effort(64));
    const tyn_balance *b = path_run_balance(*state, &scene, path_effort(60));
    check_energy(&x, true);
    for (int c = 0; c < 3; c++) {
        const double given = b->entering[c] + b->emitted[c];
        close_to("absorbed, from both ends", (double)x.mean.absorbed_media[c] / given,
                 (double)x.se.absorbed_media[c] / given, b->absorbed_media[c] / given,
                 b->imbalance_se[c]);
    }
    tyn_scene_finish(&scene);
}

// ---- what it cannot do ------------------------------------------------------------------------

static void refuses(path_run *r, const tyn_scene *scene)
{
    tyn_view v = {.width = 1, .height = 1, .outputs = TYN_OUTPUT_FLUXES, .num_samples = 1};
    tyn_camera_frame_scene(&v.camera, scene);
    assert_int_equal(tyn_offline_frame(r->off, scene, &v, false), TYN_ERR_UNSUPPORTED);
}

static void errors(void **state)
{
    tyn_scene scene;
    make_slab(&scene, 1, 0, 1, false);
    refuses(*state, &scene); // no light
    light_slab(&scene, 1);
    scene.media[0].emission[1] = 1;
    refuses(*state, &scene);
    scene.media[0].emission[1] = 0;
    scene.shapes[0].repeat[1] = true;
    refuses(*state, &scene);
    scene.shapes[0].repeat[1] = false;
    scene_add_lamp(&scene, (float[]){0.5f, 0.5f, 0.5f}, 1);
    refuses(*state, &scene);
    tyn_scene_finish(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slabs), cmocka_unit_test(ground), cmocka_unit_test(cube),
        cmocka_unit_test(sky),   cmocka_unit_test(errors), cmocka_unit_test(reciprocity),
    };
    setvbuf(stdout, NULL, _IOLBF, 0);
    cmocka_set_test_filter(getenv("TYN_TEST_FILTER"));
    return run_cases(tests, path_run_setup, path_run_teardown);
}
