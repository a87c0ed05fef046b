// lights.c -- kinds of lights: a lobe's integral, its cones, and what scenes make of them.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <math.h>
#include <tyndall/extend/frame_scene.h>

static const double pi = 3.14159265358979;

static void lobes(void **state)
{
    static const struct light_block lights[] = {
        {.kind = TYN_LIGHT_KIND_POINT, .cos_inner = -1, .cos_outer = -1},
        {.kind = TYN_LIGHT_KIND_COSINE, .cos_inner = 1, .cos_outer = 0},
        {.kind = TYN_LIGHT_KIND_SPOT, .cos_inner = 0.9f, .cos_outer = 0.3f},
        {.kind = TYN_LIGHT_KIND_SPOT, .cos_inner = 0.5f, .cos_outer = 0.5f},
        {.kind = TYN_LIGHT_KIND_SPOT, .cos_inner = 1, .cos_outer = -1},
    };
    enum { STEPS = 100000 };
    (void)state;
    for (size_t k = 0; k < sizeof lights / sizeof lights[0]; k++) {
        const struct light_block l = lights[k];
        double sum = 0;
        for (int i = 0; i < STEPS; i++) {
            const float c = (float)(2 * (i + 0.5) / STEPS - 1), lobe = light_lobe(l, c);
            assert_true(lobe >= 0 && lobe <= 1);
            assert_true(c <= l.cos_inner || lobe == 1);
            assert_true(c >= l.cos_outer || lobe == 0);
            sum += 2 * pi * (double)lobe * 2 / STEPS;
        }
        assert_true(fabs(sum - (double)light_lobe_integral(l)) < 1e-4);
    }
}

static void of_scenes(void **state)
{
    const tyn_light point = {.kind = TYN_LIGHT_POINT, .color = {1, 2, 3}};
    const tyn_light spot = {.kind = TYN_LIGHT_SPOT, .cos_inner = 0.9f, .cos_outer = 0.3f};
    const tyn_light sun = {.kind = TYN_LIGHT_DIRECTIONAL};
    (void)state;
    assert_true(tyn_light_block(&point).color[2] == 3 && tyn_light_block(&point).cos_outer == -1);
    assert_true(tyn_light_block(&spot).cos_outer == 0.3f);
    assert_true(fabs(tyn_light_solid_angle(&point) - 4 * pi) < 1e-5);
    assert_true(fabs(tyn_light_solid_angle(&spot) - 2 * pi * (1 - 0.7)) < 1e-5);
    assert_true(tyn_light_solid_angle(&sun) == 0);
    assert_string_equal(tyn_light_traits_of(TYN_LIGHT_SPOT)->name, "spot");
    assert_null(tyn_light_traits_of((tyn_light_kind)(TYN_LIGHT_SPOT + 1)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(lobes), cmocka_unit_test(of_scenes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
