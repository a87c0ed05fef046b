// pop_shafts.c -- where the edges of the sun's shafts are in the sample scene `fog-hall`: `pop` against `path`.
//
// An orthographic camera in the aisle looks straight down into the shaft of one window. The edges
// of the shaft that the window's jambs make are planes through the vertical and the sun, so they
// are seen edge-on: columns of the picture run along them, and the distance from the edge is that
// across the light, in which texels of the shadow map are measured.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "offline_frame.h"
#include "path_run.h"
#include "sample_scene.h"
#include "passes/shadow_map/shadow_map.h"
#include "shaders/surfaces/surface_args.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 48, SAMPLES = 64 };
static const double HALF = 0.12; // m, of the picture

// Sides of a texel of the sun's map, m.
static double texel_of(const tyn_scene *scene, uint32_t texels)
{
    static tyn_shadow_map_params plan;
    plan = (tyn_shadow_map_params){.sun_texels = (int32_t)texels, .lamp_texels = 16};
    struct surface_block surfaces;
    memset(&surfaces, 0, sizeof surfaces);
    for (int c = 0; c < 3; c++) {
        surfaces.lo[c] = INFINITY;
        surfaces.hi[c] = -INFINITY;
        surfaces.from_world[c][c] = surfaces.to_world[c][c] = 1;
    }
    for (uint32_t i = 0; i < scene->surfaces.num_vertices; i++) {
        for (int c = 0; c < 3; c++) {
            const float x = scene->surfaces.vertices[i].position[c];
            surfaces.lo[c] = fminf(surfaces.lo[c], x);
            surfaces.hi[c] = fmaxf(surfaces.hi[c], x);
        }
    }
    struct light_block sun;
    memset(&sun, 0, sizeof sun);
    memcpy(sun.direction, scene->lights[0].direction, sizeof sun.direction);
    tyn_shadow_map_plan(&plan, &sun, 1, NULL, 0, &surfaces);
    const struct shadow_light *l = &plan.lights[0];
    double most = 0;
    for (int r = 0; r < 2; r++) {
        const float *row = l->rows[r];
        const double length = sqrt((double)(row[0] * row[0] + row[1] * row[1] + row[2] * row[2]));
        most = maximum(most, 2 / (length * (double)l->texels));
    }
    return most;
}

// Where a profile over columns steps, in columns: where a step of its height would have the same area. Its levels
// are the means of the outer sixths.
static double step_of(const double *profile)
{
    double from = 0, to = 0, area = 0;
    for (int i = 0; i < SIZE / 6; i++) {
        from += profile[i] / (SIZE / 6);
        to += profile[SIZE - 1 - i] / (SIZE / 6);
    }
    assert_true(fabs(to - from) > 0.5 * fmax(from, to));
    for (int i = 0; i < SIZE; i++) {
        area += (profile[i] - from) / (to - from);
    }
    return SIZE - area;
}

static void edges(void **state)
{
    gpu_test *t = *state;
    tyn_scene *scene = malloc(sizeof *scene);
    sample_scene_load(scene, "fog-hall", t);
    memset(scene->environment.radiance, 0, sizeof scene->environment.radiance);
    const float *d = scene->lights[0].direction;
    const double level = sqrt((double)(d[0] * d[0] + d[2] * d[2]));
    const float up[3] = {(float)(d[0] / level), 0, (float)(d[2] / level)};
    const double texel = texel_of(scene, 2048), slope = (double)(d[2] / -d[0]), x = 3.8;
    // The window's jambs are at z = 1.2 and 2.8, between x = 5 and 5.6; outer and inner edges make the shaft's.
    const double z[2] = {1.2 + slope * (5.6 - x), 2.8 + slope * (5 - x)};
    path_run runs;
    path_run_open(&runs, t->dev);
    printf("a texel of the sun's map is %.1f mm, a pixel %.1f mm\n", 1e3 * texel,
           2e3 * HALF / SIZE);
    for (int k = 0; k < 2; k++) {
        tyn_view view = {.no_background = true, .max_depth = 1};
        view_orthographic(&view, (float[]){(float)x, 3.2f, (float)z[k]}, 0, -1, 0, up, (float)HALF,
                          SIZE);
        memcpy(view.camera.position, (float[]){(float)x, 3.2f, (float)z[k]},
               sizeof view.camera.position);
        picture reference = {0};
        path_run_picture(&runs, &reference, scene, &view, SAMPLES);
        tyn_offline *off;
        assert_int_equal(tyn_offline_create(t->dev, tyn_offline_params(.method = "pop"), &off),
                         TYN_OK);
        view.outputs = TYN_OUTPUT_RADIANCE | TYN_OUTPUT_SINGLE;
        offline_frame(off, scene, &view);
        const float *single = tyn_offline_output(off, TYN_OUTPUT_SINGLE);
        double profile[2][SIZE] = {{0}}, least = INFINITY, most = -INFINITY;
        for (int j = 0; j < SIZE; j++) {
            double row[SIZE];
            for (int i = 0; i < SIZE; i++) {
                row[i] = (double)single[4 * (j * SIZE + i) + 1];
                profile[0][i] += row[i] / SIZE;
                profile[1][i] += (double)reference.rgb[3 * (j * SIZE + i) + 1] / SIZE;
            }
            const double at = step_of(row);
            least = minimum(least, at);
            most = maximum(most, at);
        }
        const double texels = 2 * HALF / SIZE / texel;
        const double expected = step_of(profile[1]), mean = step_of(profile[0]);
        if (getenv("TYN_VERBOSE")) {
            for (int i = 0; i < SIZE; i++) {
                printf("  %2d: pop %.5f path %.5f\n", i, profile[0][i], profile[1][i]);
            }
        }
        const double sums[2] = {profile[0][0] + profile[0][SIZE - 1],
                                profile[1][0] + profile[1][SIZE - 1]};
        printf("edge %d: path at %.2f columns, pop at %.2f: %+.2f texels, rows %+.2f to %+.2f; "
               "levels %+.1f %%\n",
               k, expected, mean, (mean - expected) * texels, (least - expected) * texels,
               (most - expected) * texels, 100 * (sums[0] / sums[1] - 1));
        assert_within(fabs(mean - expected) * texels, 0.5, NULL);
        assert_within(maximum(most - expected, expected - least) * texels, 1, NULL);
        tyn_offline_destroy(&off);
        picture_free(&reference);
    }
    path_run_close(&runs);
    tyn_scene_finish(scene);
    free(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(edges)};
    setvbuf(stdout, NULL, _IOLBF, 0);
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
