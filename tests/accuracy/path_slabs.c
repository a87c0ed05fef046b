// path_slabs.c -- `path` against plane-parallel slabs (tests/data/slabs.csv, from DISORT): a box that repeats
// along both horizontal axes, lit from above.
//
// Asserted: net flux and fluence just inside the faces within 3 standard errors, which are at most 0.5 % of the
// flux; leaving radiance, through a camera of one pixel, within 3 standard errors.
#include "numbers.h"
#include "path_scene.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_ROWS = 128 };

typedef struct row {
    bool flux;
    float tau, g, albedo, mu0;
    bool bottom;
    float mu, phi; // of radiances; phi in degrees
    double value, fluence;
} row;

static bool effort; // TYN_LONG: standard errors of 0.1 %, and the thickest slabs as well
static row rows[MAX_ROWS];
static int num_rows;

static int read_rows(void **state)
{
    FILE *f = fopen(TYN_TEST_DATA "/slabs.csv", "r");
    assert_non_null(f);
    char line[256];
    while (fgets(line, sizeof line, f) && num_rows < MAX_ROWS) {
        row *r = &rows[num_rows];
        char kind[16], place[8], rest[64] = "";
        if (sscanf(line, "%15[a-z],%f,%f,%f,%f,%7[^,],%63s", kind, &r->tau, &r->g, &r->albedo,
                   &r->mu0, place, rest) != 7) {
            continue; // comments and the heading
        }
        r->flux = !strcmp(kind, "flux");
        r->bottom = !strcmp(place, "1") || !strcmp(place, "bot");
        int got = r->flux ? sscanf(rest, ",,%lf,%lf", &r->value, &r->fluence)
                          : sscanf(rest, "%f,%f,%lf", &r->mu, &r->phi, &r->value);
        assert_int_equal(got, r->flux ? 2 : 3);
        num_rows++;
    }
    fclose(f);
    effort = getenv("TYN_LONG") != NULL;
    return gpu_setup(state);
}

// The slab is 1 m thick, z up. Density along z varies if `graded`: in terms of optical depth the light field is
// the same, so this tests the grid, its bricks and their wrapping with the same numbers.
static void make_slab(path_scene *s, const row *r, bool graded)
{
    static float grid[4 * 4 * 24];
    const uint32_t size[3] = {4, 4, 24};
    double sum = 0;
    for (int i = 0; i < 4 * 4 * 24; i++) {
        double z = (i / 16 + 0.5) / 24;
        grid[i] = (float)(0.3 + z * z + (z > 0.4 && z < 0.6 ? 1.0 : 0.0));
        sum += grid[i] / (4 * 4 * 24);
    }
    // Voxel means are the trilinear mean but for the outer half voxels, which are constant: equal here.
    float sigma_t = r->tau / (float)(graded ? sum : 1), ss = sigma_t * r->albedo, sa = sigma_t - ss;
    path_scene_box(s, (float[]){1, 1, 1}, (float[]){ss, ss, ss}, (float[]){sa, sa, sa},
                   (float[]){r->g, r->g, r->g}, graded ? grid : NULL, size);
    s->medium.repeat[0] = s->medium.repeat[1] = 1;
    s->params.repeat = 1;
    float e = 1 / r->mu0;
    path_scene_sun(s, (float[]){sqrtf(1 - r->mu0 * r->mu0), 0, -r->mu0}, (float[]){e, e, e});
    s->params.seed = (uint32_t)(r - rows);
}

static double worst, sum_z2;
static int num_z;

static void check(const row *r, const char *what, double value, double error, double expected)
{
    double z = (value - expected) / error;
    printf("tau %-4g g %-4g albedo %-4g mu0 %-3g %-6s %-8s %.6f +- %.6f  expected %.6f  z %+.2f\n",
           (double)r->tau, (double)r->g, (double)r->albedo, (double)r->mu0,
           r->bottom ? "bottom" : "top", what, value, error, expected, z);
    worst = maximum(worst, fabs(z));
    sum_z2 += z * z;
    num_z++;
    assert_true(fabs(z) <= 3);
}

static void test_fluxes(gpu_test *t, bool graded)
{
    for (int i = 0; i < num_rows; i++) {
        const row *r = &rows[i];
        if (!r->flux || (graded && i % 7) ||
            (!effort && r->tau > 4 && (r->albedo == 1 || r->bottom))) {
            continue;
        }
        path_scene s;
        make_slab(&s, r, graded);
        float inside = 1e-6f;
        const float points[1][3] = {{0.5f, 0.5f, r->bottom ? inside : 1 - inside}};
        s.samples = 16384;
        const tyn_probe_result *p = NULL;
        double aim = effort ? 0.001 : 0.005;
        for (uint32_t done = 0; done < (effort ? 16384 : 256) * s.samples; done += s.samples) {
            p = path_scene_probe_more(t, &s, points, 1, done);
            if (p->flux_se[6] < 0.9 * aim * fabs(r->value) && p->fluence_se[0] < aim * r->fluence) {
                break;
            }
        }
        assert_true(p->flux_se[6] <= aim * fabs(r->value));
        check(r, graded ? "flux*" : "flux", -(double)p->flux[6], p->flux_se[6], r->value);
        check(r, graded ? "fluence*" : "fluence", p->fluence[0], p->fluence_se[0], r->fluence);
    }
}

static void fluxes(void **state)
{
    test_fluxes(*state, false);
}

static void fluxes_of_graded_slabs(void **state)
{
    test_fluxes(*state, true);
}

static void radiances(void **state)
{
    for (int i = 0; i < num_rows; i++) {
        const row *r = &rows[i];
        if (r->flux) {
            continue;
        }
        path_scene s;
        make_slab(&s, r, false);
        float sin_theta = sqrtf(1 - r->mu * r->mu), phi = r->phi * (float)M_PI / 180;
        float up = r->bottom ? -1 : 1;
        // The camera looks against the direction of travel.
        float direction[3] = {-sin_theta * cosf(phi), -sin_theta * sinf(phi), -up * r->mu};
        path_scene_orthographic(&s, (float[]){0.5f, 0.5f, 0.5f}, direction, (float[]){0, 1, 0},
                                0.1f, 1);
        s.samples = 32768;
        const float *radiance, *error;
        path_scene_render(*state, &s, 4 * s.samples, &radiance, &error);
        check(r, "radiance", radiance[0], error[0], r->value);
    }
}

static void summary(void **state)
{
    (void)state;
    printf("%d values: RMS of z %.2f, largest %.2f\n", num_z, sqrt(sum_z2 / num_z), worst);
    assert_true(sqrt(sum_z2 / num_z) < 1.3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fluxes),
        cmocka_unit_test(fluxes_of_graded_slabs),
        cmocka_unit_test(radiances),
        cmocka_unit_test(summary),
    };
    setvbuf(stdout, NULL, _IOLBF, 0);
    cmocka_set_test_filter(getenv("TYN_TEST_FILTER"));
    return cmocka_run_group_tests(tests, read_rows, gpu_teardown);
}
