// light_list.c -- the list of all lights: a turned constellation, suns with and without shadow maps, lamps, and their mean; and
// which maps of the sky's directions tell what hides them.
#include "gpu_test.h"
#include "passes/light_list/light_list/light_list.h"
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
            .solid_angle = 0.1f * (float)(i + 1),
            .power = {1.0f + (float)i, 2, 0.5f}};
    }
    return block;
}

// `directions`: NULL: none have maps.
static const struct light_list_block *run(gpu_test *t, bool constellation, bool shadows,
                                          const struct light_block *lights,
                                          const struct ordinates_block *directions)
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
                                               .first_lamp = SUNS,
                                               .wide = shadows,
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
    memset(all + SUNS, 0, sizeof all - SUNS * sizeof *all);
    refs[LIGHT_LIST_PORT_SUNS] = gpu_buffer(t, "suns", all, sizeof all);
    if (directions) {
        refs[LIGHT_LIST_PORT_DIRECTIONS] =
            gpu_buffer(t, "directions", directions, sizeof *directions);
    }
    refs[LIGHT_LIST_PORT_ENVIRONMENT] = gpu_buffer(t, "environment", &env, sizeof env);
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_light_list, &params, refs), TYN_OK);
    tyn_graph_output(t->graph, "list", refs[LIGHT_LIST_PORT_LIGHT_LIST], true);
    if (directions) {
        tyn_graph_output(t->graph, "shades", refs[LIGHT_LIST_PORT_LIGHT_SHADES], true);
    }
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
        const struct light_list_block *list = run(*state, with, shadows, lights, NULL);
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
            const double cone = shadows ? 1 - 0.1 * (i + 1) / (4 * M_PI) : 1;
            assert_true(fabs((double)list->lights[i].mean_cosine - cone) < 1e-6);
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

static double cosine(const float a[3], const float b[3])
{
    return (double)a[0] * (double)b[0] + (double)a[1] * (double)b[1] + (double)a[2] * (double)b[2];
}

// Directions all around, and one of the second sun: each belongs to the light that is nearest to it, by its power; a light that
// none is nearest to has the nearest direction.
static void shades(void **state)
{
    struct light_block lights[SUNS + LAMPS] = {
        {.kind = TYN_LIGHT_KIND_DIRECTIONAL, .color = {1, 2, 3}, .direction = {0, 0, -1}},
        {.kind = TYN_LIGHT_KIND_DIRECTIONAL, .color = {4, 5, 6}, .direction = {0, -1, 0}},
        {.kind = TYN_LIGHT_KIND_POINT, .color = {7, 8, 9}, .position = {1, 2, 3}},
    };
    static struct ordinates_block all;
    for (uint32_t few = 0; few < 2; few++) {
        memset(&all, 0, sizeof all);
        all.count = few ? 3 : 1 + 60;
        all.num_fixed = 1;
        memcpy(all.list[0].direction, lights[1].direction, sizeof lights[1].direction);
        for (uint32_t k = 1; k < all.count; k++) {
            const double z = 1 - (2 * k + 1) / 61.0, a = 2.4 * k, r = sqrt(1 - z * z);
            const double d[3] = {r * cos(a), z, r * sin(a)};
            for (int c = 0; c < 3; c++) {
                all.list[k].direction[c] = (float)d[c];
                all.list[k].irradiance[c] = (float)(1 + k % 5);
            }
        }
        const struct light_list_block *list = run(*state, true, true, lights, &all);
        const struct light_shades_block *found = gpu_map(*state, "shades");
        uint32_t seen[TYN_ORDINATES_MAX] = {0}, alone = 0;
        for (uint32_t n = 0; n < list->count; n++) {
            const struct light_shades_range range = found->lights[n];
            double sum = 0;
            for (uint32_t k = 0; k < range.count; k++) {
                const struct light_shade shade = found->shades[range.first + k];
                const float *d = all.list[shade.direction].direction;
                sum += (double)shade.share;
                const float *own_way = list->lights[n].direction;
                assert_true(
                    memcmp(shade.along, d, sizeof shade.along) == 0 ||
                    (range.count == 1 && memcmp(shade.along, own_way, sizeof shade.along) == 0));
                seen[shade.direction] += n < STARS && range.count == 1 ? 0 : 1;
                for (uint32_t m = 0; m < STARS && n < STARS && range.count > 1; m++) {
                    assert_true(cosine(d, list->lights[m].direction) <=
                                cosine(d, list->lights[n].direction) + 1e-6);
                }
                if (k > 0) { // by their power, in their order
                    const struct light_shade before = found->shades[range.first + k - 1];
                    const double power = 1 + shade.direction % 5, other = 1 + before.direction % 5;
                    assert_true(shade.direction > before.direction);
                    assert_true(fabs((double)shade.share / (double)before.share - power / other) <
                                1e-5);
                }
            }
            alone += n < STARS && range.count == 1;
            assert_true(n < STARS ? range.count > 0 && fabs(sum - 1) < 1e-5
                                  : range.count == (n == STARS + 1));
            if (n == STARS + 1) {
                assert_int_equal(found->shades[range.first].direction, 0);
            }
            if (few && n < STARS) { // two directions: the nearer one
                const uint32_t own = found->shades[range.first].direction;
                const float *towards = list->lights[n].direction;
                assert_true(range.count > 1 ||
                            cosine(all.list[own].direction, towards) >=
                                cosine(all.list[3 - own].direction, towards) - 1e-6);
            }
        }
        assert_true(few ? alone >= STARS - 1 : alone == 0);
        for (uint32_t k = 0; k < all.count && !few; k++) {
            assert_int_equal(seen[k], 1);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(lists), cmocka_unit_test(shades)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
