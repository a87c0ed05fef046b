// raymarch.c -- the ray march against closed forms.
#include "raymarch_stage.h"
#include "shaders/common/counters.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

// What a transmittance of 1, an exponential of 0, is off by.
static double of_nothing(const gpu_test *t)
{
    return gpu_ulps(t, GPU_EXP(0.0));
}

// Light along +x through the unit cube; views from the side, against the light and with it.
static void single_scattering(void **state)
{
    gpu_test *t = *state;
    march_scene *s = malloc(sizeof *s);
    const float gs[] = {-0.5f, 0, 0.5f, 0.9f};
    for (int k = 0; k < 4; k++) {
        const double g = gs[k], sigma = 4;
        for (int colour = 0; colour < 2; colour++) {
            march_cube(s, 4, 0, gs[k]);
            s->params.grey = !colour;
            march_sun(s, 1, 0, 0);
            march_camera(s, 0, -1, 0, 3);
            march_run(t, s);
            // Pixels of the side view run along -x, as right = forward x up.
            const float *p = march_pixel(t, s, "radiance", 3, 7);
            double x = 1 - 3.5 / 16;
            march_close(p[0], sigma * march_hg(g, 0) * exp(-sigma * x) * (1 - exp(-sigma)) / sigma,
                        1e-5, "side");
            march_close(p[3], 1 - exp(-sigma), 1e-5, "alpha");
            march_camera(s, -1, 0, 0, 3);
            march_run(t, s);
            march_close(march_pixel(t, s, "radiance", 5, 5)[1],
                        sigma * march_hg(g, 1) * exp(-sigma), 2e-3, "against the light");
            march_camera(s, 1, 0, 0, 3);
            march_run(t, s);
            march_close(march_pixel(t, s, "radiance", 5, 5)[2],
                        sigma * march_hg(g, -1) * (1 - exp(-2 * sigma)) / (2 * sigma), 2e-3,
                        "with the light");
        }
    }
    free(s);
}

// Uniform surroundings of radiance 1 and no absorption: every pixel is 1, at any depth and g.
static void furnace(void **state)
{
    gpu_test *t = *state;
    march_scene *s = malloc(sizeof *s);
    const float sigmas[] = {1e-4f, 0.1f, 4, 300};
    for (int k = 0; k < 8; k++) {
        march_cube(s, sigmas[k / 2], 0, k % 2 ? 0.9f : 0.0f);
        s->params.num_suns = 0;
        s->params.mean = s->params.background = 1;
        s->params.layers = RAYMARCH_LAYER_TRANSMITTANCE | RAYMARCH_LAYER_MULTIPLE;
        for (int i = 0; i < 3; i++) {
            s->env.radiance[i] = s->env.sky[i] = 1;
        }
        for (int i = 0; i < 27 * 4; i++) {
            s->inscatter.texels[i] = 1;
        }
        march_camera(s, 0.3f, 0.5f, -0.6f, 3);
        s->camera.half_width = s->camera.half_height = 0.9f;
        march_run(t, s);
        for (uint32_t i = 0; i < 16 * 16; i++) {
            const float *p = march_pixel(t, s, "radiance", i % 16, i / 16);
            march_close(p[0], 1, 2e-4, "furnace");
            march_close(p[3], 1, 0, "alpha");
            double behind = march_pixel(t, s, "transmittance", i % 16, i / 16)[0];
            march_close(march_pixel(t, s, "multiple", i % 16, i / 16)[0] + behind, 1, 2e-4,
                        "multiple + background");
        }
    }
    free(s);
}

// The tail behind transmittance 1e-3 is not lost, and what is behind the medium is attenuated to
// the end.
static void opaque(void **state)
{
    gpu_test *t = *state;
    march_scene *s = malloc(sizeof *s);
    march_cube(s, 0, 9, 0);
    s->params.num_suns = 0;
    s->params.emissive = 1;
    s->params.stop = 0.1f;
    s->medium.emission[0] = s->medium.emission[1] = s->medium.emission[2] = 9;
    march_camera(s, 0, 1, 0, 3);
    s->params.layers = RAYMARCH_LAYER_TRANSMITTANCE;
    march_run(t, s);
    march_close(march_pixel(t, s, "radiance", 8, 8)[0], 1, 2e-3, "emission");
    march_close(march_pixel(t, s, "transmittance", 8, 8)[0], exp(-9), 1e-4, "transmittance");
    free(s);
}

// Where one channel is much denser than another, that one is still seen through.
static void opaque_in_one_colour(void **state)
{
    gpu_test *t = *state;
    march_scene *s = malloc(sizeof *s);
    static const float dense[] = {2, 5, 20};
    for (int i = 0; i < 3; i++) {
        march_cube(s, 0, 11, 0);
        s->params.num_suns = s->params.grey = 0;
        s->medium.sigma_a[1] = s->medium.sigma_a[2] = 11 * dense[i];
        s->medium.sigma_t_max = 11 * dense[i];
        march_camera(s, 0, 1, 0, 3);
        s->params.layers = RAYMARCH_LAYER_TRANSMITTANCE;
        march_run(t, s);
        march_close(march_pixel(t, s, "transmittance", 8, 8)[0], exp(-11), 1e-3, "transmittance");
    }
    free(s);
}

// The left half of the image has a surface in the middle of the box: what it sends is seen through the
// medium in front of it, and with what that scatters forward; no light comes from behind it.
static void surfaces(void **state)
{
    gpu_test *t = *state;
    march_scene *s = malloc(sizeof *s);
    const double sigma_s = 1.5, sigma_a = 0.5, g = 0.6;
    march_cube(s, (float)sigma_s, (float)sigma_a, (float)g);
    march_camera(s, 0, 1, 0, 2); // the box is from 1.5 to 2.5
    s->params.num_suns = 0;
    s->params.layers = RAYMARCH_LAYER_TRANSMITTANCE | RAYMARCH_LAYER_DEPTH;
    s->params.surfaces = 1;
    s->camera.half_width = s->camera.half_height = 0.8f; // the outermost pixels miss the box
    tyn_raymarch_window(&s->params, &s->camera);
    float surface[16 * 16][4] = {{0}};
    for (int i = 0; i < 256; i++) {
        surface[i][1] = 3;
        surface[i][3] = i % 16 < 8 ? 2.0f : INFINITY;
    }
    s->surface = surface[0];
    double forward = g * g * sigma_s, seen = 3 * exp(-0.5 * (sigma_s + sigma_a - forward));
    for (int background = 0; background < 2; background++) {
        s->params.background = (uint32_t)background;
        s->env.radiance[0] = 7;
        march_run(t, s);
        const float *p = march_pixel(t, s, "radiance", 5, 8);
        assert_true(p[0] == 0 && p[2] == 0 && fabs((double)p[3] - 1) <= of_nothing(t));
        march_close(p[1], seen, 1e-4, "through half the box");
        march_close(march_pixel(t, s, "transmittance", 5, 8)[1], exp(-0.5 * 2), 1e-4,
                    "half the box");
        const double off_depth = 2 * gpu_ulps(t, GPU_ROOT); // a distance is a root
        assert_true(fabs((double)march_pixel(t, s, "depth", 5, 8)[0] - 2) <= off_depth);
        p = march_pixel(t, s, "radiance", 1, 1);
        assert_true(p[0] == 0 && fabs((double)p[1] - 3) <= 3 * of_nothing(t) &&
                    fabs((double)p[3] - 1) <= of_nothing(t) &&
                    fabs((double)march_pixel(t, s, "depth", 1, 1)[0] - 2) <= off_depth);
        p = march_pixel(t, s, "radiance", 9, 8);
        march_close(p[0], background ? 7 * exp(-2) : 0, 1e-4, "environment");
        march_close(p[3], background ? 1 : 1 - exp(-2), 1e-4, "cover");
        assert_true(isinf(march_pixel(t, s, "depth", 9, 8)[0]));
    }
    s->params.background = s->params.surfaces = 0;
    march_run(t, s);
    const float *p = march_pixel(t, s, "radiance", 5, 8);
    march_close(p[1], seen - 3 * exp(-0.5 * 2), 1e-4, "scattered forward alone");
    march_close(p[3], 1 - exp(-0.5 * 2), 1e-4, "cover of the medium");
    p = march_pixel(t, s, "radiance", 1, 1);
    assert_true(fabs((double)p[1]) <= 3 * of_nothing(t) && fabs((double)p[3]) <= of_nothing(t));
    free(s);
}

static void host_depth(void **state)
{
    gpu_test *t = *state;
    march_scene *s = malloc(sizeof *s);
    march_cube(s, 2, 0, 0);
    march_sun(s, 0, 0, -1);
    march_camera(s, 0, 1, 0, 2); // the box is from 1.5 to 2.5
    s->camera.orthographic = 0;
    s->params.layers = RAYMARCH_LAYER_TRANSMITTANCE | RAYMARCH_LAYER_DEPTH;
    s->params.background = 1;
    s->env.radiance[0] = 100;
    // A reversed infinite projection: depth = near / distance.
    float depth[16 * 16], view_to_clip[4] = {0, 0.1f, -1, 0};
    for (int i = 0; i < 256; i++) {
        depth[i] = i % 16 < 8 ? 0.1f / 2.0f : 0;
    }
    s->host_depth = depth;
    memcpy(s->params.depth, view_to_clip, sizeof view_to_clip);
    march_run(t, s);
    // Pixel (7, 7) looks nearly straight ahead.
    double l = sqrt(1 + 2 * pow(0.5 / 16, 2));
    march_close(march_pixel(t, s, "depth", 7, 7)[0], 2 * l, 1e-5, "surface");
    march_close(march_pixel(t, s, "transmittance", 7, 7)[0], exp(-2 * 0.5 * l), 1e-4,
                "half the box");
    assert_true(march_pixel(t, s, "radiance", 7, 7)[0] < 2); // the environment is hidden
    march_close(march_pixel(t, s, "transmittance", 8, 8)[0], exp(-2 * l), 1e-4, "the whole box");
    assert_true(isinf(march_pixel(t, s, "depth", 8, 8)[0]));
    assert_true(march_pixel(t, s, "radiance", 8, 8)[0] > 10);
    free(s);
}

// A sphere in the box: pixels on its outline are averaged over four rays.
static void antialias(void **state)
{
    gpu_test *t = *state;
    march_scene *s = malloc(sizeof *s);
    march_cube(s, 2, 0, 0);
    s->shape.kind = s->params.kind = TYN_SHAPE_KIND_SPHERE;
    march_sun(s, 1, 0, 0);
    march_camera(s, 0.1f, 1, 0.2f, 3);
    march_run(t, s);
    uint32_t four = ((const struct counters_block *)gpu_map(t, "counters"))->steps;
    s->params.antialias = 0;
    march_run(t, s);
    uint32_t one = ((const struct counters_block *)gpu_map(t, "counters"))->steps;
    print_message("steps with one ray a pixel: %u, with four at the outline: %u\n", one, four);
    // The outline of a circle of 16 pixels' diameter passes between the quarters of about 30 pixels.
    assert_true(four > one * 1.2 && four < one * 1.6);
    free(s);
}

static void nothing(void **state)
{
    gpu_test *t = *state;
    march_scene *s = calloc(1, sizeof *s);
    march_cube(s, 0, 0, 0);
    march_camera(s, 0, 1, 0, 3);
    s->env.radiance[2] = 0.5f;
    s->params.num_suns = 0;
    s->params.background = 1;
    for (int i = 0; i < 3; i++) {
        s->medium.extent[i] = 0;
    }
    tyn_graph_begin(t->graph);
    tyn_ref refs[TYN_MAX_PORTS] = {
        [RAYMARCH_PORT_MEDIUM] = gpu_buffer(t, "medium", &s->medium, sizeof s->medium),
        [RAYMARCH_PORT_SHAPES] = gpu_buffer(t, "shapes", &s->shape, sizeof s->shape),
        [RAYMARCH_PORT_LIGHTS] = gpu_buffer(t, "lights", &s->light, sizeof s->light),
        [RAYMARCH_PORT_CAMERA] = gpu_buffer(t, "camera", &s->camera, sizeof s->camera),
        [RAYMARCH_PORT_ENVIRONMENT] = gpu_buffer(t, "environment", &s->env, sizeof s->env),
    };
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_raymarch, &s->params, refs), TYN_OK);
    tyn_graph_output(t->graph, "radiance", refs[RAYMARCH_PORT_RADIANCE], true);
    gpu_run(t);
    for (uint32_t i = 0; i < 256; i++) {
        const float *p = march_pixel(t, s, "radiance", i % 16, i / 16);
        assert_true(p[0] == 0 && fabs((double)p[2] - 0.5) <= 0.5 * of_nothing(t) &&
                    fabs((double)p[3] - 1) <= of_nothing(t));
    }
    free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(single_scattering),
        cmocka_unit_test(furnace),
        cmocka_unit_test(opaque),
        cmocka_unit_test(surfaces),
        cmocka_unit_test(host_depth),
        cmocka_unit_test(opaque_in_one_colour),
        cmocka_unit_test(antialias),
        cmocka_unit_test(nothing),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
