// pop_surfaces.c -- surfaces without a medium in `pop`: closed forms under every kind of light, rooms against
// `path`, VPLs that move with the light.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "offline_frame.h"
#include "path_run.h"
#include "picture.h"
#include "solids.h"
#include "todo.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

enum { SIZE = 16 };

static const float BLACK[3] = {0, 0, 0};
static const float albedo[3] = {0.2f, 0.5f, 0.8f};

// A floor of 4 m x 4 m at y = 0, seen from above: columns along x, rows along z, 2 m wide.
static void make_floor(tyn_scene *scene, tyn_view *view)
{
    tyn_scene_init(scene);
    uint32_t material = solids_material(scene, albedo, BLACK);
    solids_quad(scene, (float[]){-2, 0, -2}, (float[]){0, 0, 4}, (float[]){4, 0, 0}, material);
    solids_hierarchy(scene, 4);
    *view = (tyn_view){0};
    view_orthographic(view, (float[]){0, 1, 0}, 0, -1, 0, (float[]){0, 0, -1}, 1, SIZE);
}

// Irradiance on the floor at (x, 0, z).
typedef double (*irradiance_fn)(double x, double z);

static double under_sun(double x, double z)
{
    (void)x;
    (void)z;
    return 3 * 0.8;
}

static double under_six_suns(double x, double z)
{
    (void)x;
    (void)z;
    return 1 + 3 + 6 + 1 + 5 + 4;
}

static double under_lamp(double x, double z)
{
    double rr = (x - 0.3) * (x - 0.3) + 1.5 * 1.5 + (z + 0.2) * (z + 0.2);
    return 5 * 1.5 / (rr * sqrt(rr));
}

static double under_spot(double x, double z)
{
    double rr = x * x + 4 + z * z, cosine = 2 / sqrt(rr);
    double t = fmin(fmax((cosine - cos(0.5)) / (cos(0.2) - cos(0.5)), 0), 1);
    return 7 * t * t * 2 / (rr * sqrt(rr));
}

static double under_sky(double x, double z)
{
    (void)x;
    (void)z;
    return PI * 0.7;
}

static void check(void **state, tyn_scene *scene, tyn_view *view, const char *name,
                  irradiance_fn irradiance)
{
    picture p;
    picture_render(&p, ((gpu_test *)*state)->dev, "pop", scene, view, NULL, 1);
    double worst = 0;
    for (uint32_t i = 0; i < SIZE * SIZE; i++) {
        double x = 2 * (i % SIZE + 0.5) / SIZE - 1, z = 2 * (i / SIZE + 0.5) / SIZE - 1;
        for (uint32_t c = 0; c < 3; c++) {
            double expected = albedo[c] / PI * irradiance(x, z);
            worst = maximum(worst, fabs(p.rgb[3 * i + c] - expected) / (expected + 1e-3));
        }
    }
    print_message("%s: %.1e off at most\n", name, worst);
    const bool sky = irradiance == under_sky;
    assert_true(within(worst, sky ? 2e-3 : 1e-4, sky ? NULL : BOUND_ROUNDING, "%s", name));
    assert_true(
        todo_if(sky, worst < 1e-4,
                "of directions along the floor, which stand for light from either side of it, "
                "all or nothing counts",
                "%s within 1e-4", name));
    picture_free(&p);
    tyn_scene_finish(scene);
}

static void floors(void **state)
{
    tyn_scene scene;
    tyn_view view = {0};
    make_floor(&scene, &view);
    scene_add_sun(&scene, 0.6f, -0.8f, 0, 3, 3, 3);
    check(state, &scene, &view, "sun", under_sun);

    make_floor(&scene, &view);
    scene.lights[scene.num_lights++] =
        (tyn_light){.kind = TYN_LIGHT_POINT, .color = {5, 5, 5}, .position = {0.3f, 1.5f, -0.2f}};
    check(state, &scene, &view, "point", under_lamp);

    make_floor(&scene, &view);
    scene.lights[scene.num_lights++] = (tyn_light){.kind = TYN_LIGHT_SPOT,
                                                   .color = {7, 7, 7},
                                                   .position = {0, 2, 0},
                                                   .direction = {0, -1, 0},
                                                   .cos_inner = cosf(0.2f),
                                                   .cos_outer = cosf(0.5f)};
    check(state, &scene, &view, "spot", under_spot);

    make_floor(&scene, &view);
    scene_set_sky(&scene, 0.7f);
    check(state, &scene, &view, "sky", under_sky);
}

// A floor under a parallel emitter: the irradiance of a square, by its form factor at the middle.
static void under_emitter(void **state)
{
    const double h = 0.5, a = 0.5; // height and half side, m
    double s = sqrt(a * a + h * h), form = 4 / PI * (a / s) * atan(a / s); // twice two corners
    tyn_scene scene;
    tyn_view view = {0};
    make_floor(&scene, &view);
    uint32_t lamp = solids_material(&scene, BLACK, (float[]){2, 2, 2});
    solids_quad(&scene, (float[]){-0.5f, 0.5f, -0.5f}, (float[]){1, 0, 0}, (float[]){0, 0, 1},
                lamp);
    solids_hierarchy(&scene, 4);
    view_orthographic(&view, (float[]){0, 0.25f, 0}, 0, -1, 0, (float[]){0, 0, -1}, 0.02f, SIZE);
    picture p;
    picture_render(&p, ((gpu_test *)*state)->dev, "pop", &scene, &view, NULL, 1);
    double mean = 0;
    for (uint32_t i = 0; i < SIZE * SIZE; i++) {
        mean += p.rgb[3 * i + 1] / (SIZE * SIZE);
    }
    double expected = albedo[1] * 2 * form;
    print_message("square emitter: %.4f, expected %.4f\n", mean, expected);
    assert_within(fabs(mean / expected - 1), 0.0015, NULL);
    picture_free(&p);
    tyn_scene_finish(&scene);
}

// Irradiance at p on the side n of a rectangle of radiance 1 that is all before it, whose front sees p: Lambert's integral
// around it.
static double of_rectangle(const double p[3], const double n[3], const float corner[3],
                           const float u[3], const float v[3])
{
    double at[4][3], sum = 0;
    for (int k = 0; k < 4; k++) {
        double length = 0;
        for (int c = 0; c < 3; c++) {
            const double a = k == 1 || k == 2, b = k >= 2;
            at[k][c] = (double)corner[c] + a * (double)u[c] + b * (double)v[c] - p[c];
            length += at[k][c] * at[k][c];
        }
        for (int c = 0; c < 3; c++) {
            at[k][c] /= sqrt(length);
        }
    }
    for (int k = 0; k < 4; k++) {
        const double *a = at[k], *b = at[(k + 1) % 4];
        const double across[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                                  a[0] * b[1] - a[1] * b[0]};
        const double size =
            sqrt(across[0] * across[0] + across[1] * across[1] + across[2] * across[2]);
        const double angle = atan2(size, a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
        sum += angle * (across[0] * n[0] + across[1] * n[1] + across[2] * n[2]) / size;
    }
    return fabs(sum) / 2;
}

// An emitter in a closed room whose walls reflect nearly nothing: floor and wall are lit into the corners, where maps of
// what virtual lights see have rays that end on the other wall.
static void corners(void **state)
{
    enum { WIDE = 32 };
    const float dark = 1e-3f, corner[3] = {-0.25f, 1.95f, -0.25f}, u[3] = {0.5f, 0, 0},
                v[3] = {0, 0, 0.5f};
    for (int wall = 0; wall < 2; wall++) {
        tyn_scene scene;
        tyn_scene_init(&scene);
        const uint32_t black = solids_material(&scene, (float[]){dark, dark, dark}, BLACK);
        const uint32_t bright = solids_material(&scene, BLACK, (float[]){1, 1, 1});
        solids_box(&scene, (float[]){-1, 0, -1}, (float[]){1, 2, 1}, 0, true, black);
        solids_quad(&scene, corner, u, v, bright);
        solids_hierarchy(&scene, 4);
        // From the room's middle a wall of it fills the picture.
        tyn_view view = {.width = WIDE, .height = WIDE};
        view.camera = (tyn_camera){.projection = TYN_PERSPECTIVE,
                                   .position = {0, 1, 0},
                                   .right = {1, 0, 0},
                                   .up = {0, (float)wall, (float)wall - 1},
                                   .back = {0, 1 - (float)wall, (float)wall},
                                   .yfov = (float)(PI / 2)};
        picture p;
        picture_render(&p, ((gpu_test *)*state)->dev, "pop", &scene, &view, "shade.pattern=1", 1);
        double worst = 0, sum = 0, all = 0;
        for (int i = 0; i < WIDE * WIDE; i++) {
            const double x = 2 * (i % WIDE + 0.5) / WIDE - 1, y = 1 - 2 * (i / WIDE + 0.5) / WIDE;
            const double at[3] = {x, wall ? 1 + y : 0, wall ? -1 : -y};
            const double n[3] = {0, wall ? 0 : 1, wall ? 1 : 0};
            // Higher up the wall than this the emitter is near enough for its virtual lights to be told apart.
            if (at[1] > 1.5) {
                continue;
            }
            const double expected = (double)dark / PI * of_rectangle(at, n, corner, u, v);
            worst = maximum(worst, fabs((double)p.rgb[3 * i] / expected - 1));
            sum += (double)p.rgb[3 * i];
            all += expected;
        }
        print_message("%s of a room under an emitter: %.2f %% off at most, mean %+.2f %%\n",
                      wall ? "wall" : "floor", 100 * worst, 100 * (sum / all - 1));
        assert_within(worst, 0.005, NULL);
        assert_within(fabs(sum / all - 1), 0.0025, NULL);
        picture_free(&p);
        tyn_scene_finish(&scene);
    }
}

// An emitter in the corner of two walls that stand on a floor: behind them the floor is dark, although it is before the
// plane of the one or the other, on which rays end.
static void behind_a_corner(void **state)
{
    enum { WIDE = 32 };
    tyn_scene scene;
    tyn_scene_init(&scene);
    const uint32_t grey = solids_material(&scene, (float[]){1e-3f, 1e-3f, 1e-3f}, BLACK);
    const uint32_t bright = solids_material(&scene, BLACK, (float[]){1, 1, 1});
    solids_quad(&scene, (float[]){-2, 0, -2}, (float[]){0, 0, 4}, (float[]){4, 0, 0}, grey);
    solids_quad(&scene, (float[]){-1.5f, 0, 0}, (float[]){1.5f, 0, 0}, (float[]){0, 2, 0}, grey);
    solids_quad(&scene, (float[]){0, 0, 0}, (float[]){0, 0, 1.5f}, (float[]){0, 2, 0}, grey);
    solids_quad(&scene, (float[]){-0.2f, 1, 0.5f}, (float[]){0.1f, 0, 0}, (float[]){0, 0, 0.1f},
                bright);
    solids_hierarchy(&scene, 4);
    tyn_view view = {0};
    view_orthographic(&view, (float[]){0, 1, 0}, 0, -1, 0, (float[]){0, 0, -1}, 1, WIDE);
    picture p;
    picture_render(&p, ((gpu_test *)*state)->dev, "pop", &scene, &view, "shade.pattern=1", 1);
    double lit = 0, most = 0;
    for (int i = 0; i < WIDE * WIDE; i++) {
        const double x = 2 * (i % WIDE + 0.5) / WIDE - 1, z = 2 * (i / WIDE + 0.5) / WIDE - 1;
        const double v = (double)p.rgb[3 * i];
        if (x < 0 && z > 0) {
            lit = fmax(lit, v < 0.5 ? v : 0);
        } else if (z < -0.7 && x > -0.6) {
            most = maximum(most, v);
        }
    }
    print_message("behind a corner: at most %.1e of what is before it\n", most / lit);
    assert_true(lit > 0 && most == 0);
    picture_free(&p);
    tyn_scene_finish(&scene);
}

// A closed room with a block and a lamp, and one with an emitter: all reflections, against `path`.
static void rooms(void **state)
{
    for (int emitter = 0; emitter < 2; emitter++) {
        tyn_scene scene;
        tyn_scene_init(&scene);
        uint32_t wall = solids_material(&scene, (float[]){0.6f, 0.5f, 0.4f}, BLACK);
        uint32_t red = solids_material(&scene, (float[]){0.7f, 0.1f, 0.1f}, BLACK);
        uint32_t bright = solids_material(&scene, BLACK, (float[]){8, 8, 8});
        solids_box(&scene, (float[]){-1, 0, -1}, (float[]){1, 2, 1}, 0, true, wall);
        solids_box(&scene, (float[]){-0.7f, 0, -0.7f}, (float[]){-0.1f, 0.8f, -0.1f}, 0.4f, false,
                   red);
        if (emitter) {
            solids_quad(&scene, (float[]){-0.25f, 1.95f, -0.25f}, (float[]){0.5f, 0, 0},
                        (float[]){0, 0, 0.5f}, bright);
        } else {
            scene.lights[scene.num_lights++] = (tyn_light){
                .kind = TYN_LIGHT_POINT, .color = {2, 2, 2}, .position = {0.3f, 1.5f, 0.2f}};
        }
        solids_hierarchy(&scene, 4);
        tyn_view view = {.width = 32, .height = 32};
        view.camera = (tyn_camera){.projection = TYN_PERSPECTIVE,
                                   .position = {0, 1, 0.95f},
                                   .right = {1, 0, 0},
                                   .up = {0, 1, 0},
                                   .back = {0, 0, 1},
                                   .yfov = 1.3f};
        picture pop, path;
        tyn_device *dev = ((gpu_test *)*state)->dev;
        picture_render(&pop, dev, "pop", &scene, &view, NULL, 1);
        path_reference(&path, dev, &scene, &view, 64);
        picture_error e = picture_compare(&pop, &path, 8);
        print_message("room with %s: rel_l1 %.1f %% (noise %.1f), bias %+.1f %%\n",
                      emitter ? "an emitter" : "a lamp", 100 * e.rel_l1, 100 * e.noise,
                      100 * e.bias);
        assert_true(within(e.rel_l1, emitter ? 0.09 : 0.05, NULL, "room %d, error", emitter));
        assert_true(within(fabs(e.bias), emitter ? 0.03 : 0.015, NULL, "room %d, bias", emitter));
        picture_free(&pop);
        picture_free(&path);
        tyn_scene_finish(&scene);
    }
}

// Lamps of intensity 0 are no lamps: the same picture, bit for bit.
static void dark_lamps(void **state)
{
    picture p[2];
    for (uint32_t dark = 0; dark < 2; dark++) {
        tyn_scene scene;
        tyn_view view = {0};
        make_floor(&scene, &view);
        const uint32_t wall = solids_material(&scene, (float[]){0.7f, 0.2f, 0.1f}, BLACK);
        solids_quad(&scene, (float[]){-1.2f, 0, -1}, (float[]){0, 1, 0}, (float[]){0, 0, 2}, wall);
        solids_hierarchy(&scene, 4);
        const tyn_medium fog = grey_medium(0.3f, 0.1f, 0.5f);
        scene_add_box(&scene, &fog, (float[]){-1.5f, -0.1f, -1.5f}, (float[]){1.5f, 2, 1.5f}, NULL,
                      NULL);
        for (uint32_t i = 0; i < 8 * dark; i++) {
            scene.lights[scene.num_lights++] =
                (tyn_light){.kind = i % 2 ? TYN_LIGHT_SPOT : TYN_LIGHT_POINT,
                            .position = {-1 + 0.2f * (float)i, 1.2f, 0},
                            .direction = {0, -1, 0},
                            .cos_inner = 0.9f,
                            .cos_outer = 0.8f};
        }
        for (int i = 0; i < 2; i++) {
            scene.lights[scene.num_lights++] = (tyn_light){.kind = TYN_LIGHT_POINT,
                                                           .color = {2, 2, 1 + (float)i},
                                                           .position = {-0.6f, 0.8f, (float)i}};
        }
        picture_render(&p[dark], ((gpu_test *)*state)->dev, "pop", &scene, &view,
                       "lattice.cells=8 vpl.count=16", 1);
        tyn_scene_finish(&scene);
    }
    assert_true(p[0].rgb[0] > 0);
    assert_memory_equal(p[0].rgb, p[1].rgb, 3 * SIZE * SIZE * sizeof(float));
    picture_free(&p[0]);
    picture_free(&p[1]);
}

// Six suns: four with beams, two along ordinates of their own, which light the floor as well.
static void many_suns(void **state)
{
    static const float irradiance[6] = {1, 3, 6, 1, 5, 4};
    tyn_device *dev = ((gpu_test *)*state)->dev;
    const tyn_medium fog = grey_medium(0.3f, 0.1f, 0.5f);
    for (int medium = 0; medium < 2; medium++) {
        tyn_scene scene;
        tyn_view view = {0};
        make_floor(&scene, &view);
        for (int i = 0; i < 6; i++) {
            scene_add_sun(&scene, 0, -1, 0, irradiance[i], irradiance[i], irradiance[i]);
        }
        if (medium) {
            scene_add_box(&scene, &fog, (float[]){-1, -0.1f, -1}, (float[]){1, 1, 1}, NULL, NULL);
        }
        tyn_offline *off;
        assert_int_equal(tyn_offline_create(dev, tyn_offline_params(.method = "pop"), &off),
                         TYN_OK);
        offline_frame(off, &scene, &view);
        tyn_report report;
        tyn_offline_report(off, &report);
        for (uint32_t i = 0; i < report.num_warnings; i++) {
            assert_null(strstr(report.warnings[i], "left out"));
        }
        tyn_offline_destroy(&off);
        if (medium) {
            tyn_scene_finish(&scene);
        } else {
            check(state, &scene, &view, "six suns", under_six_suns);
        }
    }
}

// A panel of 3 m, 2 m above a floor of 20 m and of 1 km that a spot under it shines on: what the floor sends
// up, seen from below.
static void reflections_of_large_floors(void **state)
{
    for (int large = 0; large < 2; large++) {
        const float half = large ? 500 : 10;
        tyn_scene scene;
        tyn_scene_init(&scene);
        uint32_t m = solids_material(&scene, (float[]){0.8f, 0.8f, 0.8f}, BLACK);
        solids_quad(&scene, (float[]){-half, 0, -half}, (float[]){0, 0, 2 * half},
                    (float[]){2 * half, 0, 0}, m);
        solids_box(&scene, (float[]){-1.5f, 2, -1.5f}, (float[]){1.5f, 2.1f, 1.5f}, 0, false, m);
        scene.lights[scene.num_lights++] = (tyn_light){.kind = TYN_LIGHT_SPOT,
                                                       .color = {20, 20, 20},
                                                       .position = {0, 1.9f, 0},
                                                       .direction = {0, -1, 0},
                                                       .cos_inner = cosf(0.5f),
                                                       .cos_outer = cosf(0.9f)};
        solids_hierarchy(&scene, 4);
        tyn_view view = {.width = SIZE, .height = SIZE};
        view.camera = (tyn_camera){.projection = TYN_PERSPECTIVE,
                                   .position = {0, 0.4f, 0},
                                   .right = {1, 0, 0},
                                   .up = {0, 0, 1},
                                   .back = {0, -1, 0},
                                   .yfov = 1};
        picture pop, path;
        tyn_device *dev = ((gpu_test *)*state)->dev;
        picture_render(&pop, dev, "pop", &scene, &view, NULL, 1);
        path_reference(&path, dev, &scene, &view, 256);
        picture_error e = picture_compare(&pop, &path, 8);
        print_message("panel over a floor of %g m: rel_l1 %.1f %% (noise %.1f), bias %+.1f %%\n",
                      2 * (double)half, 100 * e.rel_l1, 100 * e.noise, 100 * e.bias);
        assert_within(e.rel_l1, 0.04, NULL);
        assert_within(fabs(e.bias), 0.04, NULL);
        picture_free(&pop);
        picture_free(&path);
        tyn_scene_finish(&scene);
    }
}

// Floor and wall under few and under many lamps: what each sends to the other, against `path`. The more lamps share
// the VPLs the more each of these stands for, of which much lies where floor and wall meet.
static void lamps_in_a_corner(void **state)
{
    tyn_device *dev = ((gpu_test *)*state)->dev;
    bool good = true;
    for (uint32_t count = 1; count <= 32; count *= 32) {
        tyn_scene scene;
        tyn_scene_init(&scene);
        uint32_t m = solids_material(&scene, (float[]){0.7f, 0.7f, 0.7f}, BLACK);
        solids_quad(&scene, (float[]){-2, -1, -2}, (float[]){0, 0, 4}, (float[]){4, 0, 0}, m);
        solids_quad(&scene, (float[]){-2, -1, -2}, (float[]){4, 0, 0}, (float[]){0, 3, 0}, m);
        solids_hierarchy(&scene, 4);
        uint32_t random = 1;
        for (uint32_t i = 0; i < count; i++) {
            tyn_light lamp = {.kind = TYN_LIGHT_POINT, .color = {0.3f, 0.3f, 0.3f}};
            for (int axis = 0; axis < 3; axis++) {
                random = 1664525 * random + 1013904223;
                lamp.position[axis] = 1.8f * ((float)(random >> 8) / 16777216.0f - 0.5f);
            }
            scene.lights[scene.num_lights++] = lamp;
        }
        tyn_view view = {.width = 64, .height = 64};
        view.camera = (tyn_camera){.projection = TYN_PERSPECTIVE,
                                   .position = {0, 0, 3},
                                   .right = {1, 0, 0},
                                   .up = {0, 1, 0},
                                   .back = {0, 0, 1},
                                   .yfov = 0.9f};
        picture pop, direct, path;
        picture_render(&pop, dev, "pop", &scene, &view, NULL, 1);
        picture_render(&direct, dev, "pop", &scene, &view, "vpl.count=0", 1);
        path_reference(&path, dev, &scene, &view, 64);
        for (uint32_t i = 0; i < 3 * 64 * 64; i++) {
            pop.rgb[i] -= direct.rgb[i];
            path.rgb[i] -= direct.rgb[i];
        }
        picture_error e = picture_compare(&pop, &path, 8);
        print_message("floor and wall, %u lamps, indirect light: rel_l1 %.1f %% (noise %.1f), "
                      "bias %+.1f %%\n",
                      count, 100 * e.rel_l1, 100 * e.noise, 100 * e.bias);
        good = within(e.reported, 0.12, NULL, "%u lamps, error", count) && good;
        const bool many = count > 1;
        good =
            todo_if(many, within(fabs(e.bias), many ? 0.06 : 0.005, NULL, "%u lamps, bias", count),
                    "a few virtual lights for each of many lamps lie where floor and wall meet",
                    "%u lamps, bias", count) &&
            good;
        picture_free(&pop);
        picture_free(&direct);
        picture_free(&path);
        tyn_scene_finish(&scene);
    }
    assert_true(good);
}

// A dome of triangles with normals of a sphere, seen and lit from below: none of it shades itself, though beside each of
// its edges the next triangle stands before the plane of this one, and a pixel shows several of them.
static void curved_surfaces(void **state)
{
    gpu_test *t = *state;
    enum { SIDE = 96 };
    static const char *const lights[] = {"sun", "lamp"};
    bool good = true;
    for (int lamp = 0; lamp < 2; lamp++) {
        tyn_scene scene;
        tyn_view view = {0};
        tyn_scene_init(&scene);
        const uint32_t material = solids_material(&scene, albedo, BLACK);
        solids_sphere(&scene, (float[]){0, 0, 0}, 1, 16, true, material);
        scene.surfaces.num_triangles /= 2; // those of the northern rings
        solids_hierarchy(&scene, 4);
        if (lamp) {
            scene_add_lamp(&scene, (float[]){0.05f, 0.1f, 0}, 1);
        } else {
            scene_add_sun(&scene, 0.05f, 1, 0.1f, 1, 1, 1);
        }
        view_orthographic(&view, (float[]){0, -2, 0}, 0, 1, 0, (float[]){0, 0, -1}, 0.4f, SIDE);
        picture p;
        picture_render(&p, t->dev, "pop", &scene, &view, "vpl.count=0", 1);
        double least = INFINITY, mean = 0;
        for (int i = 0; i < SIDE * SIDE; i++) {
            least = minimum(least, p.rgb[3 * i + 1]);
            mean += p.rgb[3 * i + 1] / (SIDE * SIDE);
        }
        print_message("dome under a %s: darkest pixel %.2f of the mean\n", lights[lamp],
                      least / mean);
        good = within(1 - least / mean, 0.2, NULL, "dome, darkest") && good;
        picture_free(&p);
        tyn_scene_finish(&scene);
    }
    assert_true(good);
}

// A floor with nothing on it, and a lamp a little above: light that grazes a surface is not taken for its shadow.
static void low_lamp(void **state)
{
    gpu_test *t = *state;
    enum { SIDE = 64 };
    static const float heights[3] = {0.05f, 0.07f, 0.3f};
    for (int k = 0; k < 3; k++) {
        const double h = (double)heights[k];
        tyn_scene scene;
        tyn_scene_init(&scene);
        uint32_t grey = solids_material(&scene, (float[]){0.5f, 0.5f, 0.5f}, (float[]){0, 0, 0});
        solids_quad(&scene, (float[]){-5, 0, -5}, (float[]){0, 0, 10}, (float[]){10, 0, 0}, grey);
        solids_hierarchy(&scene, 4);
        scene_add_lamp(&scene, (float[]){0, heights[k], 0}, 1);
        tyn_view view = {0};
        view_orthographic(&view, (float[]){0, 1, 0}, 0, -1, 0, (float[]){0, 0, -1}, 5, SIDE);
        picture p;
        picture_render(&p, t->dev, "pop", &scene, &view, "vpl.count=0", 0);
        double most = 0;
        for (int i = 0; i < SIDE * SIDE; i++) {
            const double x = 10 * (i % SIDE + 0.5) / SIDE - 5, z = 10 * (i / SIDE + 0.5) / SIDE - 5;
            const double r2 = x * x + z * z, due = 0.5 / 3.14159265 * h / pow(r2 + h * h, 1.5);
            // Nearer than two pixels a pixel's mean is not what its middle has.
            most = r2 > 1 ? maximum(most, fabs(p.rgb[3 * i + 1] / due - 1)) : most;
        }
        print_message("lamp %g m above a floor: %.2f %% off at most\n", h, 100 * most);
        assert_within(most, 0.02, NULL);
        picture_free(&p);
        tyn_scene_finish(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(floors),
                                       cmocka_unit_test(under_emitter),
                                       cmocka_unit_test(corners),
                                       cmocka_unit_test(behind_a_corner),
                                       cmocka_unit_test(rooms),
                                       cmocka_unit_test(dark_lamps),
                                       cmocka_unit_test(many_suns),
                                       cmocka_unit_test(reflections_of_large_floors),
                                       cmocka_unit_test(lamps_in_a_corner),
                                       cmocka_unit_test(curved_surfaces),
                                       cmocka_unit_test(low_lamp)};
    cmocka_set_test_filter(getenv("TYN_TEST_FILTER"));
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
