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

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(energy), cmocka_unit_test(absorption)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
