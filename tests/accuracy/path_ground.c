// path_ground.c -- `path` in slabs over a Lambertian ground of albedo 0.8 (DISORT): a box that repeats along both
// horizontal axes, and a floor under it that repeats with it.
//
// Asserted: net flux and fluence at five depths, and leaving radiance, within 3 standard errors (4 for the largest of
// all), RMS of z below 1.3. TYN_LONG=N: all rows, N times the samples.
#include "numbers.h"
#include "path_run.h"
#include "npy.h"
#include "skip.h"
#include "solids.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct slab {
    float tau, g, albedo, mu0;
} slab;

// 1 m thick, y up. `turned`: M's axes are not the world's.
static void make_slab(tyn_scene *scene, const slab *s, bool turned)
{
    tyn_scene_init(scene);
    const float ss = s->tau * s->albedo;
    tyn_medium m = grey_medium(ss, s->tau - ss, s->g);
    tyn_shape *shape = scene_add_box(scene, &m, (float[]){0, 0, 0}, (float[]){1, 1, 1}, NULL, NULL);
    shape->repeat[0] = shape->repeat[2] = true;
    uint32_t ground = solids_material(scene, (float[]){0.8f, 0.8f, 0.8f}, (float[]){0, 0, 0});
    if (turned) { // a quarter about y: x -> -z, z -> x
        memset(shape->to_world, 0, 12 * sizeof(float));
        shape->to_world[2] = -1;
        shape->to_world[5] = 1;
        shape->to_world[8] = 1;
    }
    solids_quad(scene, (float[]){0, 0, 0}, (float[]){0, 0, 1}, (float[]){1, 0, 0}, ground);
    const float e = 1 / s->mu0;
    scene_add_sun(scene, sqrtf(1 - s->mu0 * s->mu0), -s->mu0, 0, e, e, e);
}

static double largest, sum_z2;
static int num_z;

static void check(const slab *s, const char *what, double value, double se, double expected)
{
    double z = (value - expected) / se;
    printf("tau %-4g g %-4g albedo %-4g mu0 %-3g %-24s %.6f +- %.6f  expected %.6f  z %+.2f\n",
           (double)s->tau, (double)s->g, (double)s->albedo, (double)s->mu0, what, value, se,
           expected, z);
    assert_true(isfinite(z));
    largest = maximum(largest, fabs(z));
    sum_z2 += z * z;
    num_z++;
}

// Skips the case where it is absent.
static FILE *open_table(const char *name)
{
    char path[512];
    FILE *f = shared_path(path, sizeof path, name) ? fopen(path, "r") : NULL;
    if (!f) {
        skip_without(name);
    }
    return f;
}

// Without TYN_LONG: thin and medium slabs of a few kinds.
static bool chosen(const slab *s)
{
    bool some = s->g == 0.75f || (s->g == 0 && s->tau == 1) || (s->g == 0.95f && s->tau == 1);
    return getenv("TYN_LONG") || (s->tau < 10 && some && (s->albedo < 1) == (s->mu0 < 1));
}

static void fluxes(void **state)
{
    path_run *runs = *state;
    FILE *f = open_table("reference/slab_ground_flux.csv");
    char line[512];
    enum { DEPTHS = 5 };
    float points[DEPTHS][3];
    double net[DEPTHS], fluence[DEPTHS];
    int depths = 0, slabs = 0;
    while (fgets(line, sizeof line, f)) {
        slab s;
        double ground, depth, direct, down, up, mean;
        if (sscanf(line, "%f,%f,%f,%f,%lf,%lf,%lf,%lf,%lf,%lf", &s.tau, &s.g, &s.albedo, &s.mu0,
                   &ground, &depth, &direct, &down, &up, &mean) != 10) {
            continue;
        }
        points[depths][0] = 0.3f;
        points[depths][1] = (float)fmin(fmax(1 - depth, 1e-5), 1 - 1e-5);
        points[depths][2] = 0.6f;
        net[depths] = direct + down - up;
        fluence[depths] = 4 * M_PI * mean;
        if (++depths < DEPTHS) {
            continue;
        }
        depths = 0;
        if (!chosen(&s)) {
            continue;
        }
        tyn_scene scene;
        make_slab(&scene, &s, slabs++ % 2);
        const tyn_probe_result *p = path_run_probe(runs, &scene, (const float(*)[3])points, DEPTHS,
                                                   false, path_effort(16384));
        for (int i = 0; i < DEPTHS; i++) {
            char what[64];
            snprintf(what, sizeof what, "flux at %.2f", (double)points[i][1]);
            check(&s, what, -(double)p[i].flux[3], p[i].flux_se[3], net[i]);
            snprintf(what, sizeof what, "fluence at %.2f", (double)points[i][1]);
            check(&s, what, p[i].fluence[0], p[i].fluence_se[0], fluence[i]);
        }
        tyn_scene_finish(&scene);
    }
    fclose(f);
}

static void radiances(void **state)
{
    path_run *runs = *state;
    FILE *f = open_table("reference/slab_ground_radiance.csv");
    char line[512];
    int row = 0;
    while (fgets(line, sizeof line, f)) {
        slab s;
        char side[8];
        double ground, mu, radiance[3], rel_err;
        if (sscanf(line, "%f,%f,%f,%f,%lf,%7[^,],%lf,%lf,%lf,%lf,%lf", &s.tau, &s.g, &s.albedo,
                   &s.mu0, &ground, side, &mu, &radiance[0], &radiance[1], &radiance[2],
                   &rel_err) != 11 ||
            !(rel_err < 1e-3) || !chosen(&s) || (!getenv("TYN_LONG") && row++ % 7)) {
            continue;
        }
        tyn_scene scene;
        make_slab(&scene, &s, row % 2);
        const bool top = !strcmp(side, "top");
        const int azimuth = row % 3;
        const double phi = azimuth * M_PI / 2, across = sqrt(1 - mu * mu);
        tyn_view view = {0};
        // Against the light's way; at the bottom from the ground.
        view_orthographic(&view, (float[]){0.5f, 0, 0.5f}, (float)(-across * cos(phi)),
                          (float)(top ? -mu : mu), (float)(-across * sin(phi)),
                          (float[]){0.3f, 0.1f, 0.8f}, 0.1f, 1);
        view.camera.position[1] = top ? 1.5f : 1e-5f;
        if (!top) {
            view.camera.ymag = 1e-6f;
        }
        picture p = {0};
        path_run_picture(runs, &p, &scene, &view, path_effort(16384));
        char what[64];
        snprintf(what, sizeof what, "radiance %s %.2f %d", side, mu, 90 * azimuth);
        check(&s, what, p.rgb[0], hypot(p.se[0], rel_err * radiance[azimuth]), radiance[azimuth]);
        picture_free(&p);
        tyn_scene_finish(&scene);
    }
    fclose(f);
}

static void summary(void **state)
{
    (void)state;
    if (!num_z) {
        skip_without("all tables, so no values");
    }
    printf("%d values: RMS of z %.2f, largest %.2f\n", num_z, sqrt(sum_z2 / num_z), largest);
    assert_true(sqrt(sum_z2 / num_z) < 1.3);
    assert_true(largest <= (num_z < 200 ? 3.5 : 4));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fluxes),
        cmocka_unit_test(radiances),
        cmocka_unit_test(summary),
    };
    setvbuf(stdout, NULL, _IOLBF, 0);
    cmocka_set_test_filter(getenv("TYN_TEST_FILTER"));
    return run_cases(tests, path_run_setup, path_run_teardown);
}
