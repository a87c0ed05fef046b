// phase_tables.c -- phase functions as tables: values and moments against formulas, delta scaling, and what is refused.
//
// Asserted: values between nodes and Legendre moments of every kind are those of its formula, the integral is 1; two halves
// of one Henyey-Greenstein lobe have the lobe's delta scaling and the moments of its forward part; what is forward of two
// lobes does not count the backward one; equal phase functions share a table; faults are one line that says what is right.
#include "bound.h"
#include "io_test.h"
#include "numbers.h"
#include "phases.h"
#include "scene/phase.h"
#include "scene/phase_table.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

#define PI 3.14159265358979323846
enum { TERMS = 48 };

// The table between its nodes.
static double look_up(const tyn_phase_table *t, double theta)
{
    const double away = 2 * sin(0.5 * theta) * sin(0.5 * theta);
    uint32_t k = 0;
    while (k + 2 < TYN_PHASE_NODES && tyn_phase_node_away(k + 1) < away) {
        k++;
    }
    const double from = tyn_phase_node_away(k), to = tyn_phase_node_away(k + 1);
    const double a = (double)t->values[k], b = (double)t->values[k + 1];
    return a + (b - a) * (away - from) / (to - from);
}

// Simpson's rule in the square root of the angle.
static void formula_moments(phases_kind kind, double chi[TERMS])
{
    const int n = 20000;
    memset(chi, 0, TERMS * sizeof *chi);
    for (int i = 1; i <= n; i++) {
        const double root = sqrt(PI) * i / n, theta = root * root, mu = cos(theta);
        const int part = i == n ? 1 : i % 2 ? 4 : 2;
        const double w = part * sqrt(PI) / n / 3 * 2 * root * 2 * PI * sin(theta);
        double p = 1, before = 0;
        for (int l = 0; l < TERMS; l++) {
            chi[l] += w * phases_value(theta, &kind) * p;
            const double next = ((2 * l + 1) * mu * p - l * before) / (l + 1);
            before = p;
            p = next;
        }
    }
}

static void formulas(void **state)
{
    (void)state;
    for (int kind = 0; kind < PHASES_COUNT; kind++) {
        tyn_scene scene;
        tyn_scene_init(&scene);
        const tyn_phase phase = phases_add(&scene, (phases_kind)kind);
        const tyn_phase_table *table = &scene.phase_tables[phase.table - 1];
        assert_true(fabs(tyn_phase_table_integral(table) - 1) < 1e-6);
        double off = 0, off_moments = 0, chi[TERMS], right[TERMS];
        for (int i = 0; i <= 1800; i++) {
            const double theta = i * PI / 1800;
            const double value = phases_value(theta, &(phases_kind){(phases_kind)kind});
            off = maximum(off, fabs(look_up(table, theta) / value - 1));
        }
        tyn_phase_moments(scene.phase_tables, phase, chi, TERMS);
        formula_moments((phases_kind)kind, right);
        for (int l = 0; l < TERMS; l++) {
            off_moments = maximum(off_moments, fabs(chi[l] - right[l]));
        }
        printf(
            "%s: values within %.2g, moments within %.2g; g %.6f, f %.6f, lobes as of %.4f, %.4f\n",
            phases_name((phases_kind)kind), off, off_moments, (double)phase.g, (double)phase.delta,
            (double)phase.forward, (double)phase.backward);
        if (kind == PHASES_ANGLES) { // straight lines between degrees
            const double off_of_lines = off, moments_of_lines = off_moments;
            assert_within(off_of_lines, 5e-3, NULL);
            assert_within(moments_of_lines, 5e-4, NULL);
        } else {
            assert_within(off, 1e-4, NULL);
            assert_true(off_moments < 1e-5);
        }
        assert_true(fabs((double)phase.g - right[1]) < 1e-6 + off_moments);
        tyn_scene_finish(&scene);
    }
}

static void one_lobe(void **state)
{
    (void)state;
    for (int i = 0; i < 5; i++) {
        const float g = (const float[]){0.2f, 0.6f, 0.9f, 0.99f, -0.5f}[i];
        const tyn_phase_lobe halves[2] = {{.weight = 0.5f, .g = g}, {.weight = 0.5f, .g = g}};
        const tyn_phase_form form = {.count = 2, .lobes = halves};
        const tyn_phase lobe = {.g = g};
        tyn_scene scene;
        tyn_phase table;
        tyn_scene_init(&scene);
        assert_int_equal(tyn_scene_add_phase(&scene, &form, "phase", &table, NULL), TYN_OK);
        const double f = tyn_phase_delta_fraction(lobe);
        assert_true(fabs(tyn_phase_delta_fraction(table) - f) < 2e-6);
        assert_true(fabsf(table.forward - fmaxf(g, 0)) < 1e-4f);
        assert_true(fabsf(table.backward - fmaxf(-g, 0)) < 1e-4f);
        if (tyn_phase_has_lobe(lobe)) {
            double a[TERMS], b[TERMS], off = 0;
            const double theta = tyn_phase_lobe_moments(NULL, lobe, 1, a, TERMS);
            const double theta_1 = tyn_phase_lobe_moments(scene.phase_tables, table, 1, b, TERMS);
            for (int l = 0; l < TERMS; l++) {
                off = maximum(off, fabs(a[l] - b[l]));
            }
            printf("g %g: window %.6f of %.6f, moments of the lobe within %.2g\n", (double)g,
                   theta_1, theta, off);
            assert_true(fabs(theta_1 / theta - 1) < 1e-4);
            assert_true(off < 1e-5);
        }
        tyn_scene_finish(&scene);
    }
}

// f is what lobes that point forward hold of g^2, whatever points back.
static void backward_lobes(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        const float back = (const float[]){-0.3f, -0.6f, -0.9f, -0.97f}[i];
        const tyn_phase_lobe lobes[2] = {{.weight = 0.6f, .g = 0.9f}, {.weight = 0.4f, .g = back}};
        const tyn_phase_form form = {.count = 2, .lobes = lobes};
        tyn_scene scene;
        tyn_phase phase;
        tyn_scene_init(&scene);
        assert_int_equal(tyn_scene_add_phase(&scene, &form, "phase", &phase, NULL), TYN_OK);
        const double f = (double)phase.delta, left = ((double)phase.g - f) / (1 - f);
        printf("0.9 and %g: f %.4f (%.4f of the forward lobe), %.3f of what is left\n",
               (double)back, f, 0.6 * 0.81, left);
        assert_within(fabs(f - 0.6 * 0.81), 0.03, NULL);
        assert_true(left > -1 && left < 1);
        tyn_scene_finish(&scene);
    }
}

static void shared(void **state)
{
    tyn_scene scene;
    tyn_phase lobe;
    const tyn_phase_form one = {.count = 1, .lobes = &(tyn_phase_lobe){.weight = 1, .g = 0.4f}};
    (void)state;
    tyn_scene_init(&scene);
    const tyn_phase a = phases_add(&scene, PHASES_TWO), b = phases_add(&scene, PHASES_RAYLEIGH),
                    c = phases_add(&scene, PHASES_TWO);
    assert_int_equal(scene.num_phase_tables, 2);
    assert_true(tyn_phase_equal(a, c));
    assert_false(tyn_phase_equal(a, b));
    assert_int_equal(tyn_scene_add_phase(&scene, &one, "phase", &lobe, NULL), TYN_OK);
    assert_true(lobe.table == 0 && lobe.g == 0.4f);
    assert_int_equal(scene.num_phase_tables, 2);
    // Set by hand, as an override does: a lobe from then on.
    tyn_phase three[3] = {a, a, a};
    tyn_phase_set(three, tyn_phase_parameters(), (const float[]){0.1f, 0.2f, 0.3f});
    assert_true(three[1].g == 0.2f && three[1].table == 0 && three[1].delta == 0);
    tyn_scene_finish(&scene);
    assert_true(scene.phase_tables == NULL);
}

// ---- faults -----------------------------------------------------------------------------------

static void refuse(const tyn_phase_form *form, const char *says)
{
    tyn_scene scene;
    tyn_phase phase = {.g = 0.25f};
    io_log log;
    io_log_init(&log);
    tyn_scene_init(&scene);
    const tyn_result r = tyn_scene_add_phase(&scene, form, "here", &phase, &log.log);
    if (r != TYN_ERR_PARAMS || !strstr(log.last, says)) {
        print_error("%d: %s, not %s\n", r, log.last, says);
    }
    assert_int_equal(r, TYN_ERR_PARAMS);
    assert_non_null(strstr(log.last, says));
    assert_true(strncmp(log.last, "here", 4) == 0 && log.errors == 1 && log.newlines == 0);
    assert_true(phase.g == 0.25f && scene.num_phase_tables == 0);
}

static void faults(void **state)
{
    const tyn_phase_lobe steep = {.weight = 1, .g = 1}, heavy = {.weight = 1.5f},
                         hollow = {.weight = 1, .alpha = -1}, half = {.weight = 0.5f},
                         no_number = {.weight = 1, .g = NAN};
    const double negative[] = {1, 0.9, 0.1}, doubled[] = {2, 0.5}, wild[] = {1, -3};
    const double angles[] = {0, 1, PI}, turned[] = {0, 2, 1, PI}, late[] = {0.1, 1, PI},
                 short_of[] = {0, 1, 2}, even[] = {1, 1, 1, 1}, below[] = {1, -1, 1},
                 infinite[] = {1, INFINITY, 1};
    (void)state;
    refuse(&(tyn_phase_form){.count = 1, .lobes = &steep}, "lobes[0].g = 1: must be between");
    refuse(&(tyn_phase_form){.count = 1, .lobes = &no_number}, "lobes[0].g = nan: must be");
    refuse(&(tyn_phase_form){.count = 1, .lobes = &heavy}, "lobes[0].weight = 1.5: must be");
    refuse(&(tyn_phase_form){.count = 1, .lobes = &hollow}, "lobes[0].alpha = -1: must be");
    refuse(&(tyn_phase_form){.count = 1, .lobes = &half}, "add up to 0.5: must be 1");
    refuse(&(tyn_phase_form){.count = 3, .moments = negative}, "degrees: must be >= 0");
    refuse(&(tyn_phase_form){.count = 2, .moments = doubled}, "legendre[0] = 2: must be between");
    refuse(&(tyn_phase_form){.count = 2, .moments = wild}, "legendre[1] = -3: must be between");
    refuse(&(tyn_phase_form){.count = 3, .angles = angles, .values = even},
           "integral over the sphere is 12.566");
    refuse(&(tyn_phase_form){.count = 4, .angles = turned, .values = even},
           "angles[2] = 57.2958: must be greater than the one before it, 114.592");
    refuse(&(tyn_phase_form){.count = 3, .angles = late, .values = even}, "angles[0] = 5.7");
    refuse(&(tyn_phase_form){.count = 3, .angles = short_of, .values = even}, "must be 180");
    refuse(&(tyn_phase_form){.count = 3, .angles = angles, .values = below}, "values[1] = -1");
    refuse(&(tyn_phase_form){.count = 3, .angles = angles, .values = infinite}, "values[1] = inf");
    // Half of the light in a twentieth of a degree: right as given, but not to be kept.
    const double glory[] = {0, PI * 179.95 / 180, PI},
                 spike[] = {0.5 / (4 * PI), 0.5 / (4 * PI), 627000};
    refuse(&(tyn_phase_form){.count = 3, .angles = glory, .values = spike}, "narrower than the");
    refuse(&(tyn_phase_form){.count = 1, .angles = angles, .values = even}, "at least 2");
    refuse(&(tyn_phase_form){.count = 3}, "one of lobes, legendre");
    refuse(&(tyn_phase_form){.count = 0, .lobes = &half}, "one of lobes, legendre");
    tyn_phase_lobe lobes[2];
    assert_int_equal(tyn_phase_droplets(4.9, lobes), TYN_ERR_PARAMS);
    assert_int_equal(tyn_phase_droplets(NAN, lobes), TYN_ERR_PARAMS);
    assert_int_equal(tyn_phase_droplets(50, lobes), TYN_OK);
}

// A scene whose tables were spoilt by hand.
static void spoilt(void **state)
{
    tyn_scene scene;
    io_log log;
    (void)state;
    for (int i = 0; i < 4; i++) {
        static const char *const says[] = {"values[7] = nan", "its integral over the sphere is",
                                           "table = 3: there are 1",
                                           "not what tyn_scene_add_phase makes"};
        tyn_scene_init(&scene);
        scene.num_media = 1;
        scene.media[0] = (tyn_medium){.volume = -1, .density_scale = 1};
        scene.media[0].phase[1] = phases_add(&scene, PHASES_TWO);
        io_log_init(&log);
        assert_int_equal(tyn_scene_check(&scene, &log.log), TYN_OK);
        if (i == 0) {
            scene.phase_tables[0].values[7] = NAN;
        } else if (i == 1) {
            scene.phase_tables[0].values[1700] *= 10;
        } else if (i == 2) {
            scene.media[0].phase[1].table = 3;
        } else {
            scene.media[0].phase[1].delta = 0.5f;
        }
        assert_int_equal(tyn_scene_check(&scene, &log.log), TYN_ERR_PARAMS);
        assert_non_null(strstr(log.last, says[i]));
        assert_int_equal(log.errors, 1);
        tyn_scene_finish(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(formulas),       cmocka_unit_test(one_lobe),
                                       cmocka_unit_test(backward_lobes), cmocka_unit_test(shared),
                                       cmocka_unit_test(faults),         cmocka_unit_test(spoilt)};
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    return failed + !bounds_near(failed == 0);
}
