// pop_furnace.c -- surroundings of radiance 1 and no absorption: every pixel of `pop` is 1, for any density
// and anisotropy. The mean of the environment enters at the lattice's boundary.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "picture.h"
#include "sky.h"
#include "todo.h"
#include <math.h>
#include <stdlib.h>

enum { N = 24 };

// Lumps from 0 to about 2.
static float *lumps(void)
{
    float *grid = malloc(N * N * N * sizeof *grid);
    for (int i = 0; i < N * N * N; i++) {
        double x = i % N / (double)N, y = i / N % N / (double)N, z = i / N / N / (double)N;
        double v = 1 + sin(11 * x + 5 * y) * sin(9 * y - 4 * z) + 0.5 * sin(23 * z + 7 * x);
        grid[i] = v > 0.3 ? (float)v : 0; // with hard edges
    }
    return grid;
}

static void furnace(void **state)
{
    gpu_test *t = *state;
    static const float gs[] = {0, 0.5f, 0.9f}, sigmas[] = {0.1f, 4, 60};
    float *grid = lumps();
    for (int k = 0; k < 18; k++) {
        float g = gs[k % 3], sigma = sigmas[k / 3 % 3];
        bool lumpy = k >= 9;
        tyn_scene *scene = malloc(sizeof *scene);
        tyn_scene_init(scene);
        tyn_medium medium = grey_medium(sigma, 0, g);
        scene_add_box(scene, &medium, (float[]){0, 0, 0}, (float[]){1, 1, 1}, (uint32_t[]){N, N, N},
                      lumpy ? grid : NULL);
        scene_set_sky(scene, 1);
        tyn_view view = {0};
        view_orthographic(&view, (float[]){0.5f, 0.5f, 0.5f}, -1, -2, -0.7f, (float[]){0, 1, 0},
                          0.9f, 48);
        if (k % 2) { // from inside, perspective
            view.camera.projection = TYN_PERSPECTIVE;
            view.camera.yfov = 1.2f;
            view.camera.position[0] = 0.8f;
            view.camera.position[1] = 0.9f;
            view.camera.position[2] = 0.7f;
        }
        picture p;
        picture_render(&p, t->dev, "pop", scene, &view, NULL, 0);
        double worst = 0;
        for (int i = 0; i < 48 * 48 * 3; i++) {
            worst = maximum(worst, fabs(p.rgb[i] - 1.0));
        }
        print_message("%s, sigma_s %4.1f, g %.1f: worst pixel %.3f %% from 1\n",
                      lumpy ? "lumps" : "cube ", (double)sigma, (double)g, 100 * worst);
        assert_true(worst <= 5e-5);
        picture_free(&p);
        tyn_scene_finish(scene);
        free(scene);
    }
    free(grid);
}

// Voxels of density 0 and 10^4 in turn: every cell is far thicker than a mean free path and half empty.
static void checkerboard(void **state)
{
    gpu_test *t = *state;
    static const float gs[] = {0, 0.5f, 0.9f};
    float *grid = malloc(N * N * N * sizeof *grid);
    for (int i = 0; i < N * N * N; i++) {
        grid[i] = (i % N + i / N % N + i / N / N) % 2 ? 1e4f : 0;
    }
    for (int k = 0; k < 6; k++) {
        const float g = gs[k % 3];
        const bool inside = k >= 3;
        tyn_scene *scene = malloc(sizeof *scene);
        tyn_scene_init(scene);
        tyn_medium medium = grey_medium(1, 0, g);
        scene_add_box(scene, &medium, (float[]){0, 0, 0}, (float[]){1, 1, 1}, (uint32_t[]){N, N, N},
                      grid);
        scene_set_sky(scene, 1);
        tyn_view view = {0};
        view_orthographic(&view, (float[]){0.5f, 0.5f, 0.5f}, -1, -2, -0.7f, (float[]){0, 1, 0},
                          0.9f, 48);
        if (inside) {
            view.camera.projection = TYN_PERSPECTIVE;
            view.camera.yfov = 1.2f;
            view.camera.position[0] = 0.8f;
            view.camera.position[1] = 0.9f;
            view.camera.position[2] = 0.7f;
        }
        picture p;
        picture_render(&p, t->dev, "pop", scene, &view, NULL, 0);
        double worst = 0;
        for (int i = 0; i < 48 * 48 * 3; i++) {
            worst = maximum(worst, fabs(p.rgb[i] - 1.0));
        }
        print_message("checkerboard of 0 and 10^4 per metre, g %.1f, from %s: worst pixel %.3f %% "
                      "from 1\n",
                      (double)g, inside ? "inside" : "outside", 100 * worst);
        assert_within(worst, 0.005, NULL);
        picture_free(&p);
        tyn_scene_finish(scene);
        free(scene);
    }
    free(grid);
}

// The same surroundings as a map, in which every texel is 1: what finds its suns, smears it and divides it
// into ordinates has to leave it as it is, whatever its size and wherever it is turned.
static void maps(void **state)
{
    gpu_test *t = *state;
    static const uint32_t sizes[][2] = {{16, 8}, {64, 3}, {37, 18}, {1024, 512}};
    static const float gs[] = {0, 0.5f, 0.9f, 0.95f}, sigmas[] = {0.1f, 4, 60};
    float *grid = lumps();
    for (int k = 0; k < 12; k++) {
        float g = gs[k % 4], sigma = sigmas[k % 3];
        bool lumpy = k % 2;
        tyn_scene *scene = malloc(sizeof *scene);
        tyn_scene_init(scene);
        tyn_medium medium = grey_medium(sigma, 0, g);
        scene_add_box(scene, &medium, (float[]){0, 0, 0}, (float[]){1, 1, 1}, (uint32_t[]){N, N, N},
                      lumpy ? grid : NULL);
        const uint32_t *size = sizes[k / 3];
        sky_constant_map(&scene->environment, size[0], size[1], 1);
        if (k % 3) {
            sky_turn(&scene->environment, 1, -2, 0.5f, (float)k);
        }
        tyn_view view = {0};
        view_orthographic(&view, (float[]){0.5f, 0.5f, 0.5f}, -1, -2, -0.7f, (float[]){0, 1, 0},
                          0.9f, 48);
        picture p;
        picture_render(&p, t->dev, "pop", scene, &view, NULL, 0);
        double worst = 0;
        for (int i = 0; i < 48 * 48 * 3; i++) {
            worst = maximum(worst, fabs(p.rgb[i] - 1.0));
        }
        print_message("%s, sigma_s %4.1f, g %.2f, map of %ux%u: worst pixel %.3f %% from 1\n",
                      lumpy ? "lumps" : "cube ", (double)sigma, (double)g, size[0], size[1],
                      100 * worst);
        assert_true(worst <= 5e-5);
        picture_free(&p);
        tyn_scene_finish(scene);
        free(scene);
    }
    free(grid);
}

// A map of 1, then a constant, all of its light along ordinates (ordinates.split=0): rays from
// fourteen directions and one in each of 64 regions are not all there is, but nearly. Only with the
// mean split off is it exact.
static void unsplit(void **state)
{
    gpu_test *t = *state;
    // Cells of 1/32 m are up to 1.9 mean free paths (delta scaled) thick; lumps are up to 2.5 dense.
    static const float media[][2] = {{0.1f, 0},  {4, 0},      {4, 0.5f}, {20, 0},
                                     {20, 0.9f}, {20, 0.95f}, {60, 0},   {60, 0.9f}};
    enum { MEDIA = sizeof media / sizeof media[0] };
    bool good = true;
    float *grid = lumps();
    for (int k = 0; k < 4 * MEDIA; k++) {
        const float *m = media[k % MEDIA];
        const bool lumpy = k / MEDIA % 2, map = k / MEDIA < 2;
        const bool thick = m[0] == 60 && m[1] == 0;
        tyn_scene *scene = malloc(sizeof *scene);
        tyn_scene_init(scene);
        tyn_medium medium = grey_medium(m[0] / (lumpy ? 2.5f : 1), 0, m[1]);
        scene_add_box(scene, &medium, (float[]){0, 0, 0}, (float[]){1, 1, 1}, (uint32_t[]){N, N, N},
                      lumpy ? grid : NULL);
        if (map) {
            sky_constant_map(&scene->environment, 32, 16, 1);
        } else {
            scene_set_sky(scene, 1);
        }
        tyn_view view = {0};
        view_orthographic(&view, (float[]){0.5f, 0.5f, 0.5f}, -1, -2, -0.7f, (float[]){0, 1, 0},
                          0.9f, 48);
        picture p;
        picture_render(&p, t->dev, "pop", scene, &view, "ordinates.split=0", 0);
        double worst = 0, mean = 0;
        for (int i = 0; i < 48 * 48 * 3; i++) {
            worst = maximum(worst, fabs(p.rgb[i] - 1.0));
            mean += p.rgb[i] / (48 * 48 * 3);
        }
        print_message("%s, sigma_s %4.1f, g %.2f, %s, without the split: mean %+.2f %%, worst "
                      "pixel %.2f %%\n",
                      lumpy ? "lumps" : "cube ", (double)medium.sigma_s[0], (double)m[1],
                      map ? "map" : "constant", 100 * (mean - 1), 100 * worst);
        const char *name = thick ? "unsplit, thick cells" : "unsplit";
        const bool near = within(worst, 0.07, NULL, "%s, worst", name);
        const bool even = within(fabs(mean - 1), 0.01, NULL, "%s, mean", name);
        good = todo_if(thick, near && even,
                       "light of ordinates is followed from cell to cell: thick cells blur it",
                       "%s, sigma_s %g, %s, within 7 %%, and 1 %% in the mean",
                       lumpy ? "lumps" : "cube", (double)medium.sigma_s[0],
                       map ? "map" : "constant") &&
               good;
        picture_free(&p);
        tyn_scene_finish(scene);
        free(scene);
    }
    free(grid);
    assert_true(good);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(unsplit), cmocka_unit_test(furnace),
                                       cmocka_unit_test(checkerboard), cmocka_unit_test(maps)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
