// path_balance.c -- the path tracer's balance: where the energy goes, against what is given.
#include "path_scene.h"
#include <math.h>

// What comes in, from points on the surface, against what is absorbed, from points inside, and goes out.
static void energy(void **state)
{
    for (int i = 0; i < 2; i++) {
        path_scene s;
        path_scene_cube(&s, 3, 1, 0.6f, i == 1);
        path_scene_sun(&s, (float[]){0.6f, 0, -0.8f}, (float[]){1, 2, 3});
        path_scene_sky(&s, 0.25f);
        const tyn_balance *b;
        const struct path_balance_result *r = path_scene_balance(*state, &s, 262144, &b);
        for (int c = 0; c < 3; c++) {
            // A sun on two faces, and a sky on six.
            double entering = 1.4 * (c + 1) + 6 * M_PI * 0.25;
            path_scene_check("entering", b->entering[c], r->error[c], entering);
            double lost = b->absorbed_media[c] + b->escaped[c];
            path_scene_check("absorbed and escaped", lost, hypot(r->error[6 + c], r->error[9 + c]),
                             entering);
            assert_true(fabs(b->imbalance[c] - (1 - lost / b->entering[c])) < 1e-6);
            assert_true(b->emitted[c] == 0 && b->absorbed_surfaces[c] == 0);
        }
    }
}

// A cube that only absorbs has what Beer's law says.
static void absorption(void **state)
{
    path_scene s;
    path_scene_cube(&s, 0, 2, 0, false);
    path_scene_sun(&s, (float[]){1, 0, 0}, (float[]){1, 2, 3});
    const tyn_balance *b;
    const struct path_balance_result *r = path_scene_balance(*state, &s, 262144, &b);
    for (int c = 0; c < 3; c++) {
        path_scene_check("absorbed", b->absorbed_media[c], r->error[6 + c],
                         (c + 1) * (1 - exp(-2)));
        path_scene_check("escaped", b->escaped[c], r->error[9 + c], (c + 1) * exp(-2));
    }
}

// Samples [first, first + num) of `paths` paths each, after those that the state has: what media absorb of them all, W.
static double add(gpu_test *t, path_scene *s, uint32_t paths, uint32_t first, uint32_t num,
                  uint32_t threads, uint32_t *steps)
{
    tyn_ref refs[PATH_BALANCE_NUM_PORTS] = {{0}};
    tyn_graph_begin(t->graph);
    path_scene_declare(t, s, refs);
    refs[PATH_BALANCE_PORT_STATE] =
        tyn_graph_history_buffer(t->graph, "state", sizeof(struct path_balance_state), 1);
    s->params.first_sample = first;
    s->params.num_samples = num;
    s->params.chunks = 1;
    s->params.threads = threads;
    s->params.paths = paths;
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_path_balance, &s->params, refs), TYN_OK);
    tyn_graph_output(t->graph, "balance", refs[PATH_BALANCE_PORT_BALANCE], true);
    tyn_graph_output(t->graph, "counters", refs[PATH_BALANCE_PORT_COUNTERS], true);
    gpu_run(t);
    *steps = ((const struct counters_block *)gpu_map(t, "counters"))->steps;
    return ((const tyn_balance *)gpu_map(t, "balance"))->absorbed_media[0];
}

// 2^32 paths and more: random numbers do not repeat, and what has been found keeps its weight.
static void many(void **state)
{
    enum { PATHS = 65536, THREADS = 1024, STRADDLING = 600 };
    path_scene s;
    path_scene_cube(&s, 3, 1, 0.6f, false);
    path_scene_sun(&s, (float[]){0.6f, 0, -0.8f}, (float[]){1, 2, 3});
    uint32_t first, later, both, parts[2];
    const double absorbed = add(*state, &s, PATHS, 0, 1, THREADS, &first);
    const double same = add(*state, &s, PATHS, 131072, 1, THREADS, &later); // paths 2^33 on
    assert_int_not_equal(first, later);
    assert_true(fabs(same - absorbed) <= 1e-6 * absorbed);
    add(*state, &s, PATHS, 65536, 1, THREADS, &later); // paths 2^32 on
    assert_int_not_equal(first, later);
    // A block ends within sample 5368709, the second of two that one thread has. Steps are rounded up, once a run.
    add(*state, &s, STRADDLING, 5368708, 2, 1, &both);
    add(*state, &s, STRADDLING, 5368708, 1, 1, &parts[0]);
    add(*state, &s, STRADDLING, 5368709, 1, 1, &parts[1]);
    assert_true(both == parts[0] + parts[1] || both + 1 == parts[0] + parts[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(energy), cmocka_unit_test(absorption),
                                       cmocka_unit_test(many)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
