// sky_light.c -- ordinates with and without the mean of the sky, and suns among them, against the same in double.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "passes/sky_light/sky_light.h"
#include "random_unit.h"
#include "shaders/common/scene_args.h"
#include <math.h>
#include <string.h>

enum { COUNT = 91, FIXED = 5 };

static struct ordinate make_ordinate(uint32_t *seed)
{
    struct ordinate o = {.mean_cosine = (float)random_unit(seed),
                         .solid_angle = (float)random_unit(seed),
                         .even = (float)random_unit(seed)};
    for (int c = 0; c < 3; c++) {
        o.irradiance[c] = (float)(3 * random_unit(seed));
        o.direction[c] = (float)(2 * random_unit(seed) - 1);
        o.even_flux[c] = (float)random_unit(seed);
    }
    return o;
}

// All but the irradiance.
static bool same_place(const struct ordinate *a, struct ordinate b)
{
    memcpy(b.irradiance, a->irradiance, sizeof b.irradiance);
    return memcmp(a, &b, sizeof b) == 0;
}

static void light(void **state)
{
    gpu_test *t = *state;
    const struct env_block env = {.radiance = {2, 0.5f, 3}, .sky = {0.7f, 1.1f, 0.2f}};
    uint32_t seed = 9;
    struct ordinates_block unlit = {.count = COUNT, .num_fixed = FIXED};
    tyn_sky_light_params params = {.num_fixed = FIXED};
    for (uint32_t n = 0; n < COUNT; n++) {
        unlit.list[n] = make_ordinate(&seed);
        if (n < FIXED) {
            params.fixed[n] = unlit.list[n];
            memset(unlit.list[n].irradiance, 0, sizeof unlit.list[n].irradiance);
        }
    }
    double worst = 0;
    for (params.split = 0; params.split < 2; params.split++) {
        tyn_graph_begin(t->graph);
        tyn_ref refs[SKY_LIGHT_NUM_PORTS] = {
            [SKY_LIGHT_PORT_ENVIRONMENT] = gpu_buffer(t, "environment", &env, sizeof env),
            [SKY_LIGHT_PORT_ORDINATES] = gpu_buffer(t, "ordinates", &unlit, sizeof unlit)};
        assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_sky_light, &params, refs), TYN_OK);
        tyn_graph_output(t->graph, "lit", refs[SKY_LIGHT_PORT_LIT], true);
        gpu_run(t);
        struct ordinates_block lit;
        memcpy(&lit, gpu_map(t, "lit"), sizeof lit);
        assert_int_equal(lit.count, COUNT);
        assert_int_equal(lit.num_fixed, FIXED);
        assert_memory_equal(lit.list, params.fixed, FIXED * sizeof lit.list[0]);
        assert_memory_equal(lit.list + COUNT, unlit.list + COUNT, // zeros
                            (TYN_ORDINATES_MAX - COUNT) * sizeof lit.list[0]);
        for (uint32_t n = FIXED; n < COUNT; n++) {
            const struct ordinate *o = &unlit.list[n];
            assert_true(same_place(&lit.list[n], *o));
            for (int c = 0; c < 3; c++) {
                const double all = (double)env.radiance[c] * (double)o->irradiance[c];
                const double mean =
                    params.split ? (double)env.sky[c] * (double)o->solid_angle : 0.0;
                worst = maximum(worst, fabs((double)lit.list[n].irradiance[c] - (all - mean)));
            }
        }
    }
    assert_within(worst, 1e-6, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(light)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
