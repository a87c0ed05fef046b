// residuum.c -- merge of what is left in the aligned grids by power, its isotropic propagation against a
// CPU twin, and the iteration at which the paper switches.
#include "bound.h"
#include "gpu_test.h"
#include "passes/pop_paper/propagate_rect/propagate_rect.h"
#include "passes/pop_paper/residuum/residuum.h"
#include "shaders/light/ordinate_args.h"
#include "shaders/common/scene_args.h"
#include "numbers.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CELLS = 16, ORDINATES = 7, R = 24, RX = 24, RY = 18, RZ = 12, TOTAL = RX * RY * RZ };

static const struct medium_block medium = {
    .extent = {2, 1.5f, 1},
    .size = {16, 12, 8},
    .num_shapes = 1,
    .voxel = {0.125f, 0.125f, 0.125f},
    .max_density = 1,
    .sigma_s = {3, 5, 8},
    .sigma_a = {0, 0.2f, 1},
    .phase = {{.g = 0.5f}, {.g = 0.5f}, {.g = 0.5f}},
};
static float density[16 * 12 * 8];

// What two passes leave: light in the aligned grids (tiles), light in the merged one, sent to the eye.
typedef struct outcome {
    const struct propagate_grid *grids;
    const float *light;
    const float *state;
    const float *residuum;
    tyn_extent tiled;
} outcome;

static struct ordinates_block directions(void)
{
    struct ordinates_block block = {.count = ORDINATES};
    for (uint32_t n = 0; n < ORDINATES; n++) {
        struct ordinate *o = &block.list[n];
        double z = 1 - (2 * n + 1.0) / ORDINATES, r = sqrt(1 - z * z), phi = 2.399963 * n;
        o->direction[0] = (float)(r * cos(phi));
        o->direction[1] = (float)(r * sin(phi));
        o->direction[2] = (float)z;
        o->solid_angle = 12.566371f / ORDINATES;
        o->mean_cosine = 1 - 1.0f / ORDINATES;
        for (uint32_t c = 0; c < 3; c++) {
            o->irradiance[c] = (float)(1 + (n + c) % 3);
        }
    }
    return block;
}

// `along`: cells of the aligned grids along the light, 0 = cubes.
static outcome run(gpu_test *t, int32_t before, int32_t iterations, int32_t along)
{
    const struct ordinates_block list = directions();
    const struct camera_block camera = {.orthographic = 1, .forward = {0, 0, -1}};
    tyn_graph_begin(t->graph);
    tyn_ref block = gpu_buffer(t, "medium", &medium, sizeof medium);
    tyn_ref image = gpu_image(t, "density", TYN_IMAGE_3D, (tyn_extent){16, 12, 8}, 1, density);

    tyn_propagate_rect_params p;
    tyn_pass_defaults(&tyn_pass_propagate_rect, &p);
    p.cells = CELLS;
    p.cells_along = along;
    p.iterations = before;
    p.channels = 3;
    p.num_ordinates = ORDINATES;
    p.keep_light = 1;
    memcpy(p.extent, medium.extent, sizeof p.extent);
    memcpy(p.size, medium.size, sizeof p.size);
    tyn_ref a[PROPAGATE_RECT_NUM_PORTS] = {
        [PROPAGATE_RECT_PORT_MEDIUM] = block,
        [PROPAGATE_RECT_PORT_ORDINATES] = gpu_buffer(t, "ordinates", &list, sizeof list),
        [PROPAGATE_RECT_PORT_CAMERA] = gpu_buffer(t, "camera", &camera, sizeof camera),
        [PROPAGATE_RECT_PORT_DENSITY] = image};
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_propagate_rect, &p, a), TYN_OK);

    tyn_residuum_params q;
    tyn_pass_defaults(&tyn_pass_residuum, &q);
    q.cells = R;
    q.iterations = iterations;
    q.num_grids = ORDINATES;
    q.grid_cells = CELLS;
    q.grid_along = (uint32_t)along;
    q.channels = 3;
    memcpy(q.extent, medium.extent, sizeof q.extent);
    tyn_ref b[RESIDUUM_NUM_PORTS] = {[RESIDUUM_PORT_MEDIUM] = block,
                                     [RESIDUUM_PORT_DENSITY] = image,
                                     [RESIDUUM_PORT_PLACES] = a[PROPAGATE_RECT_PORT_PLACES],
                                     [RESIDUUM_PORT_LIGHT] = a[PROPAGATE_RECT_PORT_LIGHT]};
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_residuum, &q, b), TYN_OK);
    tyn_graph_output(t->graph, "grids", a[PROPAGATE_RECT_PORT_GRIDS], true);
    tyn_graph_output(t->graph, "light", a[PROPAGATE_RECT_PORT_LIGHT], true);
    tyn_graph_output(t->graph, "state", b[RESIDUUM_PORT_STATE], true);
    tyn_graph_output(t->graph, "residuum", b[RESIDUUM_PORT_RESIDUUM], true);
    gpu_run(t);
    outcome o = {gpu_map(t, "grids"), NULL, gpu_map(t, "state"), gpu_map(t, "residuum"), {0}};
    o.light = tyn_graph_map(t->graph, "light", &o.tiled, NULL);
    return o;
}

static float light_of(const outcome *o, uint32_t stack, uint32_t i, uint32_t j, uint32_t k)
{
    uint32_t tiles = o->tiled.x / CELLS;
    uint32_t x = stack % tiles * CELLS + i, y = stack / tiles * CELLS + j;
    return o->light[((size_t)k * o->tiled.y + y) * o->tiled.x + x];
}

// Part of an aligned cell that is inside the medium's box, from points.
static double inside(const struct propagate_grid *grid, uint32_t i, uint32_t j, uint32_t k)
{
    enum { S = 6 };
    int count = 0;
    for (int s = 0; s < S * S * S; s++) {
        double at[3] = {i + (s % S + 0.5) / S, j + (s / S % S + 0.5) / S,
                        k + (s / (S * S) + 0.5) / S};
        bool in = true;
        for (int x = 0; x < 3; x++) {
            double p = grid->origin[x] +
                       grid->cell * (grid->across_u[x] * at[0] + grid->across_v[x] * at[1]) +
                       grid->along * grid->direction[x] * at[2];
            in = in && p >= 0 && p <= medium.extent[x];
        }
        count += in;
    }
    return count / (double)(S * S * S);
}

static double aligned_power(const outcome *o, uint32_t c)
{
    double sum = 0;
    for (uint32_t n = 0; n < ORDINATES; n++) {
        const struct propagate_grid *grid = &o->grids[n];
        for (uint32_t q = 0; q < CELLS * CELLS * o->tiled.z; q++) {
            uint32_t i = q % CELLS, j = q / CELLS % CELLS, k = q / (CELLS * CELLS);
            double light = light_of(o, 3 * n + c, i, j, k);
            if (light > 0) {
                sum +=
                    light * grid->irradiance[c] * grid->cell * grid->cell * inside(grid, i, j, k);
            }
        }
    }
    return sum;
}

static double merged_power(const outcome *o, uint32_t c)
{
    const double dx = 2.0 / R;
    double sum = 0;
    for (int q = 0; q < TOTAL; q++) {
        sum += o->state[4 * q + (int)c] * dx * dx * exp(0.5 * medium.sigma_a[c] * dx * density[0]);
    }
    return sum;
}

static void keeps_the_power(void **state)
{
    for (int q = 0; q < 16 * 12 * 8; q++) {
        density[q] = 0.7f;
    }
    static const double most[3][3] = {{5e-3, 6e-3, 6e-3}, {6e-3, 6e-3, 4e-3}, {6e-3, 5e-3, 3e-3}};
    for (int32_t k = 0; k < 6; k++) {
        const int32_t before = 8 << k % 3, along = k < 3 ? 0 : 10;
        outcome o = run(*state, before, 0, along);
        for (uint32_t c = 0; c < 3; c++) {
            double merged = merged_power(&o, c), aligned = aligned_power(&o, c);
            print_message("%d along, after %2d iterations, channel %u: %.4f W in the aligned grids "
                          "inside the "
                          "box, merged %.4f of it\n",
                          along, before, c, aligned, merged / aligned);
            const double off = fabs(merged / aligned - 1);
            assert_true(along ? within(off, 0.015, NULL, "power, cells that are not cubes")
                              : within(off, most[before / 16][c], NULL,
                                       "power after %d, channel %u", before, c));
        }
    }
}

// The same six-neighbour exchange in double precision, from the merged light.
static void equals_twin(void **state)
{
    enum { ITERATIONS = 9 };
    static double light[TOTAL][3], next[TOTAL][3], sum[TOTAL][3];
    for (int q = 0; q < 16 * 12 * 8; q++) {
        density[q] = 0.5f;
    }
    outcome o = run(*state, 12, 0, 0);
    double kept[3];
    for (int c = 0; c < 3; c++) {
        kept[c] = exp(-medium.sigma_a[c] * 0.5 * 2 / R); // of a whole hop
        for (int q = 0; q < TOTAL; q++) {
            light[q][c] = o.state[4 * q + c] / sqrt(kept[c]);
            sum[q][c] = 0;
        }
    }
    for (int m = 0; m < ITERATIONS; m++) {
        memset(next, 0, sizeof next);
        for (int q = 0; q < TOTAL; q++) {
            int at[3] = {q % RX, q / RX % RY, q / (RX * RY)};
            const int size[3] = {RX, RY, RZ}, stride[3] = {1, RX, RX * RY};
            for (int side = 0; side < 6; side++) {
                int a = side / 2, step = side % 2 ? 1 : -1;
                if (at[a] + step >= 0 && at[a] + step < size[a]) {
                    for (int c = 0; c < 3; c++) {
                        next[q + step * stride[a]][c] += light[q][c] * kept[c] / 6;
                    }
                }
            }
        }
        memcpy(light, next, sizeof light);
        for (int q = 0; q < TOTAL; q++) {
            for (int c = 0; c < 3; c++) {
                sum[q][c] += light[q][c];
            }
        }
    }
    o = run(*state, 12, ITERATIONS, 0);
    double worst = 0;
    for (int q = 0; q < TOTAL; q++) {
        for (int c = 0; c < 3; c++) {
            double expected = sum[q][c] / 12.566370614;
            assert_true(isfinite(o.residuum[4 * q + c]));
            worst = maximum(worst, fabs(o.residuum[4 * q + c] - expected) / expected);
        }
    }
    print_message("largest relative difference to the twin %.1e\n", worst);
    assert_true(worst < 1e-5);
}

static void when_to_switch(void **state)
{
    (void)state;
    // a g^n = epsilon after n events; the paper's Fig 8: g = 0.95, cells of 0.25 m, mean sigma_s 1.07 /m.
    assert_int_equal(tyn_residuum_after(1, 0.95f, 1.076667f, 0.25f, 0.1f), 167);
    assert_int_equal(tyn_residuum_after(1, 0.1f, 1, 1, 0.1f), 1);
    assert_int_equal(tyn_residuum_after(1, 0.5f, 4, 0.25f, 0.125f), 3);
    assert_int_equal(tyn_residuum_after(0.1f, 0.9f, 1, 1, 0.1f), 0); // is so from the start
    assert_int_equal(tyn_residuum_after(1, 0, 2, 0.1f, 0.1f), 5);    // any event is enough
    assert_int_equal(tyn_residuum_after(1, -0.5f, 2, 0.1f, 0.1f), 5);
    assert_int_equal(tyn_residuum_after(1, 1, 2, 0.1f, 0.1f), UINT32_MAX);
    assert_int_equal(tyn_residuum_after(1, 0.9f, 0, 0.1f, 0.1f), UINT32_MAX);
    assert_int_equal(tyn_residuum_after(1, 0.9f, 1e-30f, 1e-10f, 0.1f), UINT32_MAX);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(keeps_the_power),
        cmocka_unit_test(equals_twin),
        cmocka_unit_test(when_to_switch),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
