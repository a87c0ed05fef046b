// path_lamps.c -- `path` with point lights against references: the profile of a lit sphere of fog (own Monte Carlo,
// tied to DISORT and pbrt), the airlight of a single order and the fluence about a point source in an infinite
// medium (closed forms).
//
// Asserted: every figure within 4 standard errors, RMS of z below 1.3. TYN_LONG=N: all rows, 8 N times the samples.
#include "numbers.h"
#include "path_run.h"
#include "npy.h"
#include "skip.h"
#include "solids.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static double largest, sum_z2;
static int num_z;

static void check(const char *what, double value, double se, double expected)
{
    double z = (value - expected) / se;
    printf("%-44s %.6g +- %.2g  expected %.6g  z %+.2f\n", what, value, se, expected, z);
    assert_true(isfinite(z));
    largest = maximum(largest, fabs(z));
    sum_z2 += z * z;
    num_z++;
}

// More rows need more samples: where a pixel has few, its standard error is smaller the more of its light is missing.
static uint32_t effort(uint32_t samples)
{
    return path_effort(samples) * (getenv("TYN_LONG") ? 8 : 1);
}

static FILE *open_table(const char *name)
{
    char path[512];
    FILE *f = shared_path(path, sizeof path, name) ? fopen(path, "r") : NULL;
    if (!f) {
        skip_without(name);
    }
    return f;
}

// ---- sphere -----------------------------------------------------------------------------------

enum { BINS = 40, PIXELS = 96 };

typedef struct profile {
    float sigma_s, g, r;
    double value[BINS], se[BINS];
} profile;

// Means over the rings between equal steps of (b / R)^2, by pixels whose middle is in a ring: pixels are small
// against the rings but near the rim, whose last ring is left out.
static void check_profile(path_run *runs, const profile *ref)
{
    tyn_scene scene;
    tyn_scene_init(&scene);
    tyn_medium fog = grey_medium(ref->sigma_s, 0, ref->g);
    tyn_shape *shape = scene_add_box(&scene, &fog, (float[]){-2.5f, -2.5f, -2.5f},
                                     (float[]){2.5f, 2.5f, 2.5f}, NULL, NULL);
    shape->kind = TYN_SHAPE_SPHERE;
    if (ref->r > 0) {
        const float l = 1 / ((float)M_PI * ref->r * ref->r);
        uint32_t m = solids_material(&scene, (float[]){0, 0, 0}, (float[]){l, l, l});
        solids_sphere(&scene, (float[]){0, 0, 0}, ref->r, 32, false, m);
        solids_hierarchy(&scene, 2);
    } else {
        scene_add_lamp(&scene, (float[]){0, 0, 0}, 1);
    }
    tyn_view view = {.no_background = true}; // without what is seen of the source
    view_orthographic(&view, (float[]){0, 0, 0}, 0.3f, -1, 0.2f, (float[]){0, 0, 1}, 2.5f, PIXELS);
    picture p = {0};
    path_run_picture(runs, &p, &scene, &view, effort(ref->r > 0 ? 24 : 12));
    double sum[BINS] = {0}, var[BINS] = {0}, count[BINS] = {0};
    for (int i = 0; i < PIXELS * PIXELS; i++) {
        double x = (i % PIXELS + 0.5) * 2 / PIXELS - 1, y = (i / PIXELS + 0.5) * 2 / PIXELS - 1;
        int bin = (int)((x * x + y * y) * BINS);
        if (bin < BINS) {
            sum[bin] += p.rgb[3 * i];
            var[bin] += (double)p.se[3 * i] * p.se[3 * i];
            count[bin]++;
        }
    }
    // Rings of four bins: single ones hold too few pixels for their edges to cancel.
    for (int i = 0; i + 4 < BINS; i += 4) {
        double value = 0, v = 0, n = 0, expected = 0, v_ref = 0;
        for (int k = i; k < i + 4; k++) {
            value += sum[k];
            v += var[k];
            n += count[k];
            expected += 0.25 * ref->value[k];
            v_ref += ref->se[k] * ref->se[k] / 16;
        }
        // Pixels at a ring's edges: half a percent of what it has.
        double edges = i == 0 ? 0.015 : 0.005;
        char what[96];
        snprintf(what, sizeof what, "sphere %g, g %g, r %g, ring %d", (double)ref->sigma_s,
                 (double)ref->g, (double)ref->r, i / 4);
        check(what, value / n, sqrt(v / n / n + v_ref + edges * edges * expected * expected),
              expected);
    }
    picture_free(&p);
    tyn_scene_finish(&scene);
}

static void sphere(void **state)
{
    FILE *f = open_table("reference/sphere_profile.csv");
    char line[256];
    profile ref = {0};
    int bins = 0;
    while (fgets(line, sizeof line, f)) {
        double b2;
        if (sscanf(line, "%f,%f,%f,%lf,%lf,%lf", &ref.sigma_s, &ref.g, &ref.r, &b2,
                   &ref.value[bins], &ref.se[bins]) != 6) {
            continue;
        }
        if (++bins < BINS) {
            continue;
        }
        bins = 0;
        if (getenv("TYN_LONG") || ref.sigma_s == 1) {
            check_profile(*state, &ref);
        }
    }
    fclose(f);
}

// ---- airlight ---------------------------------------------------------------------------------

// A box that is large enough for what is beyond it not to count.
static void airlight(void **state)
{
    path_run *runs = *state;
    FILE *f = open_table("reference/airlight_single.csv");
    char line[256];
    int row = 0;
    while (fgets(line, sizeof line, f)) {
        float st, ss, g, d, gamma;
        double expected;
        if (sscanf(line, "%f,%f,%f,%f,%f,%lf", &st, &ss, &g, &d, &gamma, &expected) != 6 ||
            (!getenv("TYN_LONG") && row++ % 4)) {
            continue;
        }
        tyn_scene scene;
        tyn_scene_init(&scene);
        tyn_medium m = grey_medium(ss, st - ss, g);
        const float r = 25 / st + d;
        scene_add_box(&scene, &m, (float[]){-r, -r, -r}, (float[]){r, r, r}, NULL, NULL);
        const float a = gamma * (float)M_PI / 180;
        scene_add_lamp(&scene, (float[]){d * sinf(a), 0, -d * cosf(a)}, 1);
        tyn_view view = {0};
        view_orthographic(&view, (float[]){0, 0, 0}, 0, 0, -1, (float[]){0, 1, 0}, 1e-4f, 1);
        memset(view.camera.position, 0, sizeof view.camera.position);
        view.max_depth = 1;
        picture p = {0};
        path_run_picture(runs, &p, &scene, &view, effort(8192));
        char what[96];
        snprintf(what, sizeof what, "airlight %g %g, g %g, %g m, %g deg", (double)st, (double)ss,
                 (double)g, (double)d, (double)gamma);
        check(what, p.rgb[0], p.se[0], expected);
        picture_free(&p);
        tyn_scene_finish(&scene);
    }
    fclose(f);
}

// ---- point source -----------------------------------------------------------------------------

static void point_source(void **state)
{
    path_run *runs = *state;
    FILE *f = open_table("reference/pointsource_infinite_exact.csv");
    char line[256];
    while (fgets(line, sizeof line, f)) {
        double albedo, r, expected;
        // An albedo of 1 needs a box without end: paths in it have none either.
        if (sscanf(line, "%lf,%lf,%lf", &albedo, &r, &expected) != 3 || albedo == 1 ||
            r > (getenv("TYN_LONG") ? 5 : 3)) {
            continue;
        }
        tyn_scene scene;
        tyn_scene_init(&scene);
        tyn_medium m = grey_medium((float)albedo, (float)(1 - albedo), 0);
        const float half = 30;
        scene_add_box(&scene, &m, (float[]){-half, -half, -half}, (float[]){half, half, half}, NULL,
                      NULL);
        scene_add_lamp(&scene, (float[]){0, 0, 0}, 1 / (4 * (float)M_PI));
        const float points[1][3] = {{(float)(r * 0.6), (float)(r * -0.48), (float)(r * 0.64)}};
        const tyn_probe_result *p = path_run_probe(runs, &scene, points, 1, false, effort(16384));
        char what[96];
        snprintf(what, sizeof what, "point source, albedo %g at %g m", albedo, r);
        check(what, p->fluence[0], p->fluence_se[0], expected);
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
    assert_true(largest <= 4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sphere),
        cmocka_unit_test(airlight),
        cmocka_unit_test(point_source),
        cmocka_unit_test(summary),
    };
    setvbuf(stdout, NULL, _IOLBF, 0);
    cmocka_set_test_filter(getenv("TYN_TEST_FILTER"));
    return run_cases(tests, path_run_setup, path_run_teardown);
}
