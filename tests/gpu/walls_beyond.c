// walls_beyond.c -- links that lead out of the lattice towards surfaces close by are cut, and no others.
#include "gpu_test.h"
#include "numbers.h"
#include "passes/walls_beyond/walls_beyond.h"
#include "shaders/surfaces/surface_args.h"
#include "shaders/walls/walls_args.h"
#include "wall_mesh.h"
#include <math.h>
#include <string.h>

enum { N = 8, CELLS = N * N * N };

typedef struct result {
    uint32_t links[CELLS];
    struct wall_cell cells[CELLS];
} result;

// A square from (x, lo, lo) to (x, hi, hi) beside the lattice, which fills [0, 1]^3.
static void run(gpu_test *t, float x, float lo, float hi, float reach, result *out)
{
    const struct surface_vertex v[4] = {{.position = {x, lo, lo}},
                                        {.position = {x, hi, lo}},
                                        {.position = {x, hi, hi}},
                                        {.position = {x, lo, hi}}};
    const struct surface_triangle triangles[2] = {{0, 1, 2, 0}, {0, 2, 3, 0}};
    const struct surface_material material = {.albedo = {0.7f, 0.5f, 0.3f},
                                              .texture = TYN_SURFACE_NO_TEXTURE};
    const struct surface_node leaf = {.lo = {x, lo, lo}, .hi = {x, hi, hi}, .count = 2};
    struct surface_block block = {.num_triangles = 2, .num_nodes = 1};
    for (int a = 0; a < 3; a++) {
        block.to_world[a][a] = block.from_world[a][a] = 1;
    }
    tyn_walls_beyond_params params;
    tyn_pass_defaults(&tyn_pass_walls_beyond, &params);
    params.reach = reach;
    for (int a = 0; a < 3; a++) {
        params.extent[a] = 1;
        params.dims[a] = N;
    }
    tyn_graph_begin(t->graph);
    tyn_ref refs[TYN_MAX_PORTS] = {
        [WALLS_BEYOND_PORT_SURFACES] = gpu_buffer(t, "surfaces", &block, sizeof block),
        [WALLS_BEYOND_PORT_VERTICES] = gpu_buffer(t, "vertices", v, sizeof v),
        [WALLS_BEYOND_PORT_TRIANGLES] = gpu_buffer(t, "triangles", triangles, sizeof triangles),
        [WALLS_BEYOND_PORT_NODES] = gpu_buffer(t, "nodes", &leaf, sizeof leaf),
        [WALLS_BEYOND_PORT_MATERIALS] = gpu_buffer(t, "materials", &material, sizeof material),
    };
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_walls_beyond, &params, refs), TYN_OK);
    tyn_graph_output(t->graph, "links", refs[WALLS_BEYOND_PORT_WALL_LINKS], true);
    tyn_graph_output(t->graph, "cells", refs[WALLS_BEYOND_PORT_WALL_CELLS], true);
    gpu_run(t);
    memcpy(out->links, gpu_map(t, "links"), sizeof out->links);
    memcpy(out->cells, gpu_map(t, "cells"), sizeof out->cells);
}

static result got;

// What a wall of the normal -x sends back of the light of cell i's cut links: all through the face of x, half through
// those beside, the mean of both at edges.
static double share_back(int i)
{
    const int at[3] = {i % N, i / N % N, i / (N * N)};
    double all = 0, back = 0;
    for (int link = 0; link < 14; link++) {
        int d[3], faces = 0;
        wall_step(link, d);
        for (int a = 0; a < 3; a++) {
            faces += at[a] + d[a] < 0 || at[a] + d[a] >= N;
        }
        const double area = link < 6 ? 0.05 : 0.0875 / sqrt(3);
        all += d[0] == 1 ? area : 0;
        back += d[0] == 1 ? area * (0.5 + 0.5 / faces) : 0;
    }
    return back / all;
}

// A large wall 0.1 beyond the upper face of x: all links there lead to it, 5 of the 14 of a cell.
static void a_wall_is_met(void **state)
{
    run(*state, 1.1f, -1, 2, 0.15f, &got);
    for (int i = 0; i < CELLS; i++) {
        const bool beside = i % N == N - 1;
        uint32_t expected = 0;
        for (int link = 0; link < 14; link++) {
            int d[3];
            wall_step(link, d);
            expected |= beside && d[0] == 1 ? 1u << link : 0;
        }
        assert_int_equal(got.links[i], expected);
        if (beside) {
            // A quarter of the area of a cell's face.
            assert_true(got.cells[i].area > 0.2f && got.cells[i].area < 0.3f);
            for (int c = 0; c < 3; c++) {
                const float albedo[3] = {0.7f, 0.5f, 0.3f};
                assert_near(got.cells[i].albedo[c], share_back(i) * albedo[c], 1e-6);
            }
        } else {
            assert_true(got.cells[i].area == 0);
        }
    }
}

static uint32_t cut_links(void)
{
    uint32_t sum = 0;
    for (int i = 0; i < CELLS; i++) {
        sum += got.links[i] != 0;
    }
    return sum;
}

static void what_is_far_or_small_is_not(void **state)
{
    run(*state, 1.1f, -1, 2, 0.05f, &got);
    assert_int_equal(cut_links(), 0); // out of reach
    run(*state, 1.02f, 0.48f, 0.52f, 0.15f, &got);
    assert_int_equal(cut_links(), 0); // a leaf
    run(*state, 1.02f, -1, 2, 0, &got);
    assert_int_equal(cut_links(), 0);
    run(*state, 1.02f, -1, 0.5f, 0.15f, &got);
    assert_true(cut_links() >= N * N / 4 && cut_links() <= N * N / 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_wall_is_met),
        cmocka_unit_test(what_is_far_or_small_is_not),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
