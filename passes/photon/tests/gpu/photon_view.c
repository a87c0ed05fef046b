// photon_view.c -- what lobes of light scatter towards the eye, against Henyey-Greenstein's closed form.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "passes/photon/photon_view/photon_view.h"
#include "shaders/common/counters.h"
#include "shaders/common/scene_args.h"
#include <string.h>

enum { SIDE = 4, N = SIDE * SIDE * SIDE, OUT = SIDE + 2 };

static double hg(double g, double mu)
{
    return (1 - g * g) / (4 * M_PI * pow(1 + g * g - 2 * g * mu, 1.5));
}

enum { LOBES = 3 };

// The first lobe about the sun or its net flux, the others about theirs or from all sides alike.
static void lobes(void **state)
{
    gpu_test *t = *state;
    static float light[LOBES * N][4], way[LOBES * N][4];
    for (int i = 0; i < LOBES * N; i++) {
        const float narrow = 0.99f * (float)(i % N) / N, k = 1 + (float)(i / N);
        memcpy(light[i], (float[]){1, 2 * k, 3, 7}, sizeof light[i]);
        memcpy(way[i], (float[]){0.6f * narrow, 0, (i / N == 1 ? 0.8f : -0.8f) * narrow, 0},
               sizeof way[i]);
    }
    struct medium_block medium = {.extent = {1, 1, 1}, .size = {1, 1, 1}, .max_density = 1};
    static const float g[3] = {0.85f, 0.5f, -0.3f}, one = 1;
    for (int c = 0; c < 3; c++) {
        medium.phase[c].g = g[c];
        medium.sigma_s[c] = 1;
    }
    const struct camera_block camera = {.orthographic = 1, .forward = {0, 0.28f, -0.96f}};
    static const float axis[3] = {0.36f, -0.48f, 0.8f}, eye[3] = {0, -0.28f, 0.96f};
    for (int kind = 0; kind < 8; kind++) {
        tyn_photon_view_params params;
        tyn_pass_defaults(&tyn_pass_photon_view, &params);
        memcpy(params.axis, axis, sizeof params.axis);
        params.lobes = LOBES;
        params.has_sun = 1;
        params.sun = kind & 1;
        params.sky = kind >> 1 & 1;
        params.scaled = kind >> 2;
        const tyn_extent size = {SIDE, SIDE, LOBES * SIDE};
        tyn_ref refs[TYN_MAX_PORTS] = {{0}};
        tyn_graph_begin(t->graph);
        refs[PHOTON_VIEW_PORT_MEDIUM] = gpu_buffer(t, "medium", &medium, sizeof medium);
        refs[PHOTON_VIEW_PORT_DENSITY] =
            gpu_image(t, "density", TYN_IMAGE_3D, (tyn_extent){1, 1, 1}, 1, &one);
        refs[PHOTON_VIEW_PORT_CAMERA] = gpu_buffer(t, "camera", &camera, sizeof camera);
        refs[PHOTON_VIEW_PORT_FLUENCE] = gpu_image(t, "light", TYN_IMAGE_3D, size, 4, light[0]);
        refs[PHOTON_VIEW_PORT_WAY] = gpu_image(t, "way", TYN_IMAGE_3D, size, 4, way[0]);
        assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_photon_view, &params, refs), TYN_OK);
        tyn_graph_output(t->graph, "inscatter", refs[PHOTON_VIEW_PORT_INSCATTER], true);
        tyn_graph_output(t->graph, "counters", refs[PHOTON_VIEW_PORT_COUNTERS], true);
        gpu_run(t);
        assert_int_equal(gpu_non_finite(t), 0);
        const float(*found)[4] = (const float(*)[4])gpu_map(t, "inscatter");
        double worst = 0;
        for (int i = 0; i < OUT * OUT * OUT; i++) { // outermost cells again around
            int at[3] = {i % OUT, i / OUT % OUT, i / OUT / OUT};
            for (int a = 0; a < 3; a++) {
                at[a] = at[a] < 1 ? 0 : at[a] > SIDE ? SIDE - 1 : at[a] - 1;
            }
            for (int c = 0; c < 3; c++) {
                const double own = (double)g[c],
                             mean = params.scaled ? own / (1 + fmax(own, 0)) : own;
                double expected = 0;
                for (int lobe = 0; lobe < LOBES; lobe++) {
                    const int cell = ((lobe * SIDE + at[2]) * SIDE + at[1]) * SIDE + at[0];
                    double about[3] = {0, 0, 0}; // towards the eye: flux; sun
                    for (int a = 0; a < 3; a++) {
                        about[0] += (double)(way[cell][a] * eye[a]);
                        about[1] += (double)(axis[a] * eye[a]);
                        about[2] += (double)(way[cell][a] * axis[a]);
                    }
                    const double narrow = hypot((double)way[cell][0], (double)way[cell][2]);
                    double shape = narrow > 0 ? hg(mean * narrow, about[0] / narrow) : 0.25 / M_PI;
                    if (lobe == 0 && !params.sun) {
                        shape = hg(mean * about[2], about[1]);
                    } else if (lobe > 0 && !params.sky) {
                        shape = 0.25 / M_PI;
                    }
                    expected += (double)light[cell][c] * shape;
                }
                worst = maximum(worst, fabs((double)found[i][c] / expected - 1));
            }
        }
        assert_true(worst < 2e-5);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(lobes)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
