// constellation.c -- method `constellation` as a whole: closed forms, what the optimisations must not change, and
// surfaces. Which nodes run when something changes: passes/constellation/tests/graph/constellation.c.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "offline_frame.h"
#include "picture.h"
#include "random_unit.h"
#include "solids.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 32, PIXELS = SIZE * SIZE, NX = 20, NY = 16, NZ = 12 };

typedef struct stage {
    tyn_scene scene;
    tyn_view view;
} stage;

static void strike(stage *s)
{
    tyn_scene_finish(&s->scene);
    free(s);
}

// The unit cube seen along -z.
static stage *cube(float sigma_s, float sigma_a)
{
    stage *s = calloc(1, sizeof *s);
    tyn_scene_init(&s->scene);
    tyn_medium medium = grey_medium(sigma_s, sigma_a, 0);
    scene_add_box(&s->scene, &medium, (float[]){0, 0, 0}, (float[]){1, 1, 1}, NULL, NULL);
    view_orthographic(&s->view, (float[]){0.5f, 0.5f, 0.5f}, 0, 0, -1, (float[]){0, 1, 0}, 0.5f,
                      SIZE);
    s->view.no_background = true;
    return s;
}

// A few clumps in a box that is mostly empty, from nearby.
static stage *clumps(void)
{
    stage *s = calloc(1, sizeof *s);
    tyn_scene_init(&s->scene);
    float grid[NX * NY * NZ] = {0};
    uint32_t seed = 9;
    for (int k = 0; k < 5; k++) {
        const int x = 2 + (int)(random_unit(&seed) * (NX - 5));
        const int y = 2 + (int)(random_unit(&seed) * (NY - 5));
        const int z = 2 + (int)(random_unit(&seed) * (NZ - 5));
        for (int q = 0; q < 27; q++) {
            grid[((z + q / 9) * NY + y + q / 3 % 3) * NX + x + q % 3] = (float)random_unit(&seed);
        }
    }
    tyn_medium medium = grey_medium(20, 4, 0.4f);
    medium.sigma_s[2] = 9;
    scene_add_box(&s->scene, &medium, (float[]){-1, -0.8f, -0.6f}, (float[]){1, 0.8f, 0.6f},
                  (const uint32_t[]){NX, NY, NZ}, grid);
    s->view = (tyn_view){.width = SIZE, .height = SIZE};
    s->view.camera.yfov = 0.8f;
    const float from[3] = {0.7f, 0.9f, 2.6f}, at[3] = {0, 0, 0};
    assert_int_equal(tyn_camera_look_at(&s->view.camera, from, at), TYN_OK);
    return s;
}

// 64 x 32 texels, of which one may be bright.
static void set_map(tyn_scene *scene, float around, int x, int y, float bright)
{
    enum { W = 64, H = 32 };
    tyn_environment *env = &scene->environment;
    free(env->data);
    *env = (tyn_environment){.present = true,
                             .size = {W, H},
                             .data = malloc(W * H * 3 * sizeof(float)),
                             .radiance = {1, 1, 1},
                             .strength = 1};
    for (int i = 0; i < W * H * 3; i++) {
        env->data[i] =
            i / 3 == y * W + x ? bright : around * (1 + (float)(i % 7 + i / 3 / W) * 0.1f);
    }
    env->hash = 31u + (uint64_t)x + 64u * (uint64_t)y;
}

static picture render(gpu_test *t, const stage *s, const char *settings)
{
    picture p;
    picture_render(&p, t->dev, "constellation", &s->scene, &s->view, settings, 0);
    assert_int_equal(tyn_device_validation_messages(t->dev), 0);
    return p;
}

static double sum_of(const picture *p)
{
    double sum = 0;
    for (uint32_t i = 0; i < 3 * p->width * p->height; i++) {
        sum += p->rgb[i];
    }
    return sum;
}

// Largest difference, of the brightest value.
static double apart(const picture *a, const picture *b)
{
    double most = 0, brightest = 0;
    for (uint32_t i = 0; i < 3 * a->width * a->height; i++) {
        most = maximum(most, fabs((double)a->rgb[i] - b->rgb[i]));
        brightest = maximum(brightest, b->rgb[i]);
    }
    return most / brightest;
}

// ---- closed forms -----------------------------------------------------------------------------

// A sun from above on a cube of depth `depth`: what each row of pixels shows, for each lighting.
static void cubes(void **state)
{
    static const double depths[] = {0.1, 1, 4, 12};
    for (size_t k = 0; k < sizeof depths / sizeof *depths; k++) {
        const double depth = depths[k], albedo = 0.8;
        stage *s = cube((float)(albedo * depth), (float)((1 - albedo) * depth));
        scene_add_sun(&s->scene, 0, -1, 0, 3, 3, 3);
        static const char *const settings[] = {"constellation.lighting=primary",
                                               "constellation.lighting=self-shadowed",
                                               "constellation.lighting=alpha"};
        for (int l = 0; l < 3; l++) {
            picture p = render(*state, s, settings[l]);
            double worst = 0;
            for (int i = 0; i < PIXELS; i++) {
                const double below = (i / SIZE + 0.5) / SIZE; // rows run down
                const double sun = 3 * (l == 1 ? exp(-depth * below) : 1);
                const double right = albedo * sun / (4 * M_PI) * (1 - exp(-depth));
                worst = maximum(worst, fabs(p.rgb[3 * i] / right - 1));
            }
            print_message("depth %g, %s: %.2e off\n", depth, settings[l], worst);
            assert_true(worst < 1e-4);
            picture_free(&p);
        }
        strike(s);
    }
}

// 16 pi^2 is 4 pi times 4 pi; the printed sum is too dark by about half a slice's depth.
static void readings(void **state)
{
    stage *s = cube(4, 0);
    scene_add_sun(&s->scene, 0, -1, 0, 3, 3, 3);
    picture usual = render(*state, s, NULL), darker = render(*state, s, "constellation.norm=16pi2");
    picture printed = render(*state, s, "constellation.quadrature=printed");
    for (int i = 0; i < PIXELS * 3; i++) {
        assert_true(fabs(usual.rgb[i] / darker.rgb[i] / (4 * M_PI) - 1) < 1e-5);
    }
    const double slice = 4.0 / 128, right = slice * exp(-slice) / (1 - exp(-slice));
    const double found = sum_of(&printed) / sum_of(&usual);
    print_message("printed sum: %.4f of the integral, as expected %.4f\n", found, right);
    assert_true(fabs(found - right) < 2e-4);
    picture_free(&usual);
    picture_free(&darker);
    picture_free(&printed);
    strike(s);
}

// A radiance that is equal from all sides, and a medium without shadows: the constellation's power is 4 pi times it.
static void uniform_sky(void **state)
{
    stage *s = cube(2, 0);
    scene_set_sky(&s->scene, 0.7f);
    for (int k = 0; k < 2; k++) {
        picture p = render(*state, s,
                           k ? "constellation.lighting=alpha"
                             : "constellation.lighting=primary constellation.lights=37");
        for (int i = 0; i < PIXELS * 3; i++) {
            assert_true(fabs(p.rgb[i] / (0.7 * (1 - exp(-2))) - 1) < 1e-4);
        }
        picture_free(&p);
    }
    strike(s);
}

// A map that is black but for a texel, turned, is a sun.
static void turned_map(void **state)
{
    const double azimuth = (40.5 / 64 - 0.5) * 2 * M_PI, polar = 9.5 / 32 * M_PI;
    const double solid = 2 * M_PI / 64 * (cos(M_PI * 9 / 32) - cos(M_PI * 10 / 32));
    const double turn = 0.8; // radians about +Y: x towards -z
    const double d[3] = {sin(polar) * sin(azimuth), cos(polar), -sin(polar) * cos(azimuth)};
    const double world[3] = {cos(turn) * d[0] + sin(turn) * d[2], d[1],
                             -sin(turn) * d[0] + cos(turn) * d[2]};
    stage *s = clumps();
    s->view.no_background = true;
    set_map(&s->scene, 0, 40, 9, 50);
    s->scene.environment.rotation[1] = (float)sin(turn / 2);
    s->scene.environment.rotation[3] = (float)cos(turn / 2);
    picture of_map = render(*state, s, "constellation.lights=1");
    s->scene.environment.present = false;
    const float e = (float)(50 * solid);
    scene_add_sun(&s->scene, (float)-world[0], (float)-world[1], (float)-world[2], e, e, e);
    picture of_sun = render(*state, s, NULL);
    const double off = apart(&of_map, &of_sun);
    print_message("a map of one texel, turned: %.1e off a sun\n", off);
    assert_within(off, 2e-3, "of the texel's size: its light comes from its middle by luminance");
    picture_free(&of_map);
    picture_free(&of_sun);
    s->scene.environment.present = true;
    strike(s);
}

// ---- optimisations ----------------------------------------------------------------------------

static void add_lights(stage *s)
{
    scene_add_sun(&s->scene, -1, -2, -0.5f, 1, 2, 1);
    s->scene.lights[s->scene.num_lights++] =
        (tyn_light){.kind = TYN_LIGHT_POINT, .color = {3, 2, 1}, .position = {0.1f, 0.2f, 0}};
    s->scene.lights[s->scene.num_lights++] = (tyn_light){.kind = TYN_LIGHT_SPOT,
                                                         .color = {9, 9, 9},
                                                         .position = {-2, 1, 1},
                                                         .direction = {0.8f, -0.36f, -0.48f},
                                                         .cos_inner = 0.95f,
                                                         .cos_outer = 0.8f};
}

static void add_wall(stage *s)
{
    const float grey[3] = {0.5f, 0.4f, 0.3f}, black[3] = {0, 0, 0};
    const uint32_t m = solids_material(&s->scene, grey, black);
    solids_quad(&s->scene, (float[]){-0.5f, -0.9f, -0.3f}, (float[]){0.9f, 0, 0.2f},
                (float[]){0, 1.2f, 0}, m);
}

// Mask and distance map change nothing, in one medium, in two, among surfaces.
static void same_pictures(void **state)
{
    static const char *const off = "constellation.mask=0 constellation.distance=0 ";
    static const char *const on[] = {"constellation.mask=1 constellation.distance=0 ",
                                     "constellation.mask=0 constellation.distance=1 ",
                                     "constellation.mask=1 constellation.distance=1 "};
    static const char *const lightings[] = {"alpha", "primary", "self-shadowed"};
    for (int k = 0; k < 3; k++) {
        stage *s = clumps();
        set_map(&s->scene, 0.2f, 40, 9, 50);
        if (k > 0) {
            add_lights(s);
        }
        if (k == 1) { // overlapping
            tyn_medium other = grey_medium(3, 1, -0.2f);
            other.sigma_a[0] = 4;
            scene_add_box(&s->scene, &other, (float[]){-0.9f, -0.7f, 0}, (float[]){-0.2f, 0, 0.5f},
                          NULL, NULL);
        }
        if (k == 2) {
            add_wall(s);
        }
        for (int l = 0; l < 3; l++) {
            char settings[256];
            const char *rest = "constellation.lights=6 constellation.lighting=";
            snprintf(settings, sizeof settings, "%s%s%s", off, rest, lightings[l]);
            picture plain = render(*state, s, settings);
            assert_true(sum_of(&plain) > 0);
            for (int i = 0; i < 3; i++) {
                snprintf(settings, sizeof settings, "%s%s%s", on[i], rest, lightings[l]);
                picture p = render(*state, s, settings);
                const double most = apart(&p, &plain);
                print_message("scene %d, %-13s %s: %.1e off\n", k, lightings[l], on[i], most);
                assert_true(most < 1e-5);
                picture_free(&p);
            }
            picture_free(&plain);
        }
        strike(s);
    }
}

// ---- surfaces ---------------------------------------------------------------------------------

// What is left of the light of surfaces and of what is behind them, as `pop` has it; edges of surfaces in pixels.
static void surfaces(void **state)
{
    gpu_test *t = *state;
    stage *s = cube(1.5f, 0.5f);
    s->view.no_background = false;
    const float grey[3] = {0.5f, 0.5f, 0.5f}, glow[3] = {3, 2, 1};
    const uint32_t m = solids_material(&s->scene, grey, glow);
    solids_quad(&s->scene, (float[]){0.203f, 0.111f, 0.4f}, (float[]){0.5f, 0.1f, 0.2f},
                (float[]){-0.1f, 0.5f, 0}, m);
    s->view.outputs = TYN_OUTPUT_RADIANCE | TYN_OUTPUT_TRANSMITTANCE | TYN_OUTPUT_DEPTH;
    static float layers[2][3][PIXELS * 4];
    for (int k = 0; k < 2; k++) {
        tyn_offline *off = scene_open(t->dev, k ? "pop" : "constellation", NULL);
        offline_frame(off, &s->scene, &s->view);
        static const tyn_output outputs[] = {TYN_OUTPUT_RADIANCE, TYN_OUTPUT_TRANSMITTANCE,
                                             TYN_OUTPUT_DEPTH};
        for (int i = 0; i < 3; i++) {
            memcpy(layers[k][i], tyn_offline_output(off, outputs[i]), sizeof layers[k][i]);
        }
        tyn_offline_destroy(&off);
    }
    int shown = 0;
    double through = 0, radiance = 0, depth = 0;
    for (int i = 0; i < PIXELS; i++) {
        const float *a = layers[0][1] + 4 * i, *b = layers[1][1] + 4 * i;
        through = fmax(through, fabsf(a[0] - b[0]));
        const float *near = layers[0][2] + 4 * i, *other = layers[1][2] + 4 * i;
        assert_true(isinf(near[0]) == isinf(other[0]));
        if (!isinf(near[0])) {
            shown++;
            depth = fmax(depth, fabsf(near[0] / other[0] - 1));
            if (layers[0][0][4 * i + 3] == 1) { // no light but the surface's own
                radiance = fmax(radiance, fabs(layers[0][0][4 * i] / (3.0 * a[0]) - 1));
            }
        }
    }
    print_message("%d pixels with surface: transmittance %.1e off, emission %.1e, distance %.1e\n",
                  shown, through, radiance, depth);
    assert_true(shown > 100);
    assert_true(through < 1e-5);
    assert_within(depth, 1e-4, BOUND_ROUNDING);
    assert_true(radiance < 1e-5);
    strike(s);
}

// ---- dispatches --------------------------------------------------------------------------------

// More lights than a dispatch can light every slice for: the rays are handed on, which must change nothing.
static void many_lights(void **state)
{
    stage *s = clumps();
    s->view.no_background = true;
    for (int i = 0; i < 3; i++) {
        scene_add_sun(&s->scene, (float)i - 1, -2, 0.3f, 1, 1, 1);
    }
    picture sum = render(*state, s, "constellation.slice=0.1");
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < 3; i++) {
            for (int c = 0; c < 3; c++) {
                s->scene.lights[i].color[c] = i == k;
            }
        }
        picture one = render(*state, s, "constellation.slice=0.1");
        for (int i = 0; i < PIXELS * 3; i++) {
            sum.rgb[i] -= one.rgb[i];
        }
        picture_free(&one);
    }
    double most = 0;
    for (int i = 0; i < PIXELS * 3; i++) {
        most = maximum(most, fabsf(sum.rgb[i]));
    }
    picture_free(&sum);
    assert_true(most < 1e-5);
    // 20 lights each a twentieth of one.
    s->scene.num_lights = 0;
    scene_add_sun(&s->scene, -1, -2, 0.3f, 1, 1, 1);
    picture one = render(*state, s, "constellation.slice=0.2");
    s->scene.num_lights = 0;
    for (int i = 0; i < 20; i++) {
        scene_add_sun(&s->scene, -1, -2, 0.3f, 0.05f, 0.05f, 0.05f);
    }
    picture twenty = render(*state, s, "constellation.slice=0.2");
    const double off = apart(&twenty, &one);
    print_message("twenty lights of a twentieth: %.1e off one\n", off);
    assert_true(off < 1e-5);
    picture_free(&one);
    picture_free(&twenty);
    strike(s);
}

// A rod of 2562 slices under 64 suns, of which most shine along it: a slice's shadow rays turn more often than a dispatch may.
// `wall`: one that glows stands in it, and suns shine along the wall, so that it has no shadow.
static stage *rod(bool wall)
{
    enum { N = 128 };
    stage *s = calloc(1, sizeof *s);
    tyn_scene_init(&s->scene);
    float grid[N * 4];
    uint32_t seed = 5;
    for (int q = 0; q < N * 4; q++) {
        grid[q] = q % N / 3 % 4 == 1 ? 0 : (float)(0.4 + random_unit(&seed));
    }
    tyn_medium medium = grey_medium(4, 1, 0.3f);
    medium.emission[1] = 0.4f;
    const float thick = 1.f / 128;
    scene_add_box(&s->scene, &medium, (float[]){0, -thick, -thick}, (float[]){1, thick, thick},
                  (const uint32_t[]){N, 2, 2}, grid);
    for (int i = 0; i < 64; i++) {
        float x[5];
        for (int k = 0; k < 5; k++) {
            x[k] = (float)random_unit(&seed);
        }
        if (wall) {
            scene_add_sun(&s->scene, 0, i % 2 ? -1 : 1, 0, x[2], x[3], x[4]);
        } else if (i % 16 == 3) {
            scene_add_sun(&s->scene, x[0] - 0.5f, x[1] - 0.5f, -1, x[2], x[3], x[4]);
        } else {
            scene_add_sun(&s->scene, -1, 0.01f * (x[0] - 0.5f), 0.01f * (x[1] - 0.5f), x[2], x[3],
                          x[4]);
        }
    }
    if (wall) {
        const float black[3] = {0, 0, 0}, glow[3] = {0.3f, 0.2f, 0.1f};
        solids_quad(&s->scene, (float[]){0.0485f, -1, 0}, (float[]){0.1f, 0, 0.004f},
                    (float[]){0, 2, 0}, solids_material(&s->scene, black, glow));
    }
    view_orthographic(&s->view, (float[]){0.05f, 0, 0}, 0.2f, 0.1f, -1, (float[]){0, 1, 0},
                      0.5f * thick, 2);
    s->view.width = 6;
    s->view.no_background = !wall; // else surfaces are not seen
    return s;
}

// Lights that a dispatch cannot shine by for even one slice are the sum of those that it can.
static void lights_in_parts(void **state)
{
    enum { RUNS = 4, EACH = 64 / RUNS };
    for (int wall = 0; wall < 2; wall++) {
        stage *s = rod(wall);
        const char *const settings = "constellation.slice=0.05";
        picture all = render(*state, s, settings);
        tyn_light suns[64];
        memcpy(suns, s->scene.lights, sizeof suns);
        s->scene.num_lights = 0;
        picture glow = render(*state, s, settings), sum = render(*state, s, settings);
        assert_true(sum_of(&glow) > 0);
        for (int k = 0; k < RUNS; k++) {
            s->scene.num_lights = EACH;
            memcpy(s->scene.lights, suns + k * EACH, EACH * sizeof *suns);
            picture some = render(*state, s, settings);
            for (uint32_t i = 0; i < 3 * all.width * all.height; i++) {
                sum.rgb[i] += some.rgb[i] - glow.rgb[i];
            }
            picture_free(&some);
        }
        const double off = apart(&all, &sum);
        print_message("64 lights in a rod%s: %.1e off their sum, of which %.0f %% glows\n",
                      wall ? " with a wall" : "", off, 100 * sum_of(&glow) / sum_of(&sum));
        assert_true(off < 1e-5);
        picture_free(&sum);
        picture_free(&glow);
        picture_free(&all);
        strike(s);
    }
}

// Rays of a picture that is as wide as this are handed on as well.
static void wide_picture(void **state)
{
    stage *s = clumps();
    s->view.no_background = true;
    s->view.width = 6000;
    s->view.height = 1;
    s->view.camera.yfov = 0.001f;
    scene_add_sun(&s->scene, -1, -2, 0.3f, 1, 1, 1);
    picture one = render(*state, s, "constellation.slice=0.3");
    s->scene.num_lights = 0;
    for (int i = 0; i < 20; i++) {
        scene_add_sun(&s->scene, -1, -2, 0.3f, 0.05f, 0.05f, 0.05f);
    }
    picture twenty = render(*state, s, "constellation.slice=0.3");
    const double off = apart(&twenty, &one);
    print_message("twenty lights of a twentieth, 6000 pixels wide: %.1e off one\n", off);
    assert_true(off < 1e-5);
    picture_free(&one);
    picture_free(&twenty);
    strike(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cubes),         cmocka_unit_test(readings),
        cmocka_unit_test(uniform_sky),   cmocka_unit_test(turned_map),
        cmocka_unit_test(same_pictures), cmocka_unit_test(surfaces),
        cmocka_unit_test(many_lights),   cmocka_unit_test(lights_in_parts),
        cmocka_unit_test(wide_picture),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
