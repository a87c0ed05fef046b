// light_list.c -- the list of all lights: a turned constellation, suns with and without shadow maps, lamps, and their mean.
#include "gpu_test.h"
#include "passes/light_list/light_list.h"
#include "shaders/common/scene_args.h"
#include <math.h>
#include <string.h>

enum { STARS = 5, SUNS = 2, LAMPS = 1 };

static struct constellation_block stars(void)
{
    struct constellation_block block = {.count = STARS};
    for (int i = 0; i < STARS; i++) {
        const float angle = (float)i;
        block.lights[i] = (struct constellation_light){
            .direction = {0.6f * cosf(angle), 0.8f, 0.6f * sinf(angle)},
            .power = {1.0f + (float)i, 2, 0.5f}};
    }
    return block;
}

static const struct light_list_block *run(gpu_test *t, bool constellation, bool shadows,
                                          const struct light_block *lights)
{
    const struct constellation_block block = stars();
    struct env_block env = {.radiance = {2, 1, 3}};
    // A quarter turn about y: x of the map is -z of the scene.
    env.rows[0][2] = -1;
    env.rows[1][1] = 1;
    env.rows[2][0] = 1;
    tyn_light_list_params params = {.listed = {.constellation = constellation,
                                               .num_suns = SUNS,
                                               .num_lamps = LAMPS,
                                               .shadows = shadows,
                                               .sun_shadow = {1},
                                               .suns_with_shadow = shadows}};
    tyn_ref refs[TYN_MAX_PORTS] = {{0}};
    tyn_graph_begin(t->graph);
    if (constellation) {
        refs[LIGHT_LIST_PORT_CONSTELLATION] = gpu_buffer(t, "constellation", &block, sizeof block);
    }
    struct light_block all[TYN_LIGHTS_MAX] = {0};
    memcpy(all, lights, (SUNS + LAMPS) * sizeof *all);
    refs[LIGHT_LIST_PORT_LIGHTS] = gpu_buffer(t, "lights", all, sizeof all);
    refs[LIGHT_LIST_PORT_ENVIRONMENT] = gpu_buffer(t, "environment", &env, sizeof env);
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_light_list, &params, refs), TYN_OK);
    tyn_graph_output(t->graph, "list", refs[LIGHT_LIST_PORT_LIGHT_LIST], true);
    gpu_run(t);
    return gpu_map(t, "list");
}

static void lists(void **state)
{
    struct light_block lights[SUNS + LAMPS] = {
        {.kind = TYN_LIGHT_KIND_DIRECTIONAL,
         .color = {1, 2, 3},
         .direction = {0, 0, -1},
         .mean_cosine = 1},
        {.kind = TYN_LIGHT_KIND_DIRECTIONAL,
         .color = {4, 5, 6},
         .direction = {0, -1, 0},
         .mean_cosine = 0.9f},
        {.kind = TYN_LIGHT_KIND_SPOT,
         .color = {7, 8, 9},
         .position = {1, 2, 3},
         .direction = {1, 0, 0},
         .cos_inner = 0.9f,
         .cos_outer = 0.8f},
    };
    for (int k = 0; k < 4; k++) {
        const bool with = k & 1, shadows = k & 2;
        const struct light_list_block *list = run(*state, with, shadows, lights);
        const uint32_t first = with ? STARS : 0;
        assert_int_equal(list->count, first + SUNS + LAMPS);
        const struct constellation_block block = stars();
        double mean = 5;
        for (uint32_t i = 0; i < first; i++) {
            const float *d = block.lights[i].direction;
            // rows[r] is what the map's axis r is in M.
            const float towards[3] = {d[2], d[1], -d[0]};
            for (int a = 0; a < 3; a++) {
                assert_true(fabsf(list->lights[i].direction[a] + towards[a]) < 1e-6f);
            }
            assert_true(fabsf(list->lights[i].color[0] - 2 * block.lights[i].power[0]) < 1e-6f);
            assert_int_equal(list->lights[i].shadow, TYN_LIGHT_NO_SHADOW);
            mean += 2 * (double)block.lights[i].power[0];
        }
        assert_true(fabs((double)list->mean[0] - mean / (4 * M_PI)) < 1e-5 * mean);
        for (uint32_t i = 0; i < SUNS + LAMPS; i++) {
            const struct light_block *own = &list->lights[first + i];
            assert_memory_equal(own->color, lights[i].color, sizeof own->color);
            assert_memory_equal(own->direction, lights[i].direction, sizeof own->direction);
            assert_true(own->kind == lights[i].kind);
            // Lamps are points, whatever the block of the scene says.
            assert_true(own->mean_cosine == (i < SUNS ? lights[i].mean_cosine : 1));
        }
        assert_int_equal(list->lights[first].shadow, shadows ? 1 : TYN_LIGHT_NO_SHADOW);
        assert_int_equal(list->lights[first + 1].shadow, TYN_LIGHT_NO_SHADOW);
        assert_int_equal(list->lights[first + 2].shadow,
                         shadows ? TYN_SHADOW_LAMP(0) : TYN_LIGHT_NO_SHADOW);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(lists)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
