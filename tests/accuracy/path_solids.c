// path_solids.c -- `path` with surfaces against closed forms: furnaces, closed boxes, form factors, shadows.
#include "bound.h"
#include "numbers.h"
#include "path_run.h"
#include "solids.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const float BLACK[3] = {0, 0, 0}, WHITE[3] = {1, 1, 1};

static void check(const char *what, double value, double se, double expected)
{
    double z = (value - expected) / maximum(se, 1e-6 * fabs(expected));
    printf("%-44s %.6f +- %.6f  expected %.6f  z %+.2f\n", what, value, se, expected, z);
    assert_true(isfinite(z) && fabs(z) <= 3);
}

// Mean of a picture's channel and its standard error.
static double mean(const picture *p, int c, double *se)
{
    double sum = 0, var = 0;
    uint32_t n = p->width * p->height;
    for (uint32_t i = 0; i < n; i++) {
        sum += p->rgb[3 * i + (uint32_t)c];
        var += (double)p->se[3 * i + (uint32_t)c] * p->se[3 * i + (uint32_t)c];
    }
    *se = sqrt(var) / n;
    return sum / n;
}

// White things under a sky of 1 cannot be seen, in and around a medium of albedo 1.
static void furnaces(void **state)
{
    path_run *runs = *state;
    for (int i = 0; i < 6; i++) {
        tyn_scene scene;
        tyn_scene_init(&scene);
        uint32_t white = solids_material(&scene, WHITE, BLACK);
        solids_sphere(&scene, (float[]){0, 0, 0}, 0.4f, 12, false, white);
        solids_box(&scene, (float[]){-2, -0.6f, -2}, (float[]){2, -0.5f, 2}, 0.3f, false, white);
        solids_quad(&scene, (float[]){0.5f, -0.5f, -1}, (float[]){0, 0, 2}, (float[]){0, 1.2f, 0},
                    white);
        if (i % 2) {
            solids_hierarchy(&scene, 3);
        }
        tyn_medium m = grey_medium(3, 0, 0.6f);
        if (i / 2 == 1) {
            scene_add_box(&scene, &m, (float[]){-1, -1, -1}, (float[]){1, 1, 1}, NULL, NULL);
        } else if (i / 2 == 2) {
            m.sigma_s[1] = 1.5f;
            m.sigma_s[2] = 6;
            float grid[27];
            for (int k = 0; k < 27; k++) {
                grid[k] = k % 5 * 0.3f;
            }
            scene_add_box(&scene, &m, (float[]){-1, -0.5f, -1}, (float[]){1, 1, 1},
                          (uint32_t[]){3, 3, 3}, grid);
        }
        scene_set_sky(&scene, 1);
        tyn_view view = {0};
        view_perspective(&view, (float[]){1.5f, 1, 2}, (float[]){0, -0.1f, 0}, 0.7f, 24);
        picture p = {0};
        path_run_picture(runs, &p, &scene, &view, path_effort(16));
        for (int c = 0; c < 3; c++) {
            double se, value = mean(&p, c, &se);
            char name[64];
            snprintf(name, sizeof name, "furnace %s %s %d",
                     (const char *[]){"no medium", "fog", "coloured"}[i / 2],
                     i % 2 ? "hierarchy" : "all", c);
            check(name, value, se, 1);
        }
        picture_free(&p);
        tyn_scene_finish(&scene);
    }
}

// Closed box of albedo rho whose walls emit 1: 1 / (1 - rho) everywhere, with any medium of albedo 1 inside.
static void closed_box(void **state)
{
    path_run *runs = *state;
    for (int i = 0; i < 4; i++) {
        const float scale = (const float[]){1, 1e-3f, 1e5f, 1}[i], rho = 0.5f;
        tyn_scene scene;
        tyn_scene_init(&scene);
        uint32_t wall = solids_material(&scene, (float[]){rho, 0.2f, 0}, WHITE);
        const float lo[3] = {0, 0, 0}, hi[3] = {3 * scale, 2 * scale, 4 * scale};
        solids_box(&scene, lo, hi, 0.4f, true, wall);
        tyn_medium m = grey_medium(0.8f / scale, 0, 0.5f);
        if (i != 3) {
            scene_add_box(&scene, &m, (float[]){scale, 0.5f * scale, scale},
                          (float[]){2 * scale, scale, 3 * scale}, NULL, NULL);
        }
        tyn_view view = {0};
        view_perspective(&view, (float[]){scale, scale, scale}, (float[]){3 * scale, 0, 3 * scale},
                         1, 16);
        picture p = {0};
        path_run_picture(runs, &p, &scene, &view, path_effort(64));
        for (int c = 0; c < 3; c++) {
            double se, value = mean(&p, c, &se);
            char name[64];
            snprintf(name, sizeof name, "closed box, scale %g, %d", (double)scale, c);
            check(name, value, se, 1 / (1 - (double)(const float[]){rho, 0.2f, 0}[c]));
        }
        picture_free(&p);
        tyn_scene_finish(&scene);
    }
}

// Irradiance of a floor under a parallel, square emitter at height h: the form factor from a point on the axis to
// a square of half side a (Howell, "A catalog of radiation configuration factors", B-3 times four).
static double form_factor(double a, double h)
{
    double x = a / h, r = sqrt(1 + x * x);
    return 4 * (1 / (2 * M_PI)) * 2 * (x / r * atan(x / r));
}

static void form_factors(void **state)
{
    path_run *runs = *state;
    for (int i = 0; i < 3; i++) {
        const float half = (const float[]){0.1f, 1, 5}[i], h = 1;
        tyn_scene scene;
        tyn_scene_init(&scene);
        uint32_t floor = solids_material(&scene, (float[]){0.6f, 0.6f, 0.6f}, BLACK);
        uint32_t lamp = solids_material(&scene, BLACK, (float[]){2, 1, 0.5f});
        solids_quad(&scene, (float[]){-10, 0, -10}, (float[]){0, 0, 20}, (float[]){20, 0, 0},
                    floor);
        solids_quad(&scene, (float[]){-half, h, -half}, (float[]){2 * half, 0, 0},
                    (float[]){0, 0, 2 * half}, lamp); // front downwards
        tyn_view view = {0};
        view_orthographic(&view, (float[]){0, 0, 0}, 1, -0.2f, 0, (float[]){0, 1, 0}, 1e-3f, 1);
        view.camera.position[0] = -0.05f; // below the emitter
        view.camera.position[1] = 0.01f;
        picture p = {0};
        path_run_picture(runs, &p, &scene, &view, path_effort(8192));
        for (int c = 0; c < 3; c++) {
            char name[64];
            snprintf(name, sizeof name, "form factor, half side %g, %d", (double)half, c);
            check(name, p.rgb[c], p.se[c],
                  0.6 * form_factor(half, h) * (double)(const float[]){2, 1, 0.5f}[c]);
        }
        picture_free(&p);
        tyn_scene_finish(&scene);
    }
}

// A textured floor under a constant sky, the same sky as a map, a sun, a spot light: albedo x E / pi; and the same
// beside a wall.
static void lit_floors(void **state)
{
    path_run *runs = *state;
    for (int i = 0; i < 8; i++) {
        tyn_scene scene;
        tyn_scene_init(&scene);
        uint32_t floor = solids_material(&scene, (float[]){0.8f, 0.6f, 0.4f}, BLACK);
        tyn_surfaces *s = &scene.surfaces;
        s->textures = calloc(1, sizeof *s->textures);
        s->num_textures = 1;
        s->textures[0] = (tyn_texture){
            .size = {2, 1}, .texels = malloc(8), .wrap = {TYN_WRAP_MIRROR, TYN_WRAP_REPEAT}};
        memcpy(s->textures[0].texels, (uint8_t[]){255, 255, 255, 255, 188, 0, 64, 255}, 8);
        s->materials[floor].texture = 0;
        solids_quad(&scene, (float[]){-2, 0, 2}, (float[]){4, 0, 0}, (float[]){0, 0, -4}, floor);
        const bool wall = i >= 4;
        if (wall) { // black, in front of half of the sky
            uint32_t black = solids_material(&scene, BLACK, BLACK);
            solids_quad(&scene, (float[]){0, 0, -900}, (float[]){0, 0, 1800}, (float[]){0, 900, 0},
                        black);
        }
        double irradiance = wall ? M_PI / 2 : M_PI;
        if (i % 4 < 2) {
            scene_set_sky(&scene, 1);
        }
        if (i % 4 == 1) {
            tyn_environment *map = &scene.environment;
            map->size[0] = 16;
            map->size[1] = 8;
            map->data = malloc(16 * 8 * 3 * sizeof(float));
            for (int k = 0; k < 16 * 8 * 3; k++) {
                map->data[k] = 1;
            }
        } else if (i % 4 == 2) {
            scene_add_sun(&scene, -0.6f, -0.8f, 0, 3, 3, 3); // from behind the wall
            irradiance = wall ? 0 : 3 * 0.8;
        } else if (i % 4 == 3) {
            scene_add_lamp(&scene, (float[]){-0.01f, 2, 0}, 5);
            scene.lights[0].kind = TYN_LIGHT_SPOT;
            scene.lights[0].cos_inner = scene.lights[0].cos_outer = 0.9f;
            irradiance = 5.0 / 4;
        }
        solids_hierarchy(&scene, 1);
        tyn_view view = {0};
        // At x = -0.01: texture coordinate 0.4975 of two texels, between their middles.
        view_orthographic(&view, (float[]){-0.01f, 0, 0}, 0, -1, 0, (float[]){0, 0, -1}, 1e-4f, 1);
        view.camera.position[1] = 1;
        picture p = {0};
        path_run_picture(runs, &p, &scene, &view, path_effort(4096));
        for (int c = 0; c < 3; c++) {
            double srgb = (const double[]){188, 0, 64}[c] / 255;
            double texel = srgb <= 0.04045 ? srgb / 12.92 : pow((srgb + 0.055) / 1.055, 2.4);
            double part = 0.4975 * 2 - 0.5, albedo = (double)s->materials[0].albedo[c];
            albedo *= 1 - part + part * texel;
            char name[64];
            snprintf(name, sizeof name, "floor, light %d%s, %d", i % 4, wall ? ", wall" : "", c);
            double se = irradiance > 0 ? hypot(p.se[c], 1e-4 * albedo * irradiance) : 1e-9;
            check(name, p.rgb[c], se, albedo * irradiance / M_PI);
        }
        picture_free(&p);
        tyn_scene_finish(&scene);
    }
}

// Layers of a quad at a distance of 2 m in a medium: transmittance and depth end there, the alpha of the medium
// alone is what it hides, a background makes it opaque.
static void layers(void **state)
{
    path_run *runs = *state;
    tyn_scene scene;
    tyn_scene_init(&scene);
    uint32_t lamp = solids_material(&scene, BLACK, (float[]){4, 2, 1});
    solids_quad(&scene, (float[]){-1, -2, 0}, (float[]){1, 0, 0}, (float[]){0, 4, 0}, lamp);
    solids_hierarchy(&scene, 1);
    tyn_medium m = grey_medium(0, 0.5f, 0);
    scene_add_box(&scene, &m, (float[]){-3, -3, -1}, (float[]){3, 3, 2}, NULL, NULL);
    tyn_view view = {0};
    view_orthographic(&view, (float[]){0, 0, 2}, 0, 0, -1, (float[]){0, 1, 0}, 1, 8);
    for (int a = 0; a < 3; a++) {
        view.camera.position[a] = a == 2 ? 2 : 0; // at the medium's face
    }
    for (int i = 0; i < 2; i++) {
        view.no_background = i;
        const uint32_t samples = 4096;
        const float *depth = path_run_layer(runs, &scene, &view, TYN_OUTPUT_DEPTH, 1);
        assert_true(fabsf(depth[0] - 2) < 1e-5f); // left: the quad
        assert_true(fabsf(depth[1] - logf(2) / 0.5f) < 1e-5f);
        assert_true(isinf(depth[4 * 7]));
        const float *t = path_run_layer(runs, &scene, &view, TYN_OUTPUT_TRANSMITTANCE, samples);
        double left = exp(-0.5 * 2), right = exp(-0.5 * 3);
        check("transmittance to the quad", t[0], sqrt(left * (1 - left) / samples), left);
        check("transmittance beside it", t[4 * 7], sqrt(right * (1 - right) / samples), right);
        const float *p = path_run_layer(runs, &scene, &view, TYN_OUTPUT_RADIANCE, samples);
        check("alpha of the quad", p[3], sqrt(left * (1 - left) / samples), i ? 1 - left : 1);
        check("alpha beside it", p[4 * 7 + 3], sqrt(right * (1 - right) / samples), 1 - right);
        check("radiance of the quad", p[0], 4 * sqrt(left * (1 - left) / samples),
              i ? 0 : 4 * left);
    }
    tyn_scene_finish(&scene);
}

// What is emitted is absorbed or escapes, within 3 standard errors and 4 %.
static void balances(void **state)
{
    path_run *runs = *state;
    for (int i = getenv("TYN_LONG") ? 0 : 1; i < 4; i += getenv("TYN_LONG") ? 1 : 2) {
        tyn_scene scene;
        tyn_scene_init(&scene);
        const bool closed = i < 2;
        uint32_t wall = solids_material(&scene, (float[]){0.5f, 0.3f, 0.1f}, BLACK);
        uint32_t lamp = solids_material(&scene, (float[]){0.1f, 0.1f, 0.1f}, (float[]){3, 2, 1});
        solids_box(&scene, (float[]){0, 0, 0}, (float[]){3, 2, 4}, 0.2f, closed, wall);
        if (!closed) { // without a front: open
            scene.surfaces.num_triangles -= 2;
        }
        if (i != 1) {
            solids_sphere(&scene, (float[]){1.5f, 1, 2}, 0.3f, 6, false, lamp);
        } else {
            scene_add_lamp(&scene, (float[]){1.4f, 1.2f, 2.2f}, 5);
        }
        solids_hierarchy(&scene, 2);
        if (i != 2) {
            tyn_medium m = grey_medium(0.4f, 0.1f, 0.3f);
            scene_add_box(&scene, &m, (float[]){0.7f, 0.2f, 0.7f}, (float[]){2, 1.8f, 3}, NULL,
                          NULL);
        }
        if (i == 3) {
            scene_add_sun(&scene, 0.2f, -1, -0.7f, 2, 2, 2);
            scene_set_sky(&scene, 0.3f);
        }
        const tyn_balance *b = path_run_balance(runs, &scene, path_effort(12));
        for (int c = 0; c < 3; c++) {
            printf("balance %d, %d: entering %.4f emitted %.4f, media %.4f surfaces %.4f escaped "
                   "%.4f: "
                   "%+.4f +- %.4f\n",
                   i, c, b->entering[c], b->emitted[c], b->absorbed_media[c],
                   b->absorbed_surfaces[c], b->escaped[c], b->imbalance[c], b->imbalance_se[c]);
            assert_true(fabs(b->imbalance[c]) < (getenv("TYN_LONG") ? 0.02 : 0.04));
            assert_true(fabs(b->imbalance[c]) <= 3 * b->imbalance_se[c]);
            assert_true((b->absorbed_media[c] > 0) == (i != 2));
            assert_true(b->absorbed_surfaces[c] > 0);
            assert_true((b->escaped[c] > 0) == !closed);
            assert_true((b->entering[c] > 0) == (i == 3));
        }
        tyn_scene_finish(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(furnaces),   cmocka_unit_test(closed_box), cmocka_unit_test(form_factors),
        cmocka_unit_test(lit_floors), cmocka_unit_test(layers),     cmocka_unit_test(balances),
    };
    setvbuf(stdout, NULL, _IOLBF, 0);
    cmocka_set_test_filter(getenv("TYN_TEST_FILTER"));
    return cmocka_run_group_tests(tests, path_run_setup, path_run_teardown);
}
