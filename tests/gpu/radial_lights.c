// radial_lights.c -- colours of lamps, beside grids and virtual lights as they are.
#include "gpu_test.h"
#include "passes/radial_lights/radial_lights.h"
#include <string.h>

enum { LAMPS = 3, VPLS = 2, ROOM = 70 }; // more than a workgroup

static struct radial_block grids;

// Every word of what is there is another one.
static void fill(void)
{
    uint32_t *words = (uint32_t *)&grids;
    for (uint32_t i = 0; i < sizeof grids / sizeof *words; i++) {
        words[i] = 1000 + i;
    }
    grids.count = LAMPS + VPLS;
    grids.num_lamps = LAMPS;
}

static void colours_alone_are_replaced(void **state)
{
    gpu_test *t = *state;
    fill();
    tyn_radial_lights_params params = {.num_lamps = LAMPS, .max_vpls = ROOM - LAMPS};
    for (uint32_t i = 0; i < LAMPS; i++) {
        for (uint32_t c = 0; c < 4; c++) {
            params.colors[i][c] = 0.5f + (float)(4 * i + c);
        }
    }
    tyn_graph_begin(t->graph);
    tyn_ref refs[RADIAL_LIGHTS_NUM_PORTS] = {gpu_buffer(t, "grids", &grids, sizeof grids)};
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_radial_lights, &params, refs), TYN_OK);
    tyn_graph_output(t->graph, "radials", refs[RADIAL_LIGHTS_PORT_RADIALS], true);
    gpu_run(t);
    const struct radial_block *shining = gpu_map(t, "radials");
    for (uint32_t i = 0; i < LAMPS; i++) {
        memcpy(grids.list[i].light.color, params.colors[i], sizeof(float[3]));
    }
    const size_t size =
        offsetof(struct radial_block, list) + (LAMPS + VPLS) * sizeof(struct radial_grid);
    assert_memory_equal(shining, &grids, size);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(colours_alone_are_replaced)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
