// lpv_reflect.c -- texels of reflective shadow maps in cells: all of their power, where it belongs, the same each time.
#include "gpu_test.h"
#include "homogeneous.h"
#include "passes/lpv/lpv_reflect/lpv_reflect.h"
#include "shaders/common/counters.h"
#include "shaders/common/scene_args.h"
#include "shaders/light/shadow_args.h"
#include "bound.h"
#include "numbers.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 64, TILES = 2, CELLS = 8, N = CELLS * CELLS * CELLS };

typedef struct stage {
    float flux[TILES * SIDE][SIDE][4], position[TILES * SIDE][SIDE][4],
        normal[TILES * SIDE][SIDE][4];
    struct medium_block medium;
    struct beam_block beams[TYN_BEAM_MAX_SUNS];
    struct radial_block radials;
    tyn_lpv_reflect_params params;
} stage;

static stage s; // large

typedef struct sums {
    float unit;
    uint32_t pad[3];
    int32_t power[3 * N][4];
} sums;

static const sums *run(gpu_test *t)
{
    const tyn_pass_desc *pass = &tyn_pass_lpv_reflect;
    static const float one = 1;
    const tyn_extent texel = {1, 1, 1}, size = {SIDE, TILES * SIDE, 1};
    tyn_ref refs[TYN_MAX_PORTS] = {{0}};
    tyn_graph_begin(t->graph);
    *gpu_port(pass, refs, "medium") = gpu_buffer(t, "medium", &s.medium, sizeof s.medium);
    *gpu_port(pass, refs, "density") = gpu_image(t, "density", TYN_IMAGE_3D, texel, 1, &one);
    *gpu_port(pass, refs, "beams") = gpu_buffer(t, "beams", s.beams, sizeof s.beams);
    *gpu_port(pass, refs, "column") = gpu_image(t, "column", TYN_IMAGE_3D, texel, 1, &one);
    *gpu_port(pass, refs, "radials") = gpu_buffer(t, "radials", &s.radials, sizeof s.radials);
    *gpu_port(pass, refs, "radial_column") = gpu_image(t, "means", TYN_IMAGE_3D, texel, 1, &one);
    *gpu_port(pass, refs, "rsm_flux") = gpu_image(t, "flux", TYN_IMAGE_2D, size, 4, s.flux[0][0]);
    *gpu_port(pass, refs, "rsm_position") =
        gpu_image(t, "position", TYN_IMAGE_2D, size, 4, s.position[0][0]);
    *gpu_port(pass, refs, "rsm_normal") =
        gpu_image(t, "normal", TYN_IMAGE_2D, size, 4, s.normal[0][0]);
    assert_int_equal(tyn_graph_add(t->graph, pass, &s.params, refs), TYN_OK);
    tyn_graph_output(t->graph, "reflected", *gpu_port(pass, refs, "reflected"), true);
    tyn_graph_output(t->graph, "counters", *gpu_port(pass, refs, "counters"), true);
    gpu_run(t);
    assert_int_equal(gpu_non_finite(t), 0);
    return gpu_map(t, "reflected");
}

static void start(void)
{
    memset(&s, 0, sizeof s);
    tyn_pass_defaults(&tyn_pass_lpv_reflect, &s.params);
    s.params.shape =
        (tyn_lattice_shape){.extent = {2, 2, 2}, .cells = CELLS, .channels = 3, .tint = {1, 1, 1}};
    s.medium.max_density = 1;
    for (int i = 0; i < 3; i++) {
        s.medium.extent[i] = s.medium.voxel[i] = 2;
        s.medium.size[i] = 1;
        s.medium.sigma_s[i] = 0.2f * (float)(1 + i);
        s.medium.sigma_a[i] = 0.1f;
    }
    homogeneous_beam(&s.beams[0], s.medium.extent, (float[]){0, -1, 0}, 0);
    const struct light_block lamp = {.position = {0.3f, 1, 0.8f},
                                     .kind = TYN_LIGHT_KIND_POINT,
                                     .direction = {0, 0, -1},
                                     .shadow = TYN_SHADOW_LAMP(0)},
                             other = {.position = {5, 5, 5}, .shadow = TYN_SHADOW_LAMP(1)};
    // In another order than that of the maps.
    homogeneous_radial(&s.radials.list[0], s.medium.extent, &other);
    homogeneous_radial(&s.radials.list[1], s.medium.extent, &lamp);
    s.radials.count = s.radials.num_lamps = 2;
}

// A tile of light `light` that sees the plane across `axis` at `height` with normal `n`.
static void add_plane(uint32_t light, int axis, float height, const float n[3])
{
    const uint32_t tile = s.params.num_tiles++;
    s.params.tiles[tile] = (struct rsm_tile){{0, tile * SIDE}, SIDE, light};
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        const uint32_t x = i % SIDE, y = tile * SIDE + i / SIDE;
        float *p = s.position[y][x], *flux = s.flux[y][x];
        p[axis] = height;
        p[(axis + 1) % 3] = 2 * ((float)x + 0.5f) / SIDE;
        p[(axis + 2) % 3] = 2 * ((float)(i / SIDE) + 0.5f) / SIDE;
        p[3] = 4.0f / (SIDE * SIDE);
        memcpy(s.normal[y][x], n, 3 * sizeof(float));
        for (int c = 0; c < 3; c++) {
            flux[c] = (float)(1e-3 + rand() % 1000 * 1e-3 * (1 + c)) * (i % 97 == 5 ? 1e3f : 1);
        }
    }
}

static double extinction(int c)
{
    return (double)(s.medium.sigma_s[c] + s.medium.sigma_a[c]);
}

// A floor in sunlight and a wall in that of a lamp: power is what is left after the way, cell by cell, with 2/3 of it
// along the normal; and no order of the threads changes a byte.
static void where_it_belongs(void **state)
{
    start();
    srand(4);
    add_plane(0, 1, 0, (float[]){0, 1, 0});
    add_plane(TYN_SHADOW_LAMP(0), 0, 2, (float[]){-1, 0, 0});
    static double expected[3 * N][4];
    memset(expected, 0, sizeof expected);
    double all = 0;
    for (uint32_t i = 0; i < TILES * SIDE * SIDE; i++) {
        const bool wall = i / SIDE >= SIDE;
        const float *p = s.position[i / SIDE][i % SIDE], *n = s.normal[i / SIDE][i % SIDE];
        uint32_t cell[3];
        double way = 2; // down from the top of the box
        if (wall) {
            const float *o = s.radials.list[1].light.position;
            const double d[3] = {p[0] - o[0], p[1] - o[1], p[2] - o[2]};
            way = vector_length(d);
        }
        for (int a = 0; a < 3; a++) {
            cell[a] = (uint32_t)floor((double)(p[a] / 0.25f) + 0.5 * (double)n[a]);
        }
        for (int c = 0; c < 3; c++) {
            const double power = (double)s.flux[i / SIDE][i % SIDE][c] * exp(-extinction(c) * way);
            double *sum = expected[(uint32_t)c * N + (cell[2] * CELLS + cell[1]) * CELLS + cell[0]];
            sum[0] += power;
            for (int a = 0; a < 3; a++) {
                sum[1 + a] += 2 / 3.0 * power * (double)n[a];
            }
            all += power;
        }
    }
    static sums first;
    for (int again = 0; again < 3; again++) {
        const sums *found = run(*state);
        if (again == 0) {
            memcpy(&first, found, sizeof first);
        }
        assert_memory_equal(&first, found, sizeof first);
    }
    double worst = 0;
    for (uint32_t i = 0; i < 3 * N; i++) {
        for (int k = 0; k < 4; k++) {
            const double off = fabs((double)first.unit * first.power[i][k] - expected[i][k]);
            worst = maximum(worst, off / all);
        }
    }
    print_message("off by %.1e of all power; unit %.1e of it\n", worst, (double)first.unit / all);
    assert_true(worst < 1e-6);
}

// Everything into one cell, as bright as floats are: nothing overflows.
static void into_one_cell(void **state)
{
    start();
    add_plane(0, 1, 0, (float[]){0, 1, 0});
    add_plane(0, 1, 0, (float[]){0, 1, 0});
    double all = 0;
    for (uint32_t i = 0; i < TILES * SIDE * SIDE; i++) {
        float *p = s.position[i / SIDE][i % SIDE], *flux = s.flux[i / SIDE][i % SIDE];
        p[0] = p[2] = 1.1f;
        flux[0] = 1e30f;
        flux[1] = flux[2] = 0;
        all += 1e30 * exp(-extinction(0) * 2);
    }
    const sums *found = run(*state);
    const uint32_t cell = (4 * CELLS + 0) * CELLS + 4;
    assert_true(fabs((double)found->unit * found->power[cell][0] / all - 1) < 1e-4);
}

// Texels of a third of a unit each, beside a bright one that makes the unit: right on average.
static void faint(void **state)
{
    start();
    add_plane(0, 1, 0, (float[]){0, 1, 0});
    add_plane(TYN_SHADOW_LAMP(0), 0, 2, (float[]){-1, 0, 0});
    double expected = 0;
    for (uint32_t i = 0; i < TILES * SIDE * SIDE; i++) {
        float *flux = s.flux[i / SIDE][i % SIDE];
        const bool wall = i / SIDE >= SIDE;
        flux[0] = wall ? i == SIDE * SIDE : 5e-10f;
        flux[1] = flux[2] = 0;
        expected += wall ? 0 : (double)flux[0] * exp(-extinction(0) * 2);
    }
    static sums first;
    memcpy(&first, run(*state), sizeof first);
    assert_memory_equal(&first, run(*state), sizeof first);
    double found = 0;
    for (uint32_t i = 0; i < N; i++) {
        // The wall's bright texel is in a cell along x = 2, which the floor's are counted without.
        if (i / CELLS % CELLS == 0 && i % CELLS < CELLS - 1) {
            found += (double)first.unit * first.power[i][0];
        }
    }
    expected *= (CELLS - 1.0) / CELLS;
    const double noise = 0.5 * SIDE * (double)first.unit;
    print_message("faint: %.3e W, expected %.3e, noise %.1e; a texel is %.1e of a unit\n", found,
                  expected, noise, 5e-10 * exp(-extinction(0) * 2) / (double)first.unit);
    assert_true(fabs(found - expected) < 4 * noise);
    assert_true(expected > 20 * noise);
}

// Surfaces farther from the lattice than half a cell, and texels of nothing, bring nothing.
static void beyond(void **state)
{
    start();
    add_plane(0, 1, -0.3f, (float[]){0, 1, 0});
    const sums *found = run(*state);
    for (uint32_t i = 0; i < 3 * N; i++) {
        assert_int_equal(found->power[i][0], 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(where_it_belongs),
        cmocka_unit_test(into_one_cell),
        cmocka_unit_test(faint),
        cmocka_unit_test(beyond),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
