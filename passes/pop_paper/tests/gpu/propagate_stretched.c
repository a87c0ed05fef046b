// propagate_stretched.c -- pass propagate_rect with cells that are not cubes, and where iterations stop: against the CPU
// twin, cubes, and as many iterations without a stop.
#include "bound.h"
#include "numbers.h"
#include "propagate_run.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- cells that are not cubes -------------------------------------------------------------------

enum { STRETCHES = 4 };
static const int32_t stretches[STRETCHES][2] = {
    {12, 5}, {6, 20}, {12, 12}, {2, 1}}; // across, along

// The place of a grid, by which the merge reads it, is where its cells are.
static void check_place(const outcome *o, int index)
{
    const double cell[3] = {1.5, 4, 0.25};
    double p[3];
    to_m(&o->grids[index], cell, p);
    for (int a = 0; a < 3; a++) {
        const float *row = o->places[index].rows[a];
        assert_near(row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3], cell[a], 1e-4);
        assert_int_equal(o->places[index].size >> 8 * a & 255, o->grids[index].size[a]);
    }
}

static void every_stretch(void **state)
{
    static float density[12 * 16 * 10];
    setup s = oblique(density);
    for (int reading = 0; reading < 16; reading++) {
        s.params.cells = stretches[reading % STRETCHES][0];
        s.params.cells_along = stretches[reading % STRETCHES][1];
        s.params.cones = reading >> 2 & 1;
        s.params.rate = reading >> 3;
        s.params.init = reading % 3 ? TYN_PROPAGATE_INIT_ENTRY : TYN_PROPAGATE_INIT_FIRST_COLLISION;
        outcome o = propagate_run(*state, &s);
        double difference = 0;
        for (int sun = 0; sun < MAX_SUNS; sun++) {
            check_place(&o, sun);
            for (int c = 0; c < 3; c++) {
                difference = maximum(difference, compare_channel(&s, &o, sun, c));
            }
        }
        print_message(
            "%d x %d x %d cells, edges %.3f and %.3f, cones %d: largest difference %.1e\n",
            s.params.cells, s.params.cells, s.params.cells_along, o.grids[0].cell, o.grids[0].along,
            s.params.cones, difference);
        assert_true(difference < 1e-4);
    }
}

// Copies of what a run leaves: state, sum and the light in tiles.
typedef struct bytes {
    float state[4 * STATE_TOTAL], sum[STATE_TOTAL], light[STATE_TOTAL];
} bytes;

static void keep(gpu_test *t, const outcome *o, bytes *b)
{
    memcpy(b->state, o->state, sizeof b->state);
    memcpy(b->sum, o->seen, sizeof b->sum);
    memcpy(b->light, gpu_map(t, "light"), sizeof b->light);
}

// A white cube of the given density along its z axis, for what all grids of it must agree in.
static setup layered_cube(float *density, float sigma_s, float sigma_a)
{
    for (int q = 0; q < STATE_TOTAL; q++) {
        density[q] = 0.5f + 0.5f * (float)sin(0.3 * (q % STATE_CELLS)) *
                                (float)cos(0.2 * (q / (STATE_CELLS * STATE_CELLS)));
    }
    setup s = unit_cube(density, sigma_s, 0.6f, (float[]){1, 0, 0});
    for (int c = 0; c < 3; c++) {
        s.medium.sigma_a[c] = sigma_a;
    }
    s.params.keep_light = 1;
    return s;
}

// The same bytes, but where quotients of edges are not 1: a hop has two.
static void expect_same(const gpu_test *t, const bytes *found, const bytes *right, int iterations)
{
    const double off = 2 * iterations * gpu_ulps(t, GPU_QUOTIENT);
    const float *const a = (const float *)found, *const b = (const float *)right;
    double most = 0;
    for (size_t i = 0; i < sizeof *found / sizeof *a && off > 0; i++) {
        most = maximum(most, fabs((double)b[i]));
    }
    for (size_t i = 0; i < sizeof *found / sizeof *a && off > 0; i++) {
        assert_true(fabs((double)(a[i] - b[i])) <= off * most);
    }
    assert_true(off > 0 || !memcmp(found, right, sizeof *found));
}

// As many cells along as across a cube are cubes.
static void equal_sides(void **state)
{
    static float density[STATE_TOTAL];
    static bytes cubes, same;
    setup s = layered_cube(density, 4, 0.5f);
    for (int init = 0; init < 4; init++) {
        s.params.init = init;
        s.params.cells_along = 0;
        outcome o = propagate_run(*state, &s);
        keep(*state, &o, &cubes);
        assert_true(total(&o, 0, STATE_TOTAL) > 0);
        for (s.params.cones = 0; s.params.cones < 2; s.params.cones++) {
            s.params.cells_along = STATE_CELLS;
            o = propagate_run(*state, &s);
            keep(*state, &o, &same);
            expect_same(*state, &same, &cubes, s.params.iterations);
        }
        s.params.cones = 0;
    }
}

// What enters is the light's irradiance times the area of the grid; whatever the cells' sides, light that turns stays as
// much until it is absorbed or leaves.
static void power_is_kept(void **state)
{
    static float density[STATE_TOTAL];
    for (int q = 0; q < STATE_TOTAL;
         q++) { // within an empty shell that light does not cross in so few hops
        int x = q % STATE_CELLS, y = q / STATE_CELLS % STATE_CELLS,
            z = q / (STATE_CELLS * STATE_CELLS);
        density[q] = x >= 6 && x < 10 && y >= 6 && y < 10 && z >= 2 && z < 8;
    }
    for (int i = 0; i < STRETCHES; i++) {
        for (int32_t cones = 0; cones < 2; cones++) {
            setup s = unit_cube(density, 5, 0.6f, (float[]){1, 0, 0});
            s.params.cells = 4 * stretches[i][0];
            s.params.cells_along = 4 * stretches[i][1];
            s.params.cones = cones;
            s.params.iterations = stretches[i][1];
            outcome o = propagate_run(*state, &s);
            const int across = s.params.cells * s.params.cells;
            double power = total(&o, 0, across * s.params.cells_along) / across, turned = 0;
            for (int q = 0; q < across * s.params.cells_along; q++) {
                turned += (double)o.state[q].c[1] / across;
            }
            print_message("%d x %d x %d cells, cones %d: power - 1 = %.1e, a side has %.3f\n",
                          s.params.cells, s.params.cells, s.params.cells_along, cones, power - 1,
                          turned);
            // A hop turns light by quotients that are off the same way in all cells.
            assert_near(power, 1, 2e-6 + s.params.iterations * gpu_ulps(*state, GPU_QUOTIENT));
            assert_true(turned > 1e-4);
        }
    }
}

// What the medium sends to the eye, W/sr per irradiance: the sum over cells times their volume.
static double seen_by_all(gpu_test *t, float sigma_s, int32_t cells, int32_t cells_along)
{
    static float density[STATE_TOTAL];
    const int32_t along = cells_along ? cells_along : cells;
    setup s = layered_cube(density, sigma_s, 4);
    s.params.cells = cells;
    s.params.cells_along = cells_along;
    s.params.iterations = 2 * along;
    s.params.init = TYN_PROPAGATE_INIT_FIRST_COLLISION;
    outcome o = propagate_run(t, &s);
    double sum = 0;
    for (int q = 0; q < cells * cells * along; q++) {
        sum += (double)o.seen[q] * (double)o.cells[q].c[0];
    }
    return sum * pow(o.grids[0].cell, 2);
}

// Finer cells, along or across or both, come to the same light where most of it is absorbed: the shape of the cells
// makes none. (With little absorption it is not so of cubes either: a hop turns light, whatever its length.)
static void refined(void **state)
{
    static const int32_t cells[][2] = {{8, 4}, {16, 8}, {32, 16}, {8, 32}, {32, 8}, {64, 16}};
    for (int i = 0; i < 2; i++) {
        const float sigma_s = i ? 2 : 0.5f;
        const double expected = seen_by_all(*state, sigma_s, 32, 0);
        for (size_t k = 0; k < sizeof cells / sizeof *cells; k++) {
            double found = seen_by_all(*state, sigma_s, cells[k][0], cells[k][1]);
            print_message("sigma_s %g, %d x %d x %d cells: %+.2f %% of the light in cubes\n",
                          sigma_s, cells[k][0], cells[k][0], cells[k][1],
                          100 * (found / expected - 1));
            assert_within(fabs(found / expected - 1), i ? 0.04 : 0.012, NULL);
        }
    }
}

// ---- the stop -----------------------------------------------------------------------------------

static uint32_t iterations_run(gpu_test *t)
{
    return *(const uint32_t *)gpu_map(t, "flight");
}

// Iterations end where little light is left: what is then there is what as many give, for even and odd numbers.
static void stops(void **state)
{
    static float density[STATE_TOTAL];
    static bytes full, stopped, fewer;
    for (int along = 0; along <= STATE_CELLS; along += STATE_CELLS) {
        setup s = layered_cube(density, 4, 9);
        set_medium(&s, (float[]){1, 0.9f, 0.7f}, s.medium.size, density);
        memcpy(s.params.extent, s.medium.extent, sizeof s.params.extent);
        s.params.cells_along = along;
        s.params.iterations = 120;
        outcome o = propagate_run(*state, &s);
        keep(*state, &o, &full);
        uint32_t found = 120;
        for (float threshold = 1e-5f; threshold < 0.2f; threshold *= 10) {
            for (int32_t odd = 0; odd < 2; odd++) {
                const uint32_t last = found;
                s.params.iterations = 120 + odd;
                s.params.threshold = threshold;
                o = propagate_run(*state, &s);
                keep(*state, &o, &stopped);
                found = iterations_run(*state);
                assert_true(odd ? found == last : found < last);
                s.params.threshold = 0;
                s.params.iterations = (int32_t)found;
                o = propagate_run(*state, &s);
                keep(*state, &o, &fewer);
                assert_memory_equal(&stopped, &fewer, sizeof stopped);
            }
            double left = 0, missing = 0, all = 0;
            for (int q = 0; q < STATE_TOTAL; q++) {
                left = fmax(left, stopped.light[q]);
                missing += fabs((double)full.sum[q] - (double)stopped.sum[q]);
                all += full.sum[q];
            }
            print_message(
                "%d along, threshold %.0e: %u iterations; %.1e left, %.1e of what is seen "
                "is missing\n",
                along, threshold, found, left, missing / all);
            assert_true(left < threshold && missing / all < 6 * threshold);
        }
    }
}

// Batches stop each by themselves; what counts is the light of the brightest sun or ordinate.
static void stops_in_batches(void **state)
{
    static float density[12 * 16 * 10], seen[3 * CELLS];
    uint32_t alone[9], most = 0, least = 0;
    struct ordinate list[9];
    setup s = oblique(density);
    s.num_suns = 0;
    s.params.keep_light = 1;
    s.params.iterations = 60;
    s.params.threshold = 0.01f;
    s.params.prefilter = TYN_PROPAGATE_PREFILTER_EXACT;
    for (int c = 0; c < 3; c++) {
        s.medium.sigma_a[c] = 6;
    }
    for (uint32_t n = 0; n < 9; n++) {
        set_ordinates(&s, 9);
        list[n] = s.ordinates.list[0] = s.ordinates.list[n];
        s.ordinates.count = s.params.num_ordinates = 1;
        outcome o = propagate_run(*state, &s);
        alone[n] = iterations_run(*state);
        most = alone[n] > most ? alone[n] : most;
        if (n == 0 || alone[n] < alone[least]) {
            least = n;
            memcpy(seen, o.seen, sizeof seen);
        }
    }
    // The one that stops first is done last.
    set_ordinates(&s, 9);
    memcpy(s.ordinates.list, list, sizeof list);
    s.ordinates.list[8] = list[least];
    s.ordinates.list[least] = list[8];
    for (int32_t batch = 9; batch > 0; batch -= 4) {
        s.params.buffer_bytes = (uint32_t)batch * 3 * CELLS * 16;
        outcome o = propagate_run(*state, &s);
        assert_int_equal(iterations_run(*state), most);
        if (batch == 1) {
            assert_memory_equal(o.seen, seen, sizeof seen);
        }
    }
    s.params.buffer_bytes = 0;
    for (int c = 0; c < 3; c++) {
        s.ordinates.list[8].irradiance[c] *= 1e4f;
    }
    propagate_run(*state, &s);
    print_message("%u iterations; %u where one ordinate outshines the others\n", most,
                  iterations_run(*state));
    assert_true(alone[least] < most && most < 60);
    assert_int_equal(iterations_run(*state), alone[least]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_stretch), cmocka_unit_test(equal_sides),
        cmocka_unit_test(power_is_kept), cmocka_unit_test(refined),
        cmocka_unit_test(stops),         cmocka_unit_test(stops_in_batches),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
