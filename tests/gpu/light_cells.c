// light_cells.c -- what is said of cubes of the medium's box, against texels of a hand-made atlas of shadow maps.
#include "gpu_test.h"
#include "passes/light_cells/light_cells.h"
#include "shaders/light/shadow_args.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 256, MAP = 128, CELLS = 16 };
enum { SUN = 0, SPOT = TYN_SHADOW_LAMP(0), LAMP = TYN_SHADOW_LAMP(1), FREE = TYN_SHADOW_LAMP(2) };

static const float extent[3] = {4, 3, 2};
static float atlas[SIDE][SIDE];
static struct shadow_light maps[TYN_SHADOW_MAX];

// A sun from above over a step and a slope, a spot above a disc, a lamp between two walls, and a lamp without a map.
static void make_maps(void)
{
    memset(maps, 0, sizeof maps);
    maps[SUN] =
        (struct shadow_light){.rows = {{0.4f, 0, 0, -0.8f}, {0, 0.4f, 0, -0.6f}, {0, 0, 0.5f, 0}},
                              .texels = MAP,
                              .kind = TYN_SHADOW_SUN};
    maps[SPOT] = (struct shadow_light){.rows = {{1, 0, 0, -2}, {0, 1, 0, -1.5f}, {0, 0, -1, 3}},
                                       .offset = {MAP, 0},
                                       .texels = MAP,
                                       .scale = 1.5f,
                                       .near = 0.1f,
                                       .kind = TYN_SHADOW_CONE};
    maps[LAMP] =
        (struct shadow_light){.rows = {{1, 0, 0, -2.1f}, {0, 1, 0, -1.4f}, {0, 0, 1, -0.9f}},
                              .offset = {0, MAP},
                              .texels = MAP / 2,
                              .scale = 0.95f,
                              .near = 0.05f,
                              .kind = TYN_SHADOW_CUBE};
    for (int y = 0; y < MAP; y++) {
        for (int x = 0; x < MAP; x++) {
            const double u = (x + 0.5) / MAP * 2 - 1, v = (y + 0.5) / MAP * 2 - 1;
            atlas[y][x] = (float)(u < 0.1 ? 0 : 0.5 + 0.3 * v);
            atlas[y][MAP + x] = u * u + v * v < 0.16 ? 0.1f / 1.5f : 0;
        }
    }
    for (int y = 0; y < MAP; y++) { // faces -x and +y have walls 1 m off, tile by tile
        for (int x = 0; x < SIDE; x++) {
            const int face = x / (MAP / 2) + 3 * (y / (MAP / 2));
            atlas[MAP + y][x] = face == 1 || face == 2 ? 0.05f : 0;
        }
    }
}

// Does the light see p: 1 if all texels of its map around it, four at most, do, 0 if none does, else -1. A place beside the map is lit.
static int sees(int light, const double p[3])
{
    const struct shadow_light *l = &maps[light];
    double q[3], tile[2] = {(double)l->offset[0], (double)l->offset[1]}, u, v, depth;
    for (int r = 0; r < 3; r++) {
        q[r] = (double)l->rows[r][3];
        for (int c = 0; c < 3; c++) {
            q[r] += (double)l->rows[r][c] * p[c];
        }
    }
    bool inside = true;
    if (l->kind == TYN_SHADOW_NONE) {
        return 1;
    }
    if (l->kind == TYN_SHADOW_SUN) {
        u = q[0];
        v = q[1];
        depth = fmax(q[2], 0); // what is behind all casters is at their far side
    } else {
        if (l->kind == TYN_SHADOW_CUBE) {
            int axis = 0;
            for (int a = 1; a < 3; a++) {
                axis = fabs(q[a]) > fabs(q[axis]) ? a : axis;
            }
            const int face = 2 * axis + (q[axis] < 0);
            const double turned[3] = {q[(axis + 1) % 3], q[(axis + 2) % 3], fabs(q[axis])};
            memcpy(q, turned, sizeof q);
            tile[0] += face % 3 * (double)l->texels;
            tile[1] += face / 3 * (double)l->texels;
        }
        inside = q[2] > (double)l->near;
        u = (double)l->scale * q[0] / q[2];
        v = (double)l->scale * q[1] / q[2];
        depth = (double)l->near / q[2];
    }
    if (!inside || fabs(u) >= 1 || fabs(v) >= 1) {
        return 1;
    }
    const int x = (int)floor(tile[0] + (double)l->texels * (0.5 + 0.5 * u) - 0.5),
              y = (int)floor(tile[1] + (double)l->texels * (0.5 + 0.5 * v) - 0.5);
    int lit = 0, shown = 0;
    for (int k = 0; k < 4; k++) {
        const int tx = x + k % 2, ty = y + k / 2;
        if (tx >= tile[0] && ty >= tile[1] && tx < tile[0] + (double)l->texels &&
            ty < tile[1] + (double)l->texels) {
            lit += (double)atlas[ty][tx] <= depth;
            shown++;
        }
    }
    return lit == shown ? 1 : lit == 0 ? 0 : -1;
}

// Is p where the spot shines? Nothing is said of places beside its map.
static bool in_spot(const double p[3])
{
    const double below = 3 - p[2];
    return 1.5 * fmax(fabs(p[0] - 2), fabs(p[1] - 1.5)) < below;
}

static double uniform(void)
{
    return (double)rand() / RAND_MAX;
}

static void every_cube(void **state)
{
    gpu_test *t = *state;
    const int lights[] = {SUN, SPOT, LAMP, FREE};
    make_maps();
    tyn_light_cells_params params;
    tyn_pass_defaults(&tyn_pass_light_cells, &params);
    params.cells = CELLS;
    memcpy(params.extent, extent, sizeof extent);
    params.num_suns = 1;
    params.num_lamps = 3;
    tyn_ref refs[TYN_MAX_PORTS] = {{0}};
    tyn_graph_begin(t->graph);
    *gpu_port(&tyn_pass_light_cells, refs, "shadow_atlas") =
        gpu_image(t, "atlas", TYN_IMAGE_2D, (tyn_extent){SIDE, SIDE, 1}, 1, atlas[0]);
    *gpu_port(&tyn_pass_light_cells, refs, "shadows") = gpu_buffer(t, "shadows", maps, sizeof maps);
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_light_cells, &params, refs), TYN_OK);
    tyn_graph_output(t->graph, "cells", *gpu_port(&tyn_pass_light_cells, refs, "light_cells"),
                     true);
    gpu_run(t);
    tyn_extent size;
    const float *texels = tyn_graph_map(t->graph, "cells", &size, NULL);
    assert_true(size.x == CELLS && size.y == 12 && size.z == 8);
    srand(5);
    for (int n = 0; n < 4; n++) {
        int said[3] = {0}, could[2] = {0};
        for (uint32_t i = 0; i < size.x * size.y * size.z; i++) {
            const uint32_t at[3] = {i % size.x, i / size.x % size.y, i / size.x / size.y};
            const uint32_t says = (uint32_t)texels[i] >> 2 * lights[n] & 3;
            assert_true(says <= TYN_LIGHT_CELLS_LIT);
            said[says]++;
            int lit = 0, dark = 0;
            enum { POINTS = 200 };
            for (int k = 0; k < POINTS; k++) {
                double p[3];
                for (int a = 0; a < 3; a++) {
                    const double off = (2 * uniform() - 1) * (0.5 + (double)TYN_LIGHT_CELLS_REACH);
                    p[a] = 0.25 * (at[a] + 0.5 + off);
                }
                const int seen = sees(lights[n], p);
                const bool shines = lights[n] != SPOT || in_spot(p);
                assert_false(says == TYN_LIGHT_CELLS_LIT && seen != 1);
                assert_false(says == TYN_LIGHT_CELLS_DARK && shines && seen != 0);
                lit += seen == 1;
                dark += seen == 0;
            }
            could[0] += lit == POINTS;
            could[1] += dark == POINTS;
        }
        print_message("light %d: %d cubes dark, %d lit, %d neither; could be %d and %d\n",
                      lights[n], said[TYN_LIGHT_CELLS_DARK], said[TYN_LIGHT_CELLS_LIT],
                      said[TYN_LIGHT_CELLS_MIXED], could[1], could[0]);
        // Most of what is all lit, or all dark, is known to be.
        const int known = said[TYN_LIGHT_CELLS_DARK] + said[TYN_LIGHT_CELLS_LIT];
        assert_true(known > (lights[n] == LAMP ? 0.3 : 0.7) * (could[0] + could[1]));
        assert_true(lights[n] == FREE
                        ? said[TYN_LIGHT_CELLS_LIT] == (int)(size.x * size.y * size.z)
                        : said[TYN_LIGHT_CELLS_LIT] > 0 && said[TYN_LIGHT_CELLS_DARK] > 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_cube)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
