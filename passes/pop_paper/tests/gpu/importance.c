// importance.c -- the importance map against a CPU twin in double precision, against photons traced from
// the camera, and what must hold for any camera and medium.
#include "bound.h"
#include "gpu_test.h"
#include "importance_twin.h"
#include "passes/pop_paper/importance/importance.h"
#include "shaders/common/scene_args.h"
#include "numbers.h"
#include "vector.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PORT(name) IMPORTANCE_PORT_##name

enum { TEXELS = TWIN_WIDTH * TWIN_HEIGHT, MAX_VOXELS = 4096 };

typedef struct setup {
    struct medium_block medium;
    struct camera_block camera;
    tyn_importance_params params;
    float density[MAX_VOXELS];
    uint64_t scene; // key of the history
} setup;

static void look(struct camera_block *camera, const float from[3], const float towards[3],
                 float half_width, float half_height)
{
    const float up[3] = {0, 1, 0};
    for (int i = 0; i < 3; i++) {
        camera->origin[i] = from[i];
        camera->forward[i] = towards[i];
    }
    vector_normalisef(camera->forward);
    vector_crossf(camera->forward, up, camera->right);
    vector_normalisef(camera->right);
    vector_crossf(camera->right, camera->forward, camera->up);
    camera->half_width = half_width;
    camera->half_height = half_height;
}

// A homogeneous box of one voxel, unit sides; the camera looks along -z from 3 m before its centre.
static setup *homogeneous(float sigma_s, float sigma_a, float g)
{
    static setup s;
    memset(&s, 0, sizeof s);
    for (int i = 0; i < 3; i++) {
        s.medium.extent[i] = s.medium.voxel[i] = 1;
        s.medium.size[i] = 1;
        s.medium.sigma_s[i] = sigma_s;
        s.medium.sigma_a[i] = sigma_a;
        s.medium.phase[i].g = g;
    }
    s.density[0] = 1;
    look(&s.camera, (float[]){0.5f, 0.5f, 3.5f}, (float[]){0, 0, -1}, 0.3f, 0.3f);
    tyn_pass_defaults(&tyn_pass_importance, &s.params);
    s.params.floor = 0;
    return &s;
}

// Noise in a box that is no cube, three channels, seen from aside.
static setup *noisy(void)
{
    setup *s = homogeneous(1, 1, 0);
    const struct medium_block medium = {.extent = {1.2f, 0.8f, 1.6f},
                                        .size = {12, 10, 14},
                                        .voxel = {0.1f, 0.08f, 1.6f / 14},
                                        .sigma_s = {3, 5, 9},
                                        .sigma_a = {0.5f, 0.1f, 0},
                                        .phase = {{.g = 0.8f}, {.g = 0.5f}, {.g = -0.1f}}};
    s->medium = medium;
    srand(5);
    for (int i = 0; i < 12 * 10 * 14; i++) {
        s->density[i] = rand() % 4 ? (float)(rand() % 1000) * 1e-3f : 0;
    }
    look(&s->camera, (float[]){2.5f, 1.9f, 3}, (float[]){-1, -0.6f, -1.2f}, 0.4f, 0.25f);
    return s;
}

// The map; `field` (if asked for) is the grid as rgba texels.
static const float *run(gpu_test *t, const setup *s, const float **field)
{
    const uint32_t *size = s->medium.size;
    tyn_ref refs[IMPORTANCE_NUM_PORTS] = {0};
    tyn_graph_begin(t->graph);
    refs[PORT(MEDIUM)] = gpu_buffer(t, "medium", &s->medium, sizeof s->medium);
    refs[PORT(CAMERA)] = gpu_buffer(t, "camera", &s->camera, sizeof s->camera);
    if (s->params.mode == TYN_MEDIUM_DENSITY) {
        refs[PORT(DENSITY)] = gpu_image(t, "density", TYN_IMAGE_3D,
                                        (tyn_extent){size[0], size[1], size[2]}, 1, s->density);
    } else {
        static float texels[3][MAX_VOXELS * 4];
        static const char *const names[3] = {"sigma_s", "sigma_a", "g"};
        for (uint32_t q = 0; q < size[0] * size[1] * size[2]; q++) {
            for (int c = 0; c < 3; c++) {
                texels[0][4 * q + c] = s->medium.sigma_s[c] * s->density[q];
                texels[1][4 * q + c] = s->medium.sigma_a[c] * s->density[q];
                texels[2][4 * q + c] = s->medium.phase[c].g;
            }
        }
        for (int i = 0; i < 3; i++) {
            refs[PORT(DENSITY) + i] = gpu_image(
                t, names[i], TYN_IMAGE_3D, (tyn_extent){size[0], size[1], size[2]}, 4, texels[i]);
        }
    }
    refs[PORT(HISTORY)] = tyn_graph_history_buffer(t->graph, "importance_history",
                                                   sizeof(struct importance_history), s->scene);
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_importance, &s->params, refs), TYN_OK);
    tyn_graph_output(t->graph, "map", refs[PORT(IMPORTANCE)], true);
    tyn_graph_output(t->graph, "field", refs[PORT(FIELD)], true);
    gpu_run(t);
    if (field) {
        *field = gpu_map(t, "field");
    }
    return gpu_map(t, "map");
}

static double share(int texel)
{
    double step = 3.14159265358979323846 / TWIN_HEIGHT;
    int row = texel / TWIN_WIDTH;
    return 0.5 * (cos(row * step) - cos((row + 1) * step)) / TWIN_WIDTH;
}

static void check_mean(const float *map)
{
    double mean = 0;
    for (int i = 0; i < TEXELS; i++) {
        assert_true(isfinite(map[i]) && map[i] >= 0);
        mean += share(i) * map[i];
    }
    assert_near(mean, 1, 1e-4);
}

static double l1(const float *map, const double *expected)
{
    double sum = 0;
    for (int i = 0; i < TEXELS; i++) {
        sum += share(i) * fabs(map[i] - expected[i]);
    }
    return sum;
}

static void twin_scene_of(const setup *s, twin_scene *out)
{
    *out = (twin_scene){.density = s->density,
                        .cells = s->params.cells,
                        .iterations = s->params.iterations,
                        .scaled = s->params.scaled != 0,
                        .orthographic = s->camera.orthographic != 0,
                        .half = {s->camera.half_width, s->camera.half_height},
                        .shift = {s->camera.shift[0], s->camera.shift[1]}};
    double weight = 0;
    for (int i = 0; i < 3; i++) {
        out->size[i] = (int)s->medium.size[i];
        out->extent[i] = s->medium.extent[i];
        out->origin[i] = s->camera.origin[i];
        out->right[i] = s->camera.right[i];
        out->up[i] = s->camera.up[i];
        out->forward[i] = s->camera.forward[i];
        out->sigma_s += s->medium.sigma_s[i] / 3.0;
        out->sigma_a += s->medium.sigma_a[i] / 3.0;
        weight += s->medium.sigma_s[i] * s->medium.phase[i].g / 3.0;
    }
    out->g = out->sigma_s > 0 ? weight / out->sigma_s : 0;
}

// ---- against the twin --------------------------------------------------------------------------

static void compare(gpu_test *t, const setup *s, const char *name)
{
    static double expected[TEXELS], field[32 * 32 * 32][3];
    const float *texels;
    const float *map = run(t, s, &texels);
    twin_scene scene;
    twin_scene_of(s, &scene);
    twin_importance(&scene, expected, field);
    check_mean(map);
    // A cell's density is the mean of 27 reads, each off along three axes by a part of the difference of neighbours, which is 1 at
    // most; three standard deviations.
    const double off = gpu_filter_shift(t) * sqrt(3) * sqrt(3.0 / 27);
    double worst = 0, top = 0;
    int n = s->params.cells;
    for (int i = 0; i < n * n * n; i++) {
        top = fmax(top, field[i][0]);
    }
    for (int i = 0; i < n * n * n; i++) {
        for (int c = 0; c < 2; c++) {
            worst = maximum(worst, fabs(texels[4 * i + c] - field[i][c]) / top);
        }
        assert_near(texels[4 * i + 2], field[i][2],
                    1e-4 * (1 + field[i][2]) + off * (scene.sigma_s + scene.sigma_a));
    }
    double difference = l1(map, expected);
    print_message("%-28s largest difference of the field %.1e of its maximum, of the map L1 %.1e\n",
                  name, worst, difference);
    assert_true(worst < 1e-4 + off && difference < 1e-4);
}

static void against_twin(void **state)
{
    setup *s = noisy();
    compare(*state, s, "aside");
    s->camera.shift[0] = 0.7f;
    s->camera.shift[1] = -0.4f;
    s->params.scaled = 1;
    s->params.cells = 9;
    s->params.iterations = 13;
    compare(*state, s, "shifted, delta-scaled, odd");

    s = noisy();
    look(&s->camera, (float[]){0.5f, 0.3f, 0.9f}, (float[]){0.3f, 0.2f, -1}, 0.6f, 0.5f);
    compare(*state, s, "camera inside");

    s = noisy();
    look(&s->camera, (float[]){3.1f, 2, 4}, (float[]){-1, -0.63f, -1.2f}, 0.7f, 0.5f);
    s->camera.orthographic = 1;
    compare(*state, s, "orthographic");

    compare(*state, homogeneous(4, 0.5f, 0.7f), "unit cube, g = 0.7");
    compare(*state, homogeneous(4, 0.5f, -0.8f), "unit cube, g = -0.8");
}

// The same medium given as coefficients.
static void coefficients(void **state)
{
    setup *s = noisy();
    double density[TEXELS];
    const float *map = run(*state, s, NULL);
    for (int i = 0; i < TEXELS; i++) {
        density[i] = map[i];
    }
    s->params.mode = TYN_MEDIUM_COEFFICIENTS;
    assert_true(l1(run(*state, s, NULL), density) < 1e-4);
}

// ---- against photons ---------------------------------------------------------------------------

// The scheme is coarse (16 cells, two numbers each); what it must get right is where light matters.
static void against_photons(void **state)
{
    static const struct {
        float sigma_s, g;
        double limit;
    } cases[] = {{0.5f, 0, 0.06}, {1, 0.7f, 0.08},  {4, 0, 0.08},
                 {4, 0.7f, 0.12}, {4, 0.98f, 0.25}, {2, -0.5f, 0.2}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        static double traced[TEXELS];
        setup *s = homogeneous(cases[i].sigma_s, 0, cases[i].g);
        twin_scene scene;
        twin_scene_of(s, &scene);
        twin_photons(&scene, 400000, traced);
        const float *map = run(*state, s, NULL);
        float ones[TEXELS];
        for (int q = 0; q < TEXELS; q++) {
            ones[q] = 1;
        }
        double difference = l1(map, traced), without = l1(ones, traced);
        print_message("sigma_s %.1f, g %5.2f: L1 to photons %.3f (a uniform map: %.3f)\n",
                      (double)cases[i].sigma_s, (double)cases[i].g, difference, without);
        assert_true(within(difference, cases[i].limit, NULL, "photons, sigma_s %g, g %g",
                           (double)cases[i].sigma_s, (double)cases[i].g));
    }
}

// ---- what must hold -----------------------------------------------------------------------------

// Part of the importance that is in the half-space of `axis`.
static double in_half_space(const float *map, const double axis[3])
{
    double sum = 0;
    for (int i = 0; i < TEXELS; i++) {
        double w[3];
        twin_direction(i, w);
        sum += w[0] * axis[0] + w[1] * axis[1] + w[2] * axis[2] > 0 ? share(i) * map[i] : 0;
    }
    return sum;
}

static void where_light_matters(void **state)
{
    const double behind[3] = {0, 0, -1}, before[3] = {0, 0, 1}; // the camera looks along -z
    const float *map = run(*state, homogeneous(0.01f, 0, 0.9f), NULL);
    double part = in_half_space(map, behind);
    print_message("thin, g = 0.9: %.3f of the importance lies behind the medium\n", part);
    assert_true(part > 0.95);
    setup *s = homogeneous(100, 0, 0);
    s->params.iterations = 128;
    part = in_half_space(run(*state, s, NULL), before);
    print_message("thick, isotropic: %.3f of it on the camera's side\n", part);
    assert_true(part > 0.7);
}

static void nothing_to_see(void **state)
{
    setup *s = homogeneous(0, 0, 0.5f);
    for (int i = 0; i < 3; i++) {
        if (i == 1) { // medium, but behind the camera
            s = homogeneous(2, 0, 0.5f);
            s->camera.origin[2] = -1;
        } else if (i == 2) { // beside the picture
            s = homogeneous(2, 0, 0.5f);
            s->camera.shift[0] = 9;
        }
        const float *map = run(*state, s, NULL);
        for (int q = 0; q < TEXELS; q++) {
            assert_near(map[q], 1, 0);
        }
    }
}

static void extremes(void **state)
{
    const float sigmas[] = {1e-6f, 1, 1e3f, 1e6f}, cosines[] = {-0.9f, -1e-8f, 0, 0.9f, 0.9999f};
    for (int i = 0; i < 4 * 5 * 4; i++) {
        setup *s = homogeneous(sigmas[i % 4], i % 3 ? 0 : sigmas[i / 2 % 4], cosines[i / 4 % 5]);
        s->params.scaled = i & 1;
        if (i / 20 == 1) { // a corner of the box, where the camera is in three faces
            look(&s->camera, (float[]){0, 0, 0}, (float[]){1, 1, 1}, 0.5f, 0.5f);
        } else if (i / 20 == 2) { // a thin sheet, edge on
            s->medium.extent[1] = s->medium.voxel[1] = 1e-3f;
            s->camera.origin[1] = 5e-4f;
        } else if (i / 20 == 3) {
            s->camera.orthographic = 1;
            s->camera.origin[2] = 0.5f;
        }
        check_mean(run(*state, s, NULL));
    }
}

// Without history the still picture at once; with it an exponential mean; another scene starts anew.
static void smoothing(void **state)
{
    static double first[TEXELS], second[TEXELS], mixed[TEXELS];
    setup *s = homogeneous(2, 0, 0.8f);
    for (int i = 0; i < 3; i++) {
        s->params.smoothing = i == 2 ? 0.75f : 0;
        s->scene = i == 2 ? 2 : 1;
        look(&s->camera, (float[]){0.5f, 0.5f, 3.5f}, (float[]){i == 1 ? 0.2f : 0, 0, -1}, 0.3f,
             0.3f);
        const float *map = run(*state, s, NULL);
        for (int q = 0; q < TEXELS; q++) {
            *(i == 0 ? &first[q] : i == 1 ? &second[q] : &mixed[q]) = map[q];
        }
    }
    for (int q = 0; q < TEXELS; q++) {
        assert_near(first[q], mixed[q], 0);
        mixed[q] = 0.75 * first[q] + 0.25 * second[q];
    }
    look(&s->camera, (float[]){0.5f, 0.5f, 3.5f}, (float[]){0.2f, 0, -1}, 0.3f, 0.3f);
    assert_true(l1(run(*state, s, NULL), mixed) < 1e-5);
    s->scene = 3;
    assert_true(l1(run(*state, s, NULL), second) < 1e-6);
}

// A camera that turns by half a degree changes the map a little.
static void steady(void **state)
{
    static double before[TEXELS];
    setup *s = noisy();
    double worst = 0;
    for (int frame = 0; frame < 12; frame++) {
        double angle = frame * 0.5 / 57.29578;
        look(&s->camera,
             (float[]){(float)(0.6 + 2.6 * sin(angle)), 0.4f, (float)(0.8 + 2.6 * cos(angle))},
             (float[]){(float)-sin(angle), 0, (float)-cos(angle)}, 0.4f, 0.3f);
        const float *map = run(*state, s, NULL);
        worst = frame > 0 ? maximum(worst, l1(map, before)) : 0;
        for (int q = 0; q < TEXELS; q++) {
            before[q] = map[q];
        }
    }
    print_message("largest change of the map by half a degree: L1 %.4f\n", worst);
    assert_within(worst, 0.012, NULL);
    print_message("time: %.1f ms\n", gpu_ms(*state, "importance"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(against_twin),    cmocka_unit_test(coefficients),
        cmocka_unit_test(against_photons), cmocka_unit_test(where_light_matters),
        cmocka_unit_test(nothing_to_see),  cmocka_unit_test(extremes),
        cmocka_unit_test(smoothing),       cmocka_unit_test(steady),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
