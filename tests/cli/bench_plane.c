// bench_plane.c -- what a report says of a scene: what the reference's noise hides, many groups, large errors.
#include "bench/json.h"
#include "bench/plane.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>

static void add_run(cJSON *runs, const char *group, bool sampling, double ms, double error,
                    double n)
{
    char text[512];
    snprintf(text, sizeof text,
             "{\"key\": \"%d\", \"group\": \"%s\", \"sampling\": %s, \"baseline\": %s, \"swept\": "
             "true, \"frame_ms\": "
             "{\"animated_light\": %g}, \"errors\": [{\"block\": 8, \"error\": %g, \"n\": %g}]}",
             cJSON_GetArraySize(runs), group, sampling ? "true" : "false",
             sampling ? "true" : "false", ms, error, n);
    cJSON_AddItemToArray(runs, cJSON_Parse(text));
}

// As a reader of the file sees it.
static cJSON *written(cJSON *tree)
{
    char *text = cJSON_PrintUnformatted(tree);
    cJSON *seen = cJSON_Parse(text);
    cJSON_free(text);
    cJSON_Delete(tree);
    assert_non_null(seen);
    return seen;
}

static void has_text(cJSON *list, int index, const char *expected)
{
    assert_string_equal(cJSON_GetStringValue(cJSON_GetArrayItem(list, index)), expected);
}

// A reference so noisy that nothing can be said of most of what is measured.
static void noisy(void **state)
{
    (void)state;
    cJSON *runs = cJSON_CreateArray(), *equal = cJSON_CreateArray();
    add_run(runs, "pop", false, 30, 0.01, 0.034);
    add_run(runs, "pop", false, 90, 0, 0.034);
    add_run(runs, "path", true, 10, 0.2, 0.034);
    add_run(runs, "path", true, 40, 0.05, 0.034);
    add_run(runs, "path", true, 640, 0, 0.034);
    plane p;
    assert_true(plane_make(&p, runs, 0, 8, TIME_LIGHT));
    cJSON *verdicts = plane_verdicts(&p), *ranges = written(plane_ranges(&p));
    cJSON *floors = cJSON_CreateArray();
    plane_add_floors(&p, floors);
    floors = written(floors);
    has_text(verdicts, cJSON_GetArraySize(verdicts) - 1,
             "pop is on the front from 3.4 %, the noise of the reference, to 6.7 %");
    assert_true(fabs(json_figure(ranges, "0.low") - 0.034) < 1e-6);
    assert_true(fabs(json_figure(floors, "0.error") - 0.034) < 1e-9);
    assert_true(json_true(cJSON_GetArrayItem(floors, 0), "vague"));
    plane_add_equal_errors(&p, equal); // at 10, 5 and 3 %
    equal = written(equal);
    cJSON *at_ten = cJSON_GetArrayItem(equal, 0), *at_five = cJSON_GetArrayItem(equal, 1);
    assert_true(cJSON_IsNull(cJSON_GetObjectItem(at_ten, "why")));
    assert_string_equal(json_text(at_five, "why"),
                        "the noise of its reference, 3.4 %, is more than half of this");
    assert_true(json_figure(at_ten, "speedup") > 0);
    assert_true(isnan(json_figure(at_five, "speedup")));
    plane_add_own_equal_errors(&p, runs);
    assert_true(
        json_true(cJSON_GetArrayItem(cJSON_GetObjectItem(cJSON_GetArrayItem(runs, 3), "errors"), 0),
                  "vague"));
    // of the two that are at the noise one is shown
    plane_choose_pictures(&p, runs);
    assert_true(json_true(cJSON_GetArrayItem(runs, 0), "shown"));
    assert_false(json_true(cJSON_GetArrayItem(runs, 1), "shown"));
    plane_finish(&p);
    runs = written(runs);
    assert_true(
        isnan(json_figure(runs, "0.equal_error.0.baseline_ms"))); // of an error that nobody knows
    cJSON_Delete(floors);
    cJSON_Delete(ranges);
    cJSON_Delete(verdicts);
    cJSON_Delete(equal);
    cJSON_Delete(runs);
}

// As many groups as a suite may have runs: none is counted as another.
static void many_groups(void **state)
{
    (void)state;
    cJSON *runs = cJSON_CreateArray(), *equal = cJSON_CreateArray();
    char name[16];
    for (int i = 0; i < 100; i++) {
        snprintf(name, sizeof name, "group %d", i);
        add_run(runs, name, i == 0, 10 + i, 0.2 / (1 + i), 0);
    }
    plane p;
    assert_true(plane_make(&p, runs, 0, 8, TIME_LIGHT));
    assert_int_equal(p.num_lines, 100);
    plane_add_equal_errors(&p, equal);
    assert_int_equal(cJSON_GetArraySize(equal), 3 * 99);
    plane_finish(&p);
    cJSON_Delete(equal);
    cJSON_Delete(runs);
}

static void large_errors(void **state)
{
    (void)state;
    cJSON *runs = cJSON_CreateArray();
    add_run(runs, "pop", false, 1, 2.0, 0);
    add_run(runs, "path", true, 10, 0.6, 0);
    plane p;
    assert_true(plane_make(&p, runs, 0, 8, TIME_LIGHT));
    cJSON *verdicts = plane_verdicts(&p);
    has_text(verdicts, 0, "pop is on the front above 200 %");
    has_text(verdicts, 1, "path wins below 200 %");
    plane_finish(&p);
    cJSON_Delete(verdicts);
    cJSON_Delete(runs);
}

// What is promised of pop begins at 3 %, or 1.2 times its floor; below nobody asks who is faster.
static void promise(void **state)
{
    (void)state;
    cJSON *runs = cJSON_CreateArray();
    add_run(runs, "pop", false, 20, 0.05, 0);
    add_run(runs, "pop", false, 60, 0.04, 0);
    add_run(runs, "path", true, 25, 0.06, 0); // 0.05 after 36 ms, 0.03 after 100
    add_run(runs, "path", true, 625, 0.012, 0);
    plane p;
    assert_true(plane_make(&p, runs, 0, 8, TIME_LIGHT));
    cJSON *kept = written(plane_promise(&p));
    assert_true(json_true(kept, "holds"));
    assert_true(fabs(json_figure(kept, "above") - 0.048) < 1e-9);
    assert_string_equal(json_text(kept, "text"), "pop is on the front at all errors above 4.8 %");
    plane_finish(&p);
    cJSON_Delete(kept);

    add_run(runs, "path", true, 5, 0.1,
            0); // the fastest of all from 10 % on; no longer 0.06 after 25 ms
    assert_true(plane_make(&p, runs, 0, 8, TIME_LIGHT));
    kept = written(plane_promise(&p));
    assert_false(json_true(kept, "holds"));
    const char *text = json_text(kept, "text");
    assert_non_null(
        strstr(text, "pop is not on the front at all errors above 4.8 %: path wins above"));
    assert_true(fabs(json_figure(kept, "beaten.0.low") - 0.0644) < 0.002); // 20 ms of path
    assert_true(isnan(json_figure(kept, "beaten.0.high")));
    plane_finish(&p);
    cJSON_Delete(kept);
    cJSON_Delete(runs);

    runs = cJSON_CreateArray();
    add_run(runs, "path", true, 5, 0.1, 0);
    assert_true(plane_make(&p, runs, 0, 8, TIME_LIGHT));
    kept = plane_promise(&p);
    assert_true(cJSON_IsNull(kept));
    plane_finish(&p);
    cJSON_Delete(kept);
    cJSON_Delete(runs);
}

// A peer is beside the baselines and pop at 10, 5 and 2 %, and no baseline itself.
static void peer(void **state)
{
    (void)state;
    cJSON *runs = cJSON_CreateArray(), *list = cJSON_CreateArray();
    add_run(runs, "pop", false, 30, 0.04, 0.015);
    add_run(runs, "path", true, 10, 0.2, 0.015);
    add_run(runs, "path", true, 160, 0.05, 0.015);
    add_run(runs, "cycles", true, 4, 0.1, 0.015);
    add_run(runs, "cycles", true, 64, 0.025, 0.015);
    for (int i = 3; i < 5; i++) {
        cJSON_ReplaceItemInObject(cJSON_GetArrayItem(runs, i), "baseline", cJSON_CreateFalse());
    }
    plane p;
    assert_true(plane_make(&p, runs, 0, 8, TIME_LIGHT));
    plane_add_peer(&p, "nobody", list);
    assert_int_equal(cJSON_GetArraySize(list), 0);
    plane_add_peer(&p, "cycles", list);
    plane_finish(&p);
    list = written(list);
    assert_int_equal(cJSON_GetArraySize(list), 3);
    assert_true(fabs(json_figure(list, "0.error") - 0.1) < 1e-9);
    assert_true(fabs(json_figure(list, "0.ms") - 4) < 1e-3);
    assert_true(fabs(json_figure(list, "0.baseline_ms") - 40) < 1e-3);
    assert_true(fabs(json_figure(list, "1.ms") - 16) <
                1e-3); // half the error in four times the time
    assert_true(fabs(json_figure(list, "1.baseline_ms") - 160) < 1e-3);
    assert_true(fabs(json_figure(list, "1.method_ms") - 30) < 1e-3);
    assert_string_equal(json_text(cJSON_GetArrayItem(list, 1), "baseline"), "path");
    assert_true(isnan(json_figure(list, "2.ms")) && isnan(json_figure(list, "2.method_ms")));
    assert_string_equal(json_text(cJSON_GetArrayItem(list, 2), "why"),
                        "the noise of its reference, 1.5 %, is more than half of this");
    cJSON_Delete(list);
    cJSON_Delete(runs);
}

// In frames after the camera has moved what is kept is free, and what samples begins anew.
static void moved_camera(void **state)
{
    (void)state;
    cJSON *runs = cJSON_CreateArray();
    add_run(runs, "pop", false, 30, 0.01, 0);
    add_run(runs, "path", true, 10, 0.2, 0);
    add_run(runs, "path", true, 40, 0.1, 0);
    static const double moved_ms[] = {8, 10, 40};
    for (int i = 0; i < 3; i++) {
        cJSON_AddNumberToObject(cJSON_GetObjectItem(cJSON_GetArrayItem(runs, i), "frame_ms"),
                                "camera_moved", moved_ms[i]);
    }
    plane p;
    assert_true(plane_make(&p, runs, 0, 8, TIME_LIGHT));
    cJSON *kept = written(plane_promise(&p));
    assert_false(json_true(kept, "holds"));
    plane_finish(&p);
    cJSON_Delete(kept);
    assert_true(plane_make(&p, runs, 0, 8, TIME_CAMERA));
    kept = written(plane_promise(&p));
    assert_true(json_true(kept, "holds"));
    cJSON *equal = cJSON_CreateArray();
    plane_add_equal_errors(&p, equal);
    equal = written(equal);
    assert_true(fabs(json_figure(equal, "0.speedup") - 40.0 / 8) < 1e-9); // at 10 %
    plane_finish(&p);
    cJSON_Delete(kept);
    cJSON_Delete(equal);
    cJSON_Delete(runs);
}

// A picture of which some values are not finite has an error of the rest, and its own nobody knows.
static void not_finite(void **state)
{
    (void)state;
    cJSON *runs = cJSON_CreateArray();
    add_run(runs, "pop", false, 1, 0.001, 0);
    add_run(runs, "path", true, 10, 0.2, 0);
    cJSON *pop = cJSON_GetArrayItem(runs, 0);
    cJSON_AddNumberToObject(cJSON_GetArrayItem(cJSON_GetObjectItem(pop, "errors"), 0), "nan", 3);
    plane p;
    assert_true(plane_make(&p, runs, 0, 8, TIME_LIGHT));
    cJSON *front = plane_front(&p), *list = cJSON_GetObjectItem(front, "runs");
    cJSON *equal = cJSON_CreateArray(), *floors = cJSON_CreateArray();
    plane_add_floors(&p, floors);
    assert_int_equal(cJSON_GetArraySize(list), 1);
    has_text(list, 0, "1");
    assert_int_equal(cJSON_GetArraySize(floors), 0);
    plane_add_equal_errors(&p, equal);
    plane_add_own_equal_errors(&p, runs);
    equal = written(equal);
    assert_true(isnan(json_figure(equal, "0.ms")));
    assert_null(cJSON_GetObjectItem(pop, "equal_error"));
    plane_finish(&p);
    cJSON_Delete(front);
    cJSON_Delete(floors);
    cJSON_Delete(equal);
    cJSON_Delete(runs);
}

// A baseline whose time to an error is extrapolated is as good as one that was measured there, if it takes less.
static void extrapolated(void **state)
{
    (void)state;
    cJSON *runs = cJSON_CreateArray(), *equal = cJSON_CreateArray();
    add_run(runs, "pop", false, 20, 0.05, 0);
    add_run(runs, "path", true, 400, 0.1, 0); // 1600 ms to 5 %
    add_run(runs, "path, plain", true, 500, 0.2, 0);
    add_run(runs, "path, plain", true, 6000, 0.04, 0);
    plane p;
    assert_true(plane_make(&p, runs, 0, 8, TIME_LIGHT));
    plane_add_equal_errors(&p, equal); // at 10, 5 and 3 %
    plane_add_own_equal_errors(&p, runs);
    plane_finish(&p);
    equal = written(equal);
    const cJSON *at_five = cJSON_GetArrayItem(equal, 1);
    assert_string_equal(json_text(at_five, "baseline"), "path");
    assert_true(fabs(json_figure(at_five, "baseline_ms") - 1600) < 1e-3);
    assert_false(json_true(at_five, "measured"));
    runs = written(runs);
    assert_true(fabs(json_figure(runs, "0.equal_error.0.speedup") - 80) < 1e-3);
    cJSON_Delete(equal);
    cJSON_Delete(runs);

    runs =
        cJSON_CreateArray(); // at equal time: 7.1 % of the one whose points end before, 9.3 % of the other
    add_run(runs, "pop", false, 800, 0.05, 0);
    add_run(runs, "path", true, 400, 0.1, 0);
    add_run(runs, "path, plain", true, 600, 0.1, 0);
    add_run(runs, "path, plain", true, 900, 0.09, 0);
    assert_true(plane_make(&p, runs, 0, 8, TIME_LIGHT));
    plane_add_own_equal_errors(&p, runs);
    plane_finish(&p);
    runs = written(runs);
    assert_true(fabs(json_figure(runs, "0.equal_error.0.baseline_error") - 0.1 / sqrt(2)) < 1e-6);
    assert_false(json_true(
        cJSON_GetArrayItem(cJSON_GetObjectItem(cJSON_GetArrayItem(runs, 0), "equal_error"), 0),
        "error_measured"));
    cJSON_Delete(runs);
}

// The least error in frames of one kind is that of what was measured in such frames.
static void floors_of_a_time(void **state)
{
    (void)state;
    cJSON *runs = cJSON_CreateArray();
    add_run(runs, "pop", false, 30, 0.01, 0);
    add_run(runs, "pop", false, 10, 0.04, 0);
    add_run(runs, "single", false, 5, 0.5, 0);
    cJSON_AddNumberToObject(cJSON_GetObjectItem(cJSON_GetArrayItem(runs, 1), "frame_ms"),
                            "first_picture", 900);
    static const bench_time times[] = {TIME_LIGHT, TIME_FIRST};
    static const double least[] = {0.01, 0.04};
    for (int i = 0; i < 2; i++) {
        plane p;
        assert_true(plane_make(&p, runs, 0, 8, times[i]));
        cJSON *floors = cJSON_CreateArray(), *kept = written(plane_promise(&p));
        plane_add_floors(&p, floors);
        floors = written(floors);
        assert_int_equal(cJSON_GetArraySize(floors), 2 - i);
        assert_true(fabs(json_figure(floors, "0.error") - least[i]) < 1e-9);
        assert_true(fabs(json_figure(kept, "floor") - least[i]) < 1e-9);
        plane_finish(&p);
        cJSON_Delete(floors);
        cJSON_Delete(kept);
    }
    cJSON_Delete(runs);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(noisy),
        cmocka_unit_test(many_groups),
        cmocka_unit_test(large_errors),
        cmocka_unit_test(promise),
        cmocka_unit_test(peer),
        cmocka_unit_test(moved_camera),
        cmocka_unit_test(not_finite),
        cmocka_unit_test(extrapolated),
        cmocka_unit_test(floors_of_a_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
