// shafts.c -- sunlight through a slit above fog: `single` against the integral along each ray, `pop` against
// `path`, and a closed box that stays dark.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "offline_frame.h"
#include "picture.h"
#include "solids.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const float sigma_s = 0.5f, sigma_a = 0.2f, g = 0.3f;
static const float sun[3] = {0.3f, -1, 0.1f}; // not of unit length
static const float slit[2] = {0.4f, 0.6f}, plate = 1.1f;

// A cube of fog of 1 m; black plates above it leave a slit along z.
static void make_scene(tyn_scene *scene)
{
    tyn_scene_init(scene);
    const tyn_medium fog = grey_medium(sigma_s, sigma_a, g);
    scene_add_box(scene, &fog, (float[]){0, 0, 0}, (float[]){1, 1, 1}, NULL, NULL);
    const float length = sqrtf(sun[0] * sun[0] + sun[1] * sun[1] + sun[2] * sun[2]);
    scene_add_sun(scene, sun[0] / length, sun[1] / length, sun[2] / length, 3, 2, 1);
    const uint32_t black = solids_material(scene, (float[3]){0}, (float[3]){0});
    solids_quad(scene, (float[]){-2, plate, -1}, (float[]){0, 0, 3}, (float[]){2 + slit[0], 0, 0},
                black);
    solids_quad(scene, (float[]){slit[1], plate, -1}, (float[]){0, 0, 3}, (float[]){2, 0, 0},
                black);
}

// Where the sun's ray through (x, y) comes through the plates' plane, from the middle of the slit, in half
// widths of it.
static double in_slit(double x, double y)
{
    const double at = x - ((double)plate - y) / -(double)sun[1] * (double)sun[0];
    return (at - 0.5 * ((double)slit[0] + (double)slit[1])) /
           (0.5 * ((double)slit[1] - (double)slit[0]));
}

static double phase(double mu)
{
    const double q = (double)g;
    return (1 - q * q) / (4 * M_PI * pow(1 + q * q - 2 * q * mu, 1.5));
}

// Way from a point of the cube against direction d (of unit length) to its faces.
static double way_back(const double p[3], const double d[3])
{
    double way = INFINITY;
    for (int a = 0; a < 3; a++) {
        if (d[a] != 0) {
            way = fmin(way, d[a] > 0 ? p[a] / d[a] : (p[a] - 1) / d[a]);
        }
    }
    return way;
}

// Light of irradiance 1 that has scattered once, along the ray (x, y) in direction -z.
static double once(double x, double y)
{
    if (fabs(in_slit(x, y)) > 1 || x < 0 || x > 1 || y < 0 || y > 1) {
        return 0;
    }
    const double length = sqrt((double)(sun[0] * sun[0] + sun[1] * sun[1] + sun[2] * sun[2]));
    const double d[3] = {(double)sun[0] / length, (double)sun[1] / length, (double)sun[2] / length};
    const double sigma_t = (double)(sigma_s + sigma_a);
    enum { STEPS = 200 };
    double sum = 0;
    for (int i = 0; i < STEPS; i++) {
        const double p[3] = {x, y, (i + 0.5) / STEPS};
        sum += exp(-sigma_t * (way_back(p, d) + 1 - p[2])) / STEPS;
    }
    return (double)sigma_s * phase(d[2]) * sum; // turns from d to +z
}

static void once_through_a_slit(void **state)
{
    gpu_test *t = *state;
    enum { SIZE = 64 };
    tyn_scene scene;
    make_scene(&scene);
    tyn_view view = {0};
    view_orthographic(&view, (float[]){0.5f, 0.5f, 3}, 0, 0, -1, (float[]){0, 1, 0}, 0.5f, SIZE);
    picture p;
    picture_render(&p, t->dev, "single", &scene, &view, "shadow_map.sun_texels=1024", 1);
    const double texel = 4.7 / 1020, pixel = 1.0 / SIZE, width = 0.5 * (double)(slit[1] - slit[0]);
    double sum = 0, right_sum = 0;
    uint32_t lit = 0, dark = 0;
    for (uint32_t j = 0; j < SIZE; j++) {
        for (uint32_t i = 0; i < SIZE; i++) {
            const double x = (i + 0.5) * pixel, y = 1 - (j + 0.5) * pixel;
            const double right = once(x, y), found = (double)p.rgb[3 * (j * SIZE + i)] / 3;
            const double beyond = (fabs(in_slit(x, y)) - 1) * width; // the edge, m
            sum += found;
            right_sum += right;
            if (fabs(beyond) < texel) {
                continue;
            }
            lit += right > 0;
            dark += right == 0;
            if (!(fabs(found - right) <= 0.02 * right)) {
                fail_msg("(%g, %g): %g, not %g, %g m from the edge", x, y, found, right, beyond);
            }
        }
    }
    print_message("%u lit pixels, %u dark ones; all light %.4f of the right one\n", lit, dark,
                  sum / right_sum);
    assert_true(lit > 500 && dark > 2000);
    assert_within(fabs(sum / right_sum - 1), 0.03, NULL);
    picture_free(&p);
    tyn_scene_finish(&scene);
}

// One ray for 2x2 pixels: as good as all rays, with a shaft's edges, those of the plates, and the fog's. By where the
// rays fall a single view's worst pixel is up to 1.44 times as far off: the mean of several views tells whether they all are.
static void sparse_rays(void **state)
{
    gpu_test *t = *state;
    enum { SIZE = 64, VALUES = 3 * SIZE * SIZE, VIEWS = 8 };
    tyn_scene scene;
    make_scene(&scene);
    tyn_view view = {.width = SIZE, .height = SIZE};
    view.camera.yfov = 0.7f;
    static const char *const settings[3] = {
        "lattice.cells=24 raymarch.sparse=0 raymarch.step=0.1",
        "lattice.cells=24 raymarch.sparse=0",
        "lattice.cells=24 raymarch.sparse=1",
    };
    double sum = 0, apart[3] = {0}, worst[3] = {0}, most = 0;
    uint32_t differ = 0;
    for (int v = 0; v < VIEWS; v++) {
        const float from[3] = {1.2f + 0.03f * (float)(v % 4), 1.0f + 0.03f * (float)(v / 4), 2.6f};
        assert_int_equal(tyn_camera_look_at(&view.camera, from, (float[]){0.5f, 0.6f, 0.5f}),
                         TYN_OK);
        picture pictures[3];
        double light = 0, worst_here[3] = {0};
        for (int k = 0; k < 3; k++) {
            picture_render(&pictures[k], t->dev, "pop", &scene, &view, settings[k], 1);
        }
        const float *fine = pictures[0].rgb;
        for (uint32_t i = 0; i < VALUES; i++) {
            light += (double)fine[i];
        }
        for (uint32_t i = 0; i < VALUES; i++) {
            for (int k = 1; k < 3; k++) {
                const double off = fabs((double)pictures[k].rgb[i] - (double)fine[i]);
                apart[k] += off;
                worst_here[k] =
                    maximum(worst_here[k], off / ((double)fine[i] + 0.1 * light / VALUES));
            }
            differ += pictures[2].rgb[i] != pictures[1].rgb[i];
        }
        sum += light;
        most = maximum(most, worst_here[2] / worst_here[1]);
        for (int k = 0; k < 3; k++) {
            worst[k] += worst_here[k] / VIEWS;
            picture_free(&pictures[k]);
        }
    }
    print_message("sparse rays: %.3f %% off a march of a tenth of the step, all rays %.3f %%; a "
                  "view's worst pixel %.2f %%, %.2f %%; %.0f %% of the values differ\n",
                  100 * apart[2] / sum, 100 * apart[1] / sum, 100 * worst[2], 100 * worst[1],
                  100.0 * differ / (VIEWS * VALUES));
    assert_true(differ > VIEWS * VALUES / 30); // else nothing was saved
    assert_within(apart[2] / apart[1], 1.3, NULL);
    assert_within(worst[2] / worst[1], 1.1, NULL);
    assert_within(most, 1.5, NULL);
    tyn_scene_finish(&scene);
}

// Everything that scatters on, too.
static void all_orders(void **state)
{
    gpu_test *t = *state;
    enum { SIZE = 32 };
    tyn_scene scene;
    make_scene(&scene);
    scene.media[0] = grey_medium(1.5f, 0.1f, 0.3f);
    tyn_view view = {0};
    view_orthographic(&view, (float[]){0.5f, 0.5f, 3}, 0, 0, -1, (float[]){0, 1, 0}, 0.5f, SIZE);
    picture p, q;
    picture_render(&p, t->dev, "pop", &scene, &view, "lattice.cells=24", 1);
    picture_render(&q, t->dev, "path", &scene, &view, NULL, 256);
    picture_error e = picture_compare(&p, &q, 4);
    double sum = 0, right = 0;
    for (uint32_t i = 0; i < 3 * SIZE * SIZE; i++) {
        sum += (double)p.rgb[i];
        right += (double)q.rgb[i];
    }
    print_message("pop: rel_l1 %.4f (noise %.4f), mean %.4f of path's\n", e.rel_l1, e.noise,
                  sum / right);
    assert_within(e.rel_l1, 0.06, NULL);
    assert_within(fabs(sum / right - 1), 5e-3, NULL);
    picture_free(&p);
    picture_free(&q);
    tyn_scene_finish(&scene);
}

// Unscattered light of a sun or a lamp at points: there in the shaft, none beside it.
static void probes(void **state)
{
    gpu_test *t = *state;
    tyn_scene scene;
    make_scene(&scene);
    scene.media[0] = grey_medium(0, sigma_a, 0);
    const float points[2][3] = {{0.65f, 0.4f, 0.5f}, {0.3f, 0.4f, 0.5f}};
    tyn_view view = {
        .width = 1, .height = 1, .outputs = TYN_OUTPUT_PROBE, .points = points, .num_points = 2};
    tyn_camera_frame_scene(&view.camera, &scene);
    tyn_offline *off = NULL;
    assert_int_equal(tyn_offline_create(t->dev, tyn_offline_params(.method = "pop"), &off), TYN_OK);
    offline_frame(off, &scene, &view);
    const tyn_probe_result *r = tyn_offline_output(off, TYN_OUTPUT_PROBE);
    const double way =
        (1 - 0.4) * sqrt((double)(sun[0] * sun[0] + sun[1] * sun[1] + sun[2] * sun[2]));
    print_message("fluence %g in the shaft, %g beside it\n", (double)r[0].fluence[0],
                  (double)r[1].fluence[0]);
    assert_true(fabs((double)r[0].fluence[0] / (3 * exp(-(double)sigma_a * way)) - 1) < 1e-4);
    assert_true(r[1].fluence[0] < 1e-6f);
    // A lamp above the slit instead.
    scene.lights[0] =
        (tyn_light){.kind = TYN_LIGHT_POINT, .color = {2, 2, 2}, .position = {0.5f, 1.5f, 0.5f}};
    const float below[2][3] = {{0.55f, 0.5f, 0.5f}, {0.9f, 0.5f, 0.5f}};
    view.points = below;
    offline_frame(off, &scene, &view);
    r = tyn_offline_output(off, TYN_OUTPUT_PROBE);
    const double r2 = 0.05 * 0.05 + 1,
                 depth = (double)sigma_a * sqrt(r2) / 2; // half the way in the fog
    print_message("of a lamp: %g below the slit, %g beside it\n", (double)r[0].fluence[0],
                  (double)r[1].fluence[0]);
    assert_true(fabs((double)r[0].fluence[0] / (2 / r2 * exp(-depth)) - 1) < 1e-4);
    assert_true(r[1].fluence[0] < 1e-6f);
    tyn_offline_destroy(&off);
    tyn_scene_finish(&scene);
}

// A closed box without thickness in fog under a sun and a lamp, off the planes of the lattice and turned by 30
// degrees: what is inside sees less than 1e-4 of the light outside.
static void sealed(void **state)
{
    gpu_test *t = *state;
    enum { N = 3000 };
    static float points[N][3];
    const float lo[3] = {0.27f, 0.31f, 0.26f}, hi[3] = {0.72f, 0.68f, 0.7f};
    tyn_scene scene;
    tyn_scene_init(&scene);
    const tyn_medium fog = grey_medium(2, 0.1f, 0.5f);
    scene_add_box(&scene, &fog, (float[]){0, 0, 0}, (float[]){1, 1, 1}, NULL, NULL);
    scene_add_sun(&scene, 0.48f, -0.8f, 0.36f, 3, 2, 1);
    scene.lights[scene.num_lights++] = (tyn_light){
        .kind = TYN_LIGHT_POINT, .color = {0.2f, 0.2f, 0.2f}, .position = {0.1f, 0.6f, 0.9f}};
    const uint32_t m = solids_material(&scene, (float[]){0.7f, 0.7f, 0.7f}, (float[3]){0});
    solids_box(&scene, lo, hi, 0.5236f, false, m);
    srand(7);
    for (int i = 0; i < N; i++) {
        for (int a = 0; a < 3; a++) {
            points[i][a] = 0.02f + 0.96f * (float)rand() / (float)RAND_MAX;
        }
    }
    tyn_view view = {.width = 1,
                     .height = 1,
                     .outputs = TYN_OUTPUT_PROBE,
                     .points = (const float(*)[3])points,
                     .num_points = N};
    tyn_camera_frame_scene(&view.camera, &scene);
    tyn_offline *off = NULL;
    assert_int_equal(tyn_offline_create(t->dev, tyn_offline_params(.method = "pop"), &off), TYN_OK);
    offline_frame(off, &scene, &view);
    const tyn_probe_result *r = tyn_offline_output(off, TYN_OUTPUT_PROBE);
    double inside = 0, most = 0, outside = 0;
    uint32_t count[2] = {0};
    for (int i = 0; i < N; i++) {
        const double x = (double)points[i][0] - 0.495, y = (double)points[i][1],
                     z = (double)points[i][2] - 0.48, c = cos(0.5236), n = sin(0.5236);
        const double u = fabs(c * x - n * z) - 0.225, w = fabs(n * x + c * z) - 0.22,
                     v = fabs(y - 0.495) - 0.185;
        const double far = fmax(fmax(u, w), v);
        const double fluence = (double)r[i].fluence[0];
        if (far < -1e-4) {
            inside += fluence;
            most = maximum(most, fluence);
            count[0]++;
        } else if (far > 1e-4) {
            outside += fluence;
            count[1]++;
        }
    }
    inside /= count[0], outside /= count[1];
    print_message("%u points inside, %u outside: mean %g and %g, at most %g inside\n", count[0],
                  count[1], inside, outside, most);
    assert_true(count[0] > 50 && inside < 1e-4 * outside && most < 1e-4 * outside);
    tyn_offline_destroy(&off);
    tyn_scene_finish(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(once_through_a_slit),
        cmocka_unit_test(sparse_rays),
        cmocka_unit_test(all_orders),
        cmocka_unit_test(probes),
        cmocka_unit_test(sealed),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
