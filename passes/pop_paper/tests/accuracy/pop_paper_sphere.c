// pop_paper_sphere.c -- the case of Fig 10 of Elek et al. 2014: a uniform white sphere with a lamp in its middle,
// a radial grid of 32^3, against a Monte Carlo. The published scheme is far off; what is asserted is that it is
// no further off than it was measured to be. With TYN_READINGS set further readings are measured.
#include "bound.h"
#include "gpu_test.h"
#include "npy.h"
#include "picture.h"
#include "skip.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { RINGS = 40, PIXELS = 128, MAX_ROWS = 512, COLUMNS = 6 };

static uint32_t read_table(double rows[][COLUMNS])
{
    char path[512], line[256];
    FILE *file =
        shared_path(path, sizeof path, "reference/sphere_profile.csv") ? fopen(path, "r") : NULL;
    uint32_t count = 0;
    while (file && count < MAX_ROWS && fgets(line, sizeof line, file)) {
        double *r = rows[count];
        count += sscanf(line, "%lf,%lf,%lf,%lf,%lf,%lf", r, r + 1, r + 2, r + 3, r + 4, r + 5) ==
                 COLUMNS;
    }
    if (file) {
        fclose(file);
    }
    return count;
}

// Radiance by rings of equal area.
static void profile(gpu_test *t, float sigma, float g, const char *settings, double ring[RINGS])
{
    tyn_medium medium = grey_medium(sigma, 0, g);
    tyn_scene *scene = malloc(sizeof *scene);
    tyn_scene_init(scene);
    tyn_shape *shape = scene_add_box(scene, &medium, (float[]){-2.5f, -2.5f, -2.5f},
                                     (float[]){2.5f, 2.5f, 2.5f}, NULL, NULL);
    shape->kind = TYN_SHAPE_SPHERE;
    scene->lights[scene->num_lights++] =
        (tyn_light){.kind = TYN_LIGHT_POINT, .color = {1, 1, 1}, .direction = {0, 0, -1}};
    tyn_view view = {0};
    view_orthographic(&view, (float[]){0, 0, 0}, 0, -1, 0, (float[]){0, 0, 1}, 2.5f, PIXELS);
    picture p;
    picture_render(&p, t->dev, "pop-paper", scene, &view, settings, 0);
    double pixels[RINGS] = {0};
    memset(ring, 0, RINGS * sizeof *ring);
    for (int i = 0; i < PIXELS * PIXELS; i++) {
        double x = (2 * (i % PIXELS) + 1.0) / PIXELS - 1, y = (2 * (i / PIXELS) + 1.0) / PIXELS - 1;
        int k = (int)((x * x + y * y) * RINGS);
        assert_true(isfinite(p.rgb[3 * i]) && p.rgb[3 * i] >= 0);
        if (k < RINGS) {
            ring[k] += p.rgb[3 * i];
            pixels[k]++;
        }
    }
    for (int k = 0; k < RINGS; k++) {
        ring[k] /= pixels[k];
    }
    picture_free(&p);
    tyn_scene_finish(scene);
    free(scene);
}

// Relative difference of the rings, as it is and with the best common factor.
static double difference(const double *ring, const double *reference, double factor)
{
    double off = 0, sum = 0;
    for (int k = 0; k < RINGS; k++) {
        off += fabs(factor * ring[k] - reference[k]);
        sum += reference[k];
    }
    return off / sum;
}

static double best_factor(const double *ring, const double *reference)
{
    double best = 1, least = INFINITY;
    for (double f = 1e-3; f < 1e3; f *= 1.02) {
        double d = difference(ring, reference, f);
        best = d < least ? f : best;
        least = fmin(d, least);
    }
    return best;
}

static void rings(void **state)
{
    static const struct {
        const char *name, *settings;
        double limits[2]; // of the difference, for g = 0.2 and 0.8; 0: none
    } readings[] = {
        {"power", "", {0.95, 0.42}},
        {"spacing", "propagate_radial.scale=spacing", {1.1, 11}},
        {"reciprocal", "propagate_radial.scale=reciprocal", {0.95, 0.42}},
        {"power, narrowing", "propagate_radial.narrowing=1", {0.9, 0.09}},
        {"power, 80 iterations", "propagate_radial.iterations=80", {0}},
        {"spacing, 80 iterations",
         "propagate_radial.scale=spacing propagate_radial.iterations=80",
         {0}},
        {"reciprocal, 80 iterations",
         "propagate_radial.scale=reciprocal propagate_radial.iterations=80",
         {0}},
        {"power, narrowing, 80 iterations",
         "propagate_radial.narrowing=1 propagate_radial.iterations=80",
         {0}},
        {"reciprocal, narrowing, 80 iterations",
         "propagate_radial.scale=reciprocal propagate_radial.narrowing=1 "
         "propagate_radial.iterations=80",
         {0}},
        {"power, first collision", "propagate_radial.init=first_collision", {0}},
        {"reciprocal, first collision, exact rate, narrowing, 80 iterations",
         "propagate_radial.scale=reciprocal propagate_radial.init=first_collision "
         "propagate_radial.rate=exact propagate_radial.narrowing=1 propagate_radial.iterations=80",
         {0}},
    };
    enum { NUM = sizeof readings / sizeof *readings, ASSERTED = 4 };
    static double rows[MAX_ROWS][COLUMNS];
    uint32_t count = read_table(rows), first = getenv("TYN_READINGS") ? NUM : ASSERTED;
    if (count == 0) {
        skip_without("reference/sphere_profile.csv");
    }
    for (uint32_t n = 0; n < first; n++) {
        for (uint32_t i = 0; i + RINGS <= count; i += RINGS) {
            if (rows[i][2] > 0) {
                continue; // an emitter of finite size
            }
            double ring[RINGS], reference[RINGS], sum = 0, expected = 0;
            char settings[512];
            snprintf(settings, sizeof settings,
                     "propagate_radial.cells=32 propagate_radial.shells=32 "
                     "%s%s merge_grids.finer=1",
                     strstr(readings[n].settings, "iterations") ? ""
                                                                : "propagate_radial.iterations=32 ",
                     readings[n].settings);
            profile(*state, (float)rows[i][0], (float)rows[i][1], settings, ring);
            for (int k = 0; k < RINGS; k++) {
                reference[k] = rows[i + (uint32_t)k][4];
                sum += ring[k];
                expected += reference[k];
                if (getenv("TYN_VERBOSE")) {
                    print_message("   %2d: %.5f, reference %.5f\n", k, ring[k], reference[k]);
                }
            }
            double factor = best_factor(ring, reference), off = difference(ring, reference, 1);
            print_message("%s, sigma_s %.1f, g %.1f: rel_l1 %.2f, bias %+.2f; with a factor %.2f: "
                          "%.2f\n",
                          readings[n].name, rows[i][0], rows[i][1], off, sum / expected - 1, factor,
                          difference(ring, reference, factor));
            double limit = readings[n].limits[rows[i][1] > 0.5];
            assert_true(limit == 0 ||
                        within(off, limit, NULL, "%s, g %g", readings[n].name, rows[i][1]));
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(rings)};
    return run_cases(tests, gpu_setup, gpu_teardown);
}
