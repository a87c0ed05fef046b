// sky_seen.c -- what surfaces leave of the ordinates in the lattice's cells, against rays.
#include "gpu_test.h"
#include "passes/sky_seen/sky_seen.h"
#include "sky_scene.h"
#include "wall_mesh.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { CELLS = 20, COUNT = 7, FIXED = 1, FAN = 4 };

static float share_of(const uint32_t *words, uint32_t plane, const int cell[3])
{
    const uint32_t row = (CELLS + 1) / 2;
    const uint32_t word =
        words[((plane * CELLS + (uint32_t)cell[2]) * CELLS + (uint32_t)cell[1]) * row +
              (uint32_t)cell[0] / 2];
    return (float)(cell[0] % 2 ? word >> 16 : word & 0xffffu) / 65535.0f;
}

// What of the light of an ordinate's directions reaches the middle of a cell: < 0 where an edge is near one of them.
static double open_of(const sky_scene *s, uint32_t first, uint32_t num, const double p[3])
{
    double open = 0, all = 0;
    for (uint32_t k = first; k < first + num; k++) {
        const struct ordinate *d = &s->directions.list[k];
        const double towards[3] = {-(double)d->direction[0], -(double)d->direction[1],
                                   -(double)d->direction[2]};
        const sky_ray ray = sky_scene_ray(s, p, towards, 0.15);
        if (ray == SKY_RAY_DOUBTFUL) {
            return -1;
        }
        open += ray == SKY_RAY_FREE ? (double)d->irradiance[0] : 0;
        all += (double)d->irradiance[0];
    }
    return open / all;
}

// The closed box as walls of the lattice.
static wall_refs add_walls(gpu_test *t)
{
    const double centre[3] = {1.1, 1.1, 1.1}, halves[3] = {0.6, 0.6, 0.6};
    mesh box = mesh_box(centre, halves, 0);
    const grid g = grid_of(CELLS, CELLS, CELLS, 2.0 / CELLS);
    const wall_refs walls = mesh_walls(t, &g, &box);
    mesh_free(&box);
    return walls;
}

static void cells_see_what_rays_see(void **state)
{
    gpu_test *t = *state;
    sky_scene scene;
    sky_scene_make(&scene, COUNT, FIXED, FAN);
    const tyn_sky_shadows_params maps = {.texels = 256,
                                         .reach = 3,
                                         .near_hi = {2, 2, 2},
                                         .count = FIXED + (COUNT - FIXED) * FAN,
                                         .num_triangles = scene.scene.surfaces.num_triangles};
    const tyn_sky_seen_params params = {.extent = {2, 2, 2},
                                        .dims = {CELLS, CELLS, CELLS},
                                        .count = COUNT,
                                        .fan = FAN,
                                        .tint = {1, 0, 0}};
    // The map's green does not count under a red sky.
    for (uint32_t k = 0; k < maps.count; k++) {
        scene.directions.list[k].irradiance[1] = (float)(k % 3) * 7;
    }
    tyn_graph_begin(t->graph);
    tyn_ref sky[TYN_MAX_PORTS] = {{0}};
    sky_scene_upload(t, &scene, sky, &maps);
    const wall_refs walls = add_walls(t);
    tyn_ref refs[TYN_MAX_PORTS] = {
        [SKY_SEEN_PORT_ORDINATES] =
            gpu_buffer(t, "ordinates", &scene.ordinates, sizeof scene.ordinates),
        [SKY_SEEN_PORT_DIRECTIONS] = sky[SKY_SHADOWS_PORT_ORDINATES],
        [SKY_SEEN_PORT_SKY_ATLAS] = sky[SKY_SHADOWS_PORT_SKY_ATLAS],
        [SKY_SEEN_PORT_SKY_MAPS] = sky[SKY_SHADOWS_PORT_SKY_MAPS],
        [SKY_SEEN_PORT_WALL_LINKS] = walls.links,
        [SKY_SEEN_PORT_WALL_CELLS] = walls.cells,
    };
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_sky_seen, &params, refs), TYN_OK);
    tyn_graph_output(t->graph, "seen", refs[SKY_SEEN_PORT_SKY_SEEN], true);
    gpu_run(t);
    const uint32_t *seen = gpu_map(t, "seen");
    uint32_t told = 0, wrong = 0, part = 0, lit_inside = 0;
    for (int i = 0; i < CELLS * CELLS * CELLS; i += 3) {
        const int cell[3] = {i % CELLS, i / CELLS % CELLS, i / CELLS / CELLS};
        double p[3];
        bool inside = true; // the closed box
        for (int a = 0; a < 3; a++) {
            p[a] = (cell[a] + 0.5) * 2 / CELLS;
            inside = inside && p[a] > 0.5 && p[a] < 1.7;
        }
        for (uint32_t n = 0; n < COUNT; n++) {
            const float share = share_of(seen, n + 1, cell);
            lit_inside += inside && share > 0;
            const bool sun = n < FIXED;
            const double open =
                open_of(&scene, sun ? n : FIXED + (n - FIXED) * FAN, sun ? 1 : FAN, p);
            if (open >= 0) {
                told++;
                part += open > 0 && open < 1;
                wrong += fabs((double)share - open) > 1e-4;
            }
        }
        lit_inside += inside && share_of(seen, 0, cell) > 0;
    }
    printf("%u of %u shares wrong, %u of them partly lit; %u lit in the closed box\n", wrong, told,
           part, lit_inside);
    assert_true(told > 4000 && part > 5);
    assert_int_equal(wrong, 0);
    assert_int_equal(lit_inside, 0);
    sky_scene_free(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(cells_see_what_rays_see)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
