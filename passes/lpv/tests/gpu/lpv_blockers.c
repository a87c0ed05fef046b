// lpv_blockers.c -- maps along the axes as blockers: what a wall and a slanting plane let through, against a CPU twin.
#include "gpu_test.h"
#include "passes/lpv/lpv_blockers/lpv_blockers.h"
#include "numbers.h"
#include <math.h>
#include <string.h>

enum { SIDE = 72, CELLS = 8, N = CELLS * CELLS * CELLS, CORNERS = 9 * 9 * 9 };

static float position[2 * SIDE][3 * SIDE][4], normal[2 * SIDE][3 * SIDE][4];
static tyn_lpv_blockers_params params;

static void start(void)
{
    memset(position, 0, sizeof position);
    memset(normal, 0, sizeof normal);
    tyn_pass_defaults(&tyn_pass_lpv_blockers, &params);
    params.texels = SIDE;
    params.shape =
        (tyn_lattice_shape){.extent = {2, 2, 2}, .cells = CELLS, .channels = 1, .tint = {1, 1, 1}};
}

// The plane dot(n, p) = d where it is in the box, in the maps that look along the main direction of n.
static void add_plane(const float n[3], float d, uint32_t map)
{
    uint32_t offset[2];
    float rows[4][4];
    tyn_lpv_blockers_view(&params, map, offset, rows);
    const uint32_t axis = map % 3, u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        float p[4] = {0, 0, 0, 1};
        p[u] = (2 * ((float)(i % SIDE) + 0.5f) / SIDE - 1 - rows[0][3]) / rows[0][u];
        p[v] = (2 * ((float)(i / SIDE) + 0.5f) / SIDE - 1 - rows[1][3]) / rows[1][v];
        p[axis] = (d - n[u] * p[u] - n[v] * p[v]) / n[axis];
        // What is in the box, and in this map's half of it.
        const float depth = rows[2][axis] * p[axis] + rows[2][3];
        if (depth >= 0 && depth <= 1) {
            memcpy(position[offset[1] + i / SIDE][offset[0] + i % SIDE], p, sizeof p);
            memcpy(normal[offset[1] + i / SIDE][offset[0] + i % SIDE], n, 3 * sizeof(float));
        }
    }
}

static const uint8_t (*run(gpu_test *t))[28]
{
    const tyn_pass_desc *pass = &tyn_pass_lpv_blockers;
    const tyn_extent size = {3 * SIDE, 2 * SIDE, 1};
    static const float none[2 * SIDE * 3 * SIDE * 4];
    tyn_ref refs[TYN_MAX_PORTS] = {{0}};
    tyn_graph_begin(t->graph);
    *gpu_port(pass, refs, "rsm_flux") = gpu_image(t, "flux", TYN_IMAGE_2D, size, 4, none);
    *gpu_port(pass, refs, "rsm_position") =
        gpu_image(t, "position", TYN_IMAGE_2D, size, 4, position[0][0]);
    *gpu_port(pass, refs, "rsm_normal") =
        gpu_image(t, "normal", TYN_IMAGE_2D, size, 4, normal[0][0]);
    assert_int_equal(tyn_graph_add(t->graph, pass, &params, refs), TYN_OK);
    tyn_graph_output(t->graph, "blocking", *gpu_port(pass, refs, "blocking"), true);
    gpu_run(t);
    return (const uint8_t(*)[28])gpu_map(t, "blocking");
}

static uint32_t cell(uint32_t x, uint32_t y, uint32_t z)
{
    return (z * CELLS + y) * CELLS + x;
}

// A wall across x at 1.45 m, in the plane of shifted cells at 1.5 m: of light that meets it squarely, from either side, three
// quarters are blocked (1/4 + 1/2, two bands of a cosine lobe), of what goes along it a quarter.
static void wall(void **state)
{
    start();
    add_plane((float[]){1, 0, 0}, 1.45f, 0); // seen from the middle: the front is towards -x
    const uint8_t(*b)[28] = run(*state);
    const uint32_t before = cell(5, 4, 4), behind = cell(6, 4, 4);
    // Links 0 and 1 are along +x and -x, 2 along +y.
    assert_near(b[behind][0] / 255.0, 0.75, 0.02);
    assert_near(b[before][1] / 255.0, 0.75, 0.02);
    assert_near(b[behind][2] / 255.0, 0.125, 0.02); // half of its shifted cells have the wall
    assert_int_equal(b[cell(2, 4, 4)][0], 0);
}

// A slanting plane: as much as the lobes of the shifted cells say, which the twin gathers from the same texels.
static void slanting(void **state)
{
    static double lobes[CORNERS][4];
    const float n[3] = {0.48f, 0.64f, 0.6f};
    start();
    memset(lobes, 0, sizeof lobes);
    add_plane(n, 1.4f, 1);
    add_plane(n, 1.4f, 4);
    uint32_t offset[2];
    float rows[4][4];
    const double area = (double)tyn_lpv_blockers_view(&params, 1, offset, rows) / (double)n[1];
    assert_near(area * (double)n[1] * SIDE * SIDE, 2.25 * 2.25, 1e-4);
    for (int y = 0; y < 2 * SIDE; y++) {
        for (int x = 0; x < 3 * SIDE; x++) {
            const float *p = position[y][x];
            int q[3];
            bool in = normal[y][x][1] > 0;
            for (int a = 0; a < 3; a++) {
                q[a] = (int)floor((double)(p[a] / 0.25f + 0.5f));
                in = in && q[a] >= 0 && q[a] <= CELLS;
            }
            if (in) {
                double *l = lobes[(q[2] * 9 + q[1]) * 9 + q[0]];
                const double sign = y < SIDE ? -1 : 1;
                l[0] += 0.25 * area / 0.0625;
                for (int a = 0; a < 3; a++) {
                    l[1 + a] += sign * 0.5 * area / 0.0625 * (double)n[a];
                }
            }
        }
    }
    const uint8_t(*b)[28] = run(*state);
    double worst = 0;
    int some = 0;
    for (int i = 0; i < N; i++) {
        const int c[3] = {i % CELLS, i / CELLS % CELLS, i / (CELLS * CELLS)};
        for (int axis = 0; axis < 3; axis++) {
            for (int way = 0; way < 2; way++) {
                double sum[4] = {0, 0, 0, 0};
                for (int k = 0; k < 4;
                     k++) { // the corners of the face through which the link comes
                    int q[3] = {c[0], c[1], c[2]};
                    q[axis] += way; // link 2 axis goes up: it comes through the lower face
                    q[(axis + 1) % 3] += k & 1;
                    q[(axis + 2) % 3] += k >> 1;
                    for (int m = 0; m < 4; m++) {
                        sum[m] += lobes[(q[2] * 9 + q[1]) * 9 + q[0]][m] / 4;
                    }
                }
                const double facing = sum[0] + fabs(sum[1 + axis]);
                const double expected = fmin(fmax(facing, 0), 1);
                const double found = b[i][2 * axis + way] / 255.0;
                worst = maximum(worst, fabs(found - expected));
                some += expected > 0.2;
            }
        }
    }
    print_message("%d links blocked by a fifth and more; off by %.1e at most\n", some, worst);
    assert_true(some > 50 && worst < 0.5 / 255 + 1e-5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wall),
        cmocka_unit_test(slanting),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
