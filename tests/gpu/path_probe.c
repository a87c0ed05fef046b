// path_probe.c -- the path tracer's light field at points, against closed forms.
#include "path_scene.h"
#include <math.h>

// In vacuum a probe sees irradiance and nothing else, exactly.
static void probes_in_vacuum(void **state)
{
    path_scene s;
    path_scene_cube(&s, 0, 0, 0, false);
    path_scene_sun(&s, (float[]){0, 0, -1}, (float[]){2, 2, 2});
    const float points[2][3] = {{0.5f, 0.5f, 0.5f}, {0.9f, 0.5f, 0.5f}};
    const tyn_probe_result *p = path_scene_probe(*state, &s, points, 2, 16);
    path_scene_check("sun", p[0].fluence[0], 0, 2);
    path_scene_check("sun, flux along z", p[0].flux[6], 0, -2);

    path_scene_cube(&s, 0, 0, 0, false);
    path_scene_lamp(&s, (float[]){0.5f, 0.5f, 2.5f}, (float[]){4, 8, 12});
    s.lights[0].kind = TYN_LIGHT_KIND_SPOT;
    s.lights[0].direction[2] = -1;
    s.lights[0].cos_inner = 0.999f;
    s.lights[0].cos_outer = 0.97f;
    p = path_scene_probe(*state, &s, points, 2, 16);
    double r2 = 4 + 0.16, c = 2 / sqrt(r2), a = (c - 0.97) / (0.999 - 0.97);
    path_scene_check("spot, axis", p[0].fluence[2], 0, 3);
    // A cosine, which has a root, less the outer one: twice, by the penumbra's width.
    const double off = 2 * gpu_ulps(*state, GPU_ROOT + GPU_QUOTIENT) / (c - 0.97) * 8 / r2 * a * a;
    path_scene_check("spot, penumbra", p[1].fluence[1], off, 8 / r2 * a * a);
    path_scene_check("spot, flux along x", p[1].flux[1], off, 8 / r2 * a * a * 0.4 / sqrt(r2));
    // Sixteen samples that may each be off as the mean may (path_scene_check): rounding differs among invocations.
    const double spread = 3.5 * off / sqrt(15);
    assert_true((double)p[1].fluence_se[1] <= 1e-6 * (double)p[1].fluence[1] + spread);
}

// Light that an absorbing cube leaves of a sun, and of a sky without any medium.
static void absorption(void **state)
{
    path_scene s;
    path_scene_cube(&s, 0, 2, 0, true);
    path_scene_sun(&s, (float[]){1, 0, 0}, (float[]){1, 2, 3});
    const float points[2][3] = {{0.25f, 0.5f, 0.5f}, {0.9f, 0.1f, 0.7f}};
    const tyn_probe_result *p = path_scene_probe(*state, &s, points, 2, 4096);
    for (int i = 0; i < 2; i++) {
        for (int c = 0; c < 3; c++) {
            const double right = (c + 1) * exp(-2 * (double)points[i][0]);
            path_scene_check("fluence", p[i].fluence[c], p[i].fluence_se[c], right);
            path_scene_check("flux along x", p[i].flux[c], p[i].flux_se[c], right);
        }
    }
    path_scene_cube(&s, 0, 0, 0, false);
    path_scene_sky(&s, 0.5f);
    p = path_scene_probe(*state, &s, points, 2, 4096);
    path_scene_check("sky", p[0].fluence[1], p[0].fluence_se[1], 2 * M_PI);
    path_scene_check("sky, flux", p[0].flux[4], p[0].flux_se[4], 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(probes_in_vacuum),
                                       cmocka_unit_test(absorption)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
