// raymarch_sparse.c -- the ray march at a lower resolution against a ray in every pixel.
#include "raymarch_stage.h"
#include "bound.h"
#include "numbers.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

// A host's depth image with a slanting floor, holes and a comb of single pixels, of which one ray for four pixels sees little: the
// march at a lower resolution ends at the same depths, and shows what is behind where nothing is.
static void host_depth_sparse(void **state)
{
    enum { SIZE = 64, N = SIZE * SIZE };
    gpu_test *t = *state;
    march_scene *s = malloc(sizeof *s);
    static float depth[N], all[N][4], parted[N][4];
    for (int i = 0; i < N; i++) {
        const int x = i % SIZE, y = i / SIZE;
        const float away = 1.6f + 0.8f * (float)y / SIZE; // from the front of the box to its back
        const bool hole = x / 16 % 2 && y / 16 % 2, comb = y > 48 && x % 5 == 0;
        depth[i] = hole || comb ? 0 : 0.1f / away;
    }
    for (int i = 0; i < 3; i++) { // every pixel; at a lower resolution by two kernels; by one
        march_cube(s, 2, 0.5f, 0.4f);
        march_sun(s, 0.3f, 0.5f, -1);
        march_camera(s, 0, 1, 0, 2); // the box is from 1.5 to 2.5
        s->camera.orthographic = 0;
        s->camera.size[0] = s->camera.size[1] = s->params.width = s->params.height = SIZE;
        s->params.background = 1;
        s->params.sparse = i > 0;
        s->params.parted = i == 1;
        s->env.radiance[0] = 3;
        s->host_depth = depth;
        memcpy(s->params.depth, (float[]){0, 0.1f, -1, 0}, sizeof s->params.depth);
        march_run(t, s);
        if (i < 2) {
            memcpy(i ? parted : all, march_pixel(t, s, "radiance", 0, 0), sizeof all);
        }
    }
    assert_memory_equal(parted, march_pixel(t, s, "radiance", 0, 0), sizeof parted);
    const float(*found)[4] = (const float(*)[4])march_pixel(t, s, "radiance", 0, 0);
    double sum = 0, apart = 0, worst = 0;
    int differ = 0;
    for (int i = 0; i < N; i++) {
        const double off = fabs((double)found[i][0] - (double)all[i][0]);
        sum += (double)all[i][0];
        apart += off;
        worst = maximum(worst, off / ((double)all[i][0] + 0.01));
        differ += off > 0;
    }
    print_message("under a host's depth %.3f %% off, a pixel at most %.2f %%; %d of %d differ\n",
                  100 * apart / sum, 100 * worst, differ, N);
    assert_within(apart / sum, 0.0009, NULL);
    // Most where rays through a hole leave by the box's rim.
    assert_within(worst, 0.2, NULL);
    assert_true(differ > N / 30); // else nothing was saved
    free(s);
}

// Light of first and of higher orders at a lower resolution, where it may be, against a ray in every pixel.
static void layers_sparse(void **state)
{
    enum { SIZE = 64, N = SIZE * SIZE };
    gpu_test *t = *state;
    march_scene *s = malloc(sizeof *s);
    static const char *const names[] = {"radiance", "single", "multiple"};
    static const double bounds[] = {0.004, 0.012, 0.003};
    static float all[3][N][4];
    for (uint32_t sparse = 0; sparse < 2; sparse++) {
        march_cube(s, 2, 0.5f, 0.4f);
        march_sun(s, 0.3f, 0.5f, -1);
        march_camera(s, 0.2f, 1, 0.1f, 2);
        s->camera.orthographic = 0;
        s->camera.size[0] = s->camera.size[1] = s->params.width = s->params.height = SIZE;
        s->params.layers = RAYMARCH_LAYER_SINGLE | RAYMARCH_LAYER_MULTIPLE;
        s->params.sparse = 1;
        s->params.sparse_layers = sparse;
        for (int i = 0; i < 4 * 27; i++) {
            s->inscatter.texels[i] = 0.25f;
        }
        march_run(t, s);
        for (int k = 0; k < 3 && !sparse; k++) {
            memcpy(all[k], march_pixel(t, s, names[k], 0, 0), sizeof all[k]);
        }
    }
    for (int k = 0; k < 3; k++) {
        const float(*found)[4] = (const float(*)[4])march_pixel(t, s, names[k], 0, 0);
        double sum = 0, apart = 0;
        int differ = 0;
        for (int i = 0; i < N; i++) {
            sum += (double)all[k][i][0];
            apart += fabs((double)found[i][0] - (double)all[k][i][0]);
            differ += found[i][0] != all[k][i][0];
        }
        print_message("%s at a lower resolution %.3f %% off; %d of %d differ\n", names[k],
                      100 * apart / sum, differ, N);
        assert_within(apart / sum, bounds[k], NULL);
        assert_true(differ > N / 30); // else nothing was saved
    }
    free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(host_depth_sparse),
        cmocka_unit_test(layers_sparse),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
