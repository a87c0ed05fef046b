// resolution.c -- the size of the viewer's pictures from what earlier ones took, for methods of any cost.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include "view/resolution.h"

enum { WIDTH = 640, HEIGHT = 480 };

// A method: what a picture takes whatever its size, and each pixel.
typedef struct model {
    double fixed_ms, pixel_ms, compile_ms; // the last: in the nodes of pixels of the first picture
} model;

static resolution_cost draw(const model *m, uint32_t divisor, bool first, bool cold)
{
    const double pixels =
        (double)((WIDTH + divisor - 1) / divisor) * ((HEIGHT + divisor - 1) / divisor);
    const double ms = m->pixel_ms * pixels + (cold ? m->compile_ms : 0);
    return (resolution_cost){
        .divisor = divisor, .ms = m->fixed_ms + ms, .pixels_ms = ms, .first = first, .cold = cold};
}

static void test_bounds(void **state)
{
    (void)state;
    const uint32_t sizes[][2] = {{640, 480}, {1920, 1080}, {3840, 2160},
                                 {64, 64},   {16, 16},     {7680, 200}};
    for (uint32_t i = 0; i < 6; i++) {
        const uint32_t w = sizes[i][0], h = sizes[i][1];
        const uint32_t start = resolution_start(w, h), most = resolution_coarsest(w, h);
        assert_true(start >= 1 && start <= most);
        assert_true((uint64_t)w * h <= 2048ull * start * start);
        assert_true((uint64_t)w * h <= 1024ull * most * most);
        assert_true(start == 1 || (uint64_t)w * h > 2048ull * (start - 1) * (start - 1));
    }
}

// From the first small picture in steps to the last: how long each took, where it ends.
static uint32_t settle(const model *m, double bound_ms, double *longest)
{
    const uint32_t coarsest = resolution_coarsest(WIDTH, HEIGHT);
    uint32_t divisor = resolution_start(WIDTH, HEIGHT);
    resolution_cost cost = draw(m, divisor, true, true);
    *longest = 0;
    for (int step = 0; step < 100; step++) {
        const uint32_t next = resolution_at_rest(&cost, bound_ms, coarsest);
        if (next >= cost.divisor) {
            return cost.divisor;
        }
        cost = draw(m, next, true, false);
        *longest = cost.ms > *longest ? cost.ms : *longest;
    }
    fail_msg("it does not settle");
    return 0;
}

static void test_sharpens_within_the_bound(void **state)
{
    (void)state;
    double longest;
    const model fast = {30, 2e-4, 0}, compiled = {30, 2e-4, 5000}, slow = {100, 0.7, 2000},
                middle = {50, 0.01, 0};
    assert_int_equal(settle(&fast, 1000, &longest), 1);
    assert_int_equal(settle(&compiled, 1000, &longest), 1); // compiling tells nothing of its pixels
    assert_true(longest < 1000);
    const uint32_t divisor = settle(&slow, 1000, &longest); // 215 s in the window's size
    assert_true(divisor >= 8); // one step beyond the first, which told too much
    assert_true(longest < 1.5 * draw(&slow, resolution_start(WIDTH, HEIGHT), true, false).ms);
    const uint32_t half = settle(&middle, 1000, &longest); // 3 s in the window's size
    assert_int_equal(half, 2);
    assert_true(longest <= 1000);
    assert_int_equal(settle(&middle, 4000, &longest), 1); // with more patience
}

static void test_rest_gives_way(void **state)
{
    (void)state;
    const model slow = {10, 0.02, 0}; // 6.1 s in the window's size
    const resolution_cost cost = draw(&slow, 1, false, false);
    const uint32_t divisor = resolution_at_rest(&cost, 1000, resolution_coarsest(WIDTH, HEIGHT));
    assert_int_equal(divisor, 3);
    assert_true(draw(&slow, divisor, true, false).ms <= 1000);
    const model fixed = {9000, 1e-5, 0}; // no size helps, so none is given up
    const resolution_cost same = draw(&fixed, 1, false, false);
    assert_true(resolution_at_rest(&same, 1000, 18) >= 1);
}

// Moves for some pictures; counts the changes of size.
static uint32_t move(resolution *r, const model *m, int pictures)
{
    uint32_t changes = 0, last = 0;
    for (int i = 0; i < pictures; i++) {
        const resolution_cost cost = draw(m, r->divisor, r->divisor != last, false);
        last = r->divisor;
        resolution_moved(r, &cost, 60, resolution_coarsest(WIDTH, HEIGHT));
        changes += r->divisor != last;
    }
    return changes;
}

static void test_follows_both_ways(void **state)
{
    (void)state;
    const model heavy = {5, 2e-3, 0}, light = {5, 1e-4, 0}; // 614 and 31 ms in the window's size
    resolution r = {.divisor = 1};
    move(&r, &heavy, 10);
    const uint32_t coarse = r.divisor;
    assert_true(coarse >= 3 && draw(&heavy, coarse, false, false).ms <= 1.5 * 60);
    move(&r, &light, 5); // a few easy pictures change nothing
    assert_int_equal(r.divisor, coarse);
    move(&r, &light, 100);
    assert_int_equal(r.divisor, 1); // and it gets finer again while it moves
    move(&r, &heavy, 10);
    assert_int_equal(r.divisor, coarse);
}

static void test_no_swinging(void **state)
{
    (void)state;
    for (double pixel_ms = 1e-5; pixel_ms < 1; pixel_ms *= 1.1) {
        const model m = {5, pixel_ms, 0};
        resolution r = {.divisor = 4};
        move(&r, &m, 200); // settles
        assert_int_equal(move(&r, &m, 200), 0);
        assert_true(r.divisor >= 1 && r.divisor <= resolution_coarsest(WIDTH, HEIGHT));
    }
}

static void test_odd_pictures(void **state)
{
    (void)state;
    const uint32_t coarsest = resolution_coarsest(WIDTH, HEIGHT);
    resolution r = {.divisor = 2};
    const resolution_cost cold = {
        .divisor = 2, .ms = 9000, .pixels_ms = 8000, .first = true, .cold = true};
    resolution_moved(&r, &cold, 60, coarsest); // compiling kernels
    assert_int_equal(r.divisor, 2);
    const resolution_cost fixed = {.divisor = 2, .ms = 900, .pixels_ms = 10};
    resolution_moved(&r, &fixed, 60, coarsest); // fewer pixels would not help
    assert_int_equal(r.divisor, 2);
    const resolution_cost one_slow = {.divisor = 2, .ms = 9000, .pixels_ms = 8990};
    resolution_moved(&r, &one_slow, 60, coarsest); // by twice at most
    assert_int_equal(r.divisor, 4);
    const resolution_cost nothing = {.divisor = 1};
    resolution_moved(&r, &nothing, 60, coarsest);
    assert_int_equal(r.divisor, 1);
    assert_true(resolution_expected_ms(&nothing, 1) == 0);
}

static void test_rest_chooses_for_movement(void **state)
{
    (void)state;
    const uint32_t coarsest = resolution_coarsest(WIDTH, HEIGHT);
    resolution r = {0};
    const model m = {5, 1e-3, 0}; // 307 ms
    const resolution_cost cost = draw(&m, 1, false, false), cold = draw(&m, 1, true, true);
    resolution_rested(&r, &cost, 60, coarsest);
    assert_int_equal(r.divisor, 3);
    resolution_rested(&r, &cost, 60, coarsest);
    assert_int_equal(r.divisor, 3);
    r.divisor = 18;
    resolution_rested(&r, &cold, 60, coarsest);
    assert_int_equal(r.divisor, 18);
    resolution_rested(&r, &cost, 60, coarsest);
    assert_int_equal(r.divisor, 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bounds),
        cmocka_unit_test(test_sharpens_within_the_bound),
        cmocka_unit_test(test_rest_gives_way),
        cmocka_unit_test(test_follows_both_ways),
        cmocka_unit_test(test_no_swinging),
        cmocka_unit_test(test_odd_pictures),
        cmocka_unit_test(test_rest_chooses_for_movement),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
