// pop_skies.c -- an environment map among surfaces, in `pop` and `path`: what stands in the way stops its light, what does not
// changes nothing.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "path_run.h"
#include "picture.h"
#include "sky.h"
#include "solids.h"
#include "todo.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIZE = 48, WIDE = 128, HIGH = 64 };

// ---- skies --------------------------------------------------------------------------------------

typedef enum sky_kind { BLUE, WINDOW, EVEN } sky_kind;

// BLUE: bright along the horizon, dark below it. WINDOW: a rectangle of light up in front, all else black. EVEN: 1, without a map.
static void add_sky(tyn_scene *scene, sky_kind kind)
{
    tyn_environment *map = &scene->environment;
    if (kind == EVEN) {
        scene_set_sky(scene, 1);
        return;
    }
    sky_constant_map(map, WIDE, HIGH, 0);
    for (int i = 0; i < WIDE * HIGH; i++) {
        const double up = cos(M_PI * (i / WIDE + 0.5) / HIGH), u = (i % WIDE + 0.5) / WIDE;
        float *rgb = &map->data[3 * i];
        if (kind == WINDOW) {
            const bool lit = fabs(u - 0.65) < 0.06 && fabs(up - 0.5) < 0.2;
            rgb[0] = lit ? 20 : 0, rgb[1] = lit ? 18 : 0, rgb[2] = lit ? 15 : 0;
        } else {
            const double haze = up > 0 ? pow(1 - up, 3) : 0;
            const double above[3] = {0.25 + 1.6 * haze, 0.45 + 1.7 * haze, 0.9 + 1.8 * haze};
            for (int c = 0; c < 3; c++) {
                rgb[c] = up > 0 ? (float)above[c] : 0.1f;
            }
        }
    }
    map->hash += (uint64_t)kind + 100;
}

static bool compare(const picture *p, const picture *reference, double error, double bias,
                    const char *name)
{
    const picture_error e = picture_compare(p, reference, 8);
    printf("%s: rel_l1 %.1f %% (noise %.1f), bias %+.1f %%\n", name, 100 * e.rel_l1, 100 * e.noise,
           100 * e.bias);
    const bool near = within(e.reported, error, NULL, "%s, error", name);
    return within(fabs(e.bias), bias, picture_bias_why(&e), "%s, bias", name) && near;
}

// ---- what changes nothing -------------------------------------------------------------------------

static void make_cloud(tyn_scene *scene, bool triangle)
{
    enum { N = 16 };
    static float grid[N * N * N];
    for (int i = 0; i < N * N * N; i++) {
        const double x = i % N / 7.5 - 1, y = i / N % N / 7.5 - 1, z = i / N / N / 7.5 - 1;
        const double lump = 1 - x * x - y * y - z * z + 0.3 * sin(9 * x) * sin(7 * y + 2 * z);
        grid[i] = (float)maximum(lump, 0);
    }
    tyn_scene_init(scene);
    const tyn_medium medium = grey_medium(8, 0.1f, 0.75f);
    scene_add_box(scene, &medium, (float[]){-1, -1, -1}, (float[]){1, 1, 1}, (uint32_t[]){N, N, N},
                  grid);
    add_sky(scene, BLUE);
    if (triangle) {
        const uint32_t m = solids_material(scene, (float[]){0.5f, 0.5f, 0.5f}, (float[]){0, 0, 0});
        solids_quad(scene, (float[]){1.1f, -0.9f, 0}, (float[]){0.01f, 0, 0},
                    (float[]){0, 0.01f, 0}, m);
        solids_hierarchy(scene, 4);
    }
}

// A leaf of a centimetre beside a cloud: what changes is rounding of the march among surfaces.
static void leaf_beside_a_cloud(void **state)
{
    gpu_test *t = *state;
    picture pictures[2];
    for (int k = 0; k < 2; k++) {
        tyn_scene scene;
        make_cloud(&scene, k == 1);
        tyn_view view = {0};
        view_perspective(&view, (float[]){1.5f, 1, 3.5f}, (float[]){0, 0, 0}, 0.7f, SIZE);
        picture_render(&pictures[k], t->dev, "pop", &scene, &view, NULL, 0);
        tyn_scene_finish(&scene);
    }
    assert_true(compare(&pictures[1], &pictures[0], 2e-5, 5e-6, "leaf beside a cloud"));
    picture_free(&pictures[0]);
    picture_free(&pictures[1]);
}

// ---- what is closed -------------------------------------------------------------------------------

// A room beside the medium's box, or in it, is dark, under a sky of about 1. It should be exactly so.
static void closed_rooms(void **state)
{
    gpu_test *t = *state;
    static const double bounds[4] = {1e-6, 1e-6, 5e-3, 7e-3};
    bool good = true;
    for (int k = 0; k < 4; k++) {
        const float x = k < 2 ? 0 : 3;
        tyn_scene scene;
        tyn_scene_init(&scene);
        const uint32_t m = solids_material(&scene, (float[]){0.7f, 0.7f, 0.7f}, (float[]){0, 0, 0});
        solids_box(&scene, (float[]){x - 0.75f, -0.75f, -0.75f}, (float[]){x + 0.75f, 0.75f, 0.75f},
                   k % 2 ? 0.5f : 0, true, m);
        solids_quad(&scene, (float[]){-2, -1, -3}, (float[]){0, 0, 6}, (float[]){8, 0, 0}, m);
        solids_hierarchy(&scene, 4);
        const tyn_medium medium = grey_medium(0.3f, 0.01f, 0.3f);
        scene_add_box(&scene, &medium, (float[]){-1, -1, -1}, (float[]){1, 1, 1}, NULL, NULL);
        add_sky(&scene, BLUE);
        tyn_view view = {0};
        view_perspective(&view, (float[]){x, 0.2f, 0.4f}, (float[]){x + 0.2f, -0.1f, -0.4f}, 1.3f,
                         SIZE);
        picture p;
        picture_render(&p, t->dev, "pop", &scene, &view, NULL, 0);
        double sum = 0;
        int lit = 0;
        for (int i = 0; i < 3 * SIZE * SIZE; i++) {
            sum += (double)p.rgb[i];
            lit += p.rgb[i] > 0;
        }
        const double mean = sum / (3 * SIZE * SIZE);
        printf("closed room at x = %g, turned by %g: mean %g, %d numbers are not 0\n", (double)x,
               k % 2 ? 0.5 : 0, mean, lit);
        const bool dim = within(mean, bounds[k], k > 1 ? NULL : "a few pixels, by rounding",
                                "closed room %d, mean", k);
        good = todo_if(k == 2, dim,
                       "what the ground outside reflects of the sky gets in past the maps of 16 "
                       "texels of what virtual lights see",
                       "closed room %d, mean", k) &&
               good;
        good = todo_if(k != 1, lit == 0,
                       "maps of 256 texels let some of the light in beside the edges of walls",
                       "closed room %d", k) &&
               good;
        picture_free(&p);
        tyn_scene_finish(&scene);
    }
    assert_true(good);
}

// A room of 6 m around smoke of half a metre: its walls stand beyond what the first maps cover.
static void wide_rooms(void **state)
{
    gpu_test *t = *state;
    bool good = true;
    for (int k = 0; k < 2; k++) {
        tyn_scene scene;
        tyn_scene_init(&scene);
        const uint32_t m = solids_material(&scene, (float[]){0.7f, 0.7f, 0.7f}, (float[]){0, 0, 0});
        solids_box(&scene, (float[]){-3, -3, -3}, (float[]){3, 3, 3}, k ? 0.5f : 0, true, m);
        solids_hierarchy(&scene, 4);
        const tyn_medium medium = grey_medium(1, 0.01f, 0.3f);
        scene_add_box(&scene, &medium, (float[]){-0.25f, -0.25f, -0.25f},
                      (float[]){0.25f, 0.25f, 0.25f}, NULL, NULL);
        add_sky(&scene, BLUE);
        tyn_view view = {0};
        view_perspective(&view, (float[]){1.8f, 0.5f, 1.8f}, (float[]){-1, -1, -1}, 1.3f, SIZE);
        picture p;
        picture_render(&p, t->dev, "pop", &scene, &view, NULL, 0);
        double sum = 0;
        for (int i = 0; i < 3 * SIZE * SIZE; i++) {
            sum += (double)p.rgb[i];
        }
        const double mean = sum / (3 * SIZE * SIZE);
        printf("closed room of 12 boxes, turned by %g: mean %g\n", k ? 0.5 : 0, mean);
        good =
            within(mean, 1e-6, "a few pixels, by rounding", "wide closed room %d, mean", k) && good;
        picture_free(&p);
        tyn_scene_finish(&scene);
    }
    assert_true(good);
}

// A lamp of surfaces in the open, without places that reflect the sky: it is drawn by what the sky alone lights, and its own light.
static void lamp_without_places(void **state)
{
    gpu_test *t = *state;
    tyn_scene scene;
    tyn_scene_init(&scene);
    const uint32_t lamp = solids_material(&scene, (float[]){0, 0, 0}, (float[]){5, 5, 5});
    const uint32_t floor = solids_material(&scene, (float[]){0.5f, 0.5f, 0.5f}, (float[]){0, 0, 0});
    solids_quad(&scene, (float[]){-2, 0, 2}, (float[]){4, 0, 0}, (float[]){0, 0, -4}, floor);
    solids_quad(&scene, (float[]){-0.5f, 1, -0.5f}, (float[]){1, 0, 0}, (float[]){0, 0, 1}, lamp);
    solids_hierarchy(&scene, 4);
    add_sky(&scene, EVEN);
    tyn_view view = {0};
    view_perspective(&view, (float[]){0, 3, 3}, (float[]){0, 0, 0}, 1.0f, SIZE);
    picture p, q;
    picture_render(&p, t->dev, "pop", &scene, &view, NULL, 0);
    picture_render(&q, t->dev, "pop", &scene, &view, "rsm.sky_texels=0", 0);
    double most = 0, sum = 0;
    for (int i = 0; i < 3 * SIZE * SIZE; i++) {
        assert_true(isfinite(q.rgb[i]));
        most = q.rgb[i] > most ? (double)q.rgb[i] : most;
        sum += (double)q.rgb[i] - (double)p.rgb[i];
    }
    printf("brightest %g\n", most);
    assert_true(most > 0.5); // the lamp reflects nothing: places add no light here
    const double change = fabs(sum) / (3 * SIZE * SIZE);
    const bool good = within(change, 2e-4, NULL, "lamp without places, change");
    picture_free(&p);
    picture_free(&q);
    tyn_scene_finish(&scene);
    assert_true(good);
}

// ---- against path ---------------------------------------------------------------------------------

// A tray in fog, or around it: walls 0.8 m high around a floor of 2 m. `albedo` of all of it.
static void make_tray(tyn_scene *scene, sky_kind sky, float albedo, bool around)
{
    static const float boxes[5][6] = {{-1, -0.1f, -1, 1, 0, 1},
                                      {-1, 0, -1, -0.9f, 0.8f, 1},
                                      {0.9f, 0, -1, 1, 0.8f, 1},
                                      {-0.9f, 0, -1, 0.9f, 0.8f, -0.9f},
                                      {-0.9f, 0, 0.9f, 0.9f, 0.8f, 1}};
    tyn_scene_init(scene);
    const uint32_t m =
        solids_material(scene, (float[]){albedo, albedo, albedo}, (float[]){0, 0, 0});
    for (int i = 0; i < 5; i++) {
        solids_box(scene, boxes[i], boxes[i] + 3, 0, false, m);
    }
    solids_hierarchy(scene, 4);
    const tyn_medium medium = grey_medium(0.2f, 0.01f, 0.3f);
    const float lo[3] = {around ? -0.87f : -1.3f, around ? 0.02f : -0.3f, around ? -0.87f : -1.3f};
    const float hi[3] = {around ? 0.87f : 1.3f, around ? 0.7f : 1.3f, around ? 0.87f : 1.3f};
    scene_add_box(scene, &medium, lo, hi, NULL, NULL);
    add_sky(scene, sky);
}

// A room of 4 x 3 x 4 m with a window of 1.2 m, all of it in fog.
static void make_room(tyn_scene *scene, sky_kind sky)
{
    static const float boxes[9][6] = {{-2.2f, -0.2f, -2.2f, 2.2f, 0, 2.2f},
                                      {-2.2f, 3, -2.2f, 2.2f, 3.2f, 2.2f},
                                      {-2.2f, 0, -2.2f, -2, 3, 2.2f},
                                      {-2, 0, -2.2f, 2, 3, -2},
                                      {-2, 0, 2, 2, 3, 2.2f},
                                      {2, 0, -2.2f, 2.2f, 1, 2.2f},
                                      {2, 2.2f, -2.2f, 2.2f, 3, 2.2f},
                                      {2, 1, -2.2f, 2.2f, 2.2f, -0.6f},
                                      {2, 1, 0.6f, 2.2f, 2.2f, 2.2f}};
    tyn_scene_init(scene);
    const uint32_t m = solids_material(scene, (float[]){0.5f, 0.5f, 0.5f}, (float[]){0, 0, 0});
    for (int i = 0; i < 9; i++) {
        solids_box(scene, boxes[i], boxes[i] + 3, 0, false, m);
    }
    solids_hierarchy(scene, 4);
    const tyn_medium medium = grey_medium(0.15f, 0.01f, 0.6f);
    scene_add_box(scene, &medium, (float[]){-2, 0, -2}, (float[]){2, 3, 2}, NULL, NULL);
    add_sky(scene, sky);
}

// A block on a floor that reaches far beyond the fog around it.
static void make_yard(tyn_scene *scene, sky_kind sky, float albedo)
{
    tyn_scene_init(scene);
    const uint32_t m =
        solids_material(scene, (float[]){albedo, albedo, albedo}, (float[]){0, 0, 0});
    solids_quad(scene, (float[]){-4, 0, -4}, (float[]){0, 0, 8}, (float[]){8, 0, 0}, m);
    solids_box(scene, (float[]){-0.4f, 0, -0.4f}, (float[]){0.4f, 0.9f, 0.4f}, 0.4f, false, m);
    solids_box(scene, (float[]){1.6f, 0, -1.2f}, (float[]){2.2f, 1.6f, 1}, 0, false, m);
    solids_hierarchy(scene, 4);
    const tyn_medium medium = grey_medium(0.2f, 0.02f, 0.6f);
    scene_add_box(scene, &medium, (float[]){-1, 0, -1}, (float[]){1, 1.4f, 1}, NULL, NULL);
    add_sky(scene, sky);
}

// A cube of 1 m on a ground of `half` m to all sides, `fog`: in a box of it.
static void make_ground(tyn_scene *scene, sky_kind sky, float half, bool fog)
{
    tyn_scene_init(scene);
    const uint32_t m = solids_material(scene, (float[]){0.5f, 0.5f, 0.5f}, (float[]){0, 0, 0});
    solids_quad(scene, (float[]){-half, 0, -half}, (float[]){0, 0, 2 * half},
                (float[]){2 * half, 0, 0}, m);
    solids_box(scene, (float[]){-0.5f, 0.001f, -0.5f}, (float[]){0.5f, 1, 0.5f}, 0, false, m);
    solids_hierarchy(scene, 4);
    if (fog) {
        const tyn_medium medium = grey_medium(0.2f, 0.02f, 0.6f);
        scene_add_box(scene, &medium, (float[]){-1, 0, -1}, (float[]){1, 1.5f, 1}, NULL, NULL);
    }
    add_sky(scene, sky);
}

enum { TRAY, AROUND, ROOM, YARD, GROUND, GROUND_IN_FOG };

static const char around[] =
    "surfaces outside the medium's box reflect none of the light that it sends them";
static const char darker[] =
    "some .1 % darker since places weigh by area, too; the cause is not shown";

static void against_path(void **state)
{
    gpu_test *t = *state;
    static const struct {
        const char *name;
        int scene;
        sky_kind sky;
        float size; // albedo; of GROUND half of its side, m
        double error, bias;
        const char *reason; // of a known failure
    } cases[] = {
        {"tray, blue", TRAY, BLUE, 0.6f, 0.03, 0.015, NULL},
        {"tray, window", TRAY, WINDOW, 0.6f, 0.035, 0.01, NULL},
        {"tray, even", TRAY, EVEN, 0.6f, 0.007, 0.0035, NULL},
        {"tray around the fog, blue", AROUND, BLUE, 0.6f, 0.015, 0.004, around},
        {"tray around the fog, window", AROUND, WINDOW, 0.6f, 0.03, 0.007, around},
        {"tray around the fog, even", AROUND, EVEN, 0.6f, 0.004, 0.0015, around},
        {"room, blue", ROOM, BLUE, 0.5f, 0.12, 0.05, NULL},
        {"room, window", ROOM, WINDOW, 0.5f, 0.09, 0.006, NULL},
        {"room, even", ROOM, EVEN, 0.5f, 0.1, 0.03, NULL},
        {"dark yard, blue", YARD, BLUE, 0.1f, 0.004, 0.003, NULL},
        {"dark yard, window", YARD, WINDOW, 0.1f, 0.015, 0.003, NULL},
        {"yard, blue", YARD, BLUE, 0.6f, 0.0055, 0.003, darker},
        {"yard, even", YARD, EVEN, 0.6f, 0.0055, 0.0017, darker},
        {"ground of 40 m, even", GROUND, EVEN, 20, 0.016, 0.006, NULL},
        {"ground of 40 m, blue", GROUND, BLUE, 20, 0.014, 0.003, darker},
        {"ground of 200 m, even", GROUND, EVEN, 100, 0.045, 0.045, NULL},
        {"fog on 80 m, even", GROUND_IN_FOG, EVEN, 40, 0.028, 0.016, NULL},
    };
    path_run runs;
    path_run_open(&runs, t->dev);
    bool good = true;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        tyn_scene scene;
        tyn_view view = {0};
        if (cases[i].scene == TRAY || cases[i].scene == AROUND) {
            make_tray(&scene, cases[i].sky, cases[i].size, cases[i].scene == AROUND);
            view_perspective(&view, (float[]){1.2f, 2.4f, 2.2f}, (float[]){0, 0.2f, 0}, 0.6f, SIZE);
        } else if (cases[i].scene == ROOM) {
            make_room(&scene, cases[i].sky);
            view_perspective(&view, (float[]){1.6f, 1.7f, 1.7f}, (float[]){-0.8f, 0.9f, -0.6f},
                             1.1f, SIZE);
        } else if (cases[i].scene >= GROUND) {
            make_ground(&scene, cases[i].sky, cases[i].size, cases[i].scene == GROUND_IN_FOG);
            view_perspective(&view, (float[]){0, 1, 4}, (float[]){0, 0.4f, 0}, 0.384f, SIZE);
        } else {
            make_yard(&scene, cases[i].sky, cases[i].size);
            view_perspective(&view, (float[]){3.6f, 2.6f, 4.4f}, (float[]){0.4f, 0.4f, 0}, 0.7f,
                             SIZE);
        }
        picture p, reference = {0};
        picture_render(&p, t->dev, "pop", &scene, &view, NULL, 0);
        path_run_picture(&runs, &reference, &scene, &view, path_effort(256));
        const bool holds = compare(&p, &reference, cases[i].error, cases[i].bias, cases[i].name);
        good = todo_if(cases[i].reason, holds, cases[i].reason, "%s", cases[i].name) && good;
        picture_free(&p);
        picture_free(&reference);
        tyn_scene_finish(&scene);
    }
    path_run_close(&runs);
    assert_true(good);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(leaf_beside_a_cloud), cmocka_unit_test(closed_rooms),
        cmocka_unit_test(wide_rooms),          cmocka_unit_test(lamp_without_places),
        cmocka_unit_test(against_path),
    };
    setvbuf(stdout, NULL, _IOLBF, 0);
    cmocka_set_test_filter(getenv("TYN_TEST_FILTER"));
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
