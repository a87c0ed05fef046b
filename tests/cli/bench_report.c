// bench_report.c -- means over the scenes of a report: of which scenes they are, and why the others are not in them.
#include "bench/front.h"
#include "bench/json.h"
#include "bench/peers.h"
#include "bench/report.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>

// What the means of a report do without.
cJSON *peers_add(const bench_case *c, cJSON *runs, cJSON *left_out)
{
    (void)c, (void)runs, (void)left_out;
    return cJSON_CreateArray();
}
void peers_unknown(app *a, const bench_suite *suite, cJSON *left_out)
{
    (void)a, (void)suite, (void)left_out;
}
cJSON *ceilings_json(const ceilings *on)
{
    (void)on;
    return cJSON_CreateNull();
}
cJSON *paces_json(const paces *p)
{
    (void)p;
    return cJSON_CreateNull();
}
char *bench_picture(const bench_scene *scene, const char *slug)
{
    (void)scene, (void)slug;
    return NULL;
}
const char *bench_preset(const bench_run *run)
{
    return run->baseline ? NULL : "normal";
}

static cJSON *make_run(const char *group, bool samples, double error, double ms)
{
    char text[1024];
    snprintf(text, sizeof text,
             "{\"key\": \"%s %g\", \"name\": \"%s\", \"method\": \"%s\", \"group\": \"%s\", "
             "\"sampling\": %s, \"baseline\": %s, \"swept\": false, \"failed\": null, \"preset\": "
             "%s, \"errors\": [{\"block\": 8, \"error\": %g, \"n\": 0, \"nan\": 0}, {\"block\": 1, "
             "\"error\": %g, \"n\": 0, \"nan\": 0}, {\"block\": 0, \"error\": %g, \"n\": 0}], "
             "\"frame_ms\": {\"first_picture\": %s, \"animated_light\": %g}}",
             group, ms, group, group, group, samples ? "true" : "false", samples ? "true" : "false",
             samples ? "null" : "\"normal\"", error, error, error / 2, samples ? "90" : "null", ms);
    cJSON *run = cJSON_Parse(text);
    assert_non_null(run);
    return run;
}

// Three scenes: errors of 1, 4 and 16 % after 10, 20 and 40 ms, and `path`, which has 10 % after 100 ms in each.
typedef struct made {
    bench_report report;
    bench_suite suite;
} made;

static cJSON *runs_of(int scene)
{
    cJSON *runs = cJSON_CreateArray();
    cJSON_AddItemToArray(runs, make_run("pop", false, 0.01 * pow(4, scene), 10 * pow(2, scene)));
    cJSON_AddItemToArray(runs, make_run("path", true, 0.1, 100));
    return runs;
}

// `spoil`, what is done to the runs of the second scene.
static void make(made *m, void (*spoil)(cJSON *runs))
{
    static const char *const names[] = {"one", "two", "three"};
    *m = (made){.suite = {.name = "test", .block = 8, .num_runs = 2}};
    m->suite.runs[0].method.method = "pop";
    m->suite.runs[1].method.method = "path";
    m->suite.runs[1].baseline = true;
    const bench_machine on = {.name = "", .driver = "", .type = ""};
    bench_report_begin(NULL, &m->report, &on, &m->suite);
    for (int i = 0; i < 3; i++) {
        bench_scene spec = {.name = names[i], .slug = (char *)names[i], .reference = (char *)""};
        bench_case c = {.suite = &m->suite, .spec = &spec, .blocks = {8, 1, 0}};
        cJSON *runs = runs_of(i);
        if (i == 1 && spoil) {
            spoil(runs);
        }
        bench_report_scene(&m->report, &c, runs, cJSON_CreateArray());
    }
    bench_report_end(&m->report, &m->suite);
}

static const cJSON *mean_of(const made *m, const char *list, const char *frame, double block,
                            double error)
{
    const cJSON *entry;
    cJSON_ArrayForEach(entry, cJSON_GetObjectItem(m->report.root, list))
    {
        if (strcmp(json_text(entry, "frame"), frame) == 0 && json_figure(entry, "block") == block &&
            (isnan(error) || fabs(json_figure(entry, "error") - error) < 1e-9)) {
            return entry;
        }
    }
    fail();
    return NULL;
}

static void assert_means(const cJSON *mean, int scenes, double error, double ms, double times)
{
    assert_int_equal(json_figure(mean, "scenes"), scenes);
    assert_int_equal(json_figure(mean, "of"), 3);
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(mean, "missing")), 3 - scenes);
    assert_true(fabs(json_figure(mean, "error") / error - 1) < 1e-6);
    assert_true(fabs(json_figure(mean, "ms") / ms - 1) < 1e-6);
    assert_true(fabs(json_figure(mean, "geometric_mean") / times - 1) < 1e-6);
}

static void assert_reason(const cJSON *mean, int index, const char *expected)
{
    assert_string_equal(
        cJSON_GetStringValue(cJSON_GetArrayItem(cJSON_GetObjectItem(mean, "missing"), index)),
        expected);
}

static void all_scenes(void **state)
{
    (void)state;
    made m;
    make(&m, NULL);
    // path: 10 s, 625 ms, 39.0625 ms
    assert_means(mean_of(&m, "presets", "animated_light", 8, NAN), 3, 0.04, 20, 31.25);
    bench_report_finish(&m.report);
}

static void make_not_finite(cJSON *runs)
{
    cJSON *errors = cJSON_GetObjectItem(cJSON_GetArrayItem(runs, 0), "errors");
    for (int i = 0; i < 3; i++) {
        cJSON *error = cJSON_GetArrayItem(errors, i);
        cJSON_ReplaceItemInObject(error, "error", cJSON_CreateNull());
        if (i < 2) {
            cJSON_ReplaceItemInObject(error, "nan", cJSON_CreateNumber(7));
        }
    }
}

// A picture with a value that is not finite takes its scene out of all three means, not its error out of one.
static void not_finite(void **state)
{
    (void)state;
    made m;
    make(&m, make_not_finite);
    static const double blocks[] = {8, 1, 0};
    for (int i = 0; i < 3; i++) {
        const cJSON *mean = mean_of(&m, "presets", "animated_light", blocks[i], NAN);
        assert_means(mean, 2, i < 2 ? 0.04 : 0.02, 20, 31.25);
        assert_reason(mean, 0, "two: not finite");
    }
    const cJSON *headline = mean_of(&m, "headline", "animated_light", 8, 0.05);
    assert_int_equal(json_figure(headline, "scenes"), 1);
    assert_reason(headline, 0, "two: not finite");
    assert_reason(headline, 1, "three: its least error is 16.0 %");
    bench_report_finish(&m.report);
}

static void make_no_baseline(cJSON *runs)
{
    cJSON_DeleteItemFromArray(runs, 1);
}

static void make_failed(cJSON *runs)
{
    cJSON *run = cJSON_GetArrayItem(runs, 0);
    cJSON_ReplaceItemInObject(run, "failed", cJSON_CreateString("no such light"));
    cJSON_DeleteItemFromObject(run, "errors");
    cJSON_DeleteItemFromObject(run, "frame_ms");
}

static void make_noisy(cJSON *runs)
{
    for (int i = 0; i < 2; i++) {
        cJSON *errors = cJSON_GetObjectItem(cJSON_GetArrayItem(runs, i), "errors");
        for (int k = 0; k < 3; k++) {
            cJSON_ReplaceItemInObject(cJSON_GetArrayItem(errors, k), "n", cJSON_CreateNumber(0.03));
        }
    }
}

static void make_gone(cJSON *runs)
{
    cJSON_DeleteItemFromArray(runs, 0);
}

// Error and time without a speed-up beside them are in no mean either; each scene has its own reason.
static void reasons(void **state)
{
    (void)state;
    static const struct {
        void (*spoil)(cJSON *runs);
        const char *preset, *headline;
    } cases[] = {
        {make_no_baseline, "two: no baseline was measured", "two: no baseline was measured"},
        {make_failed, "two: it cannot do this scene", "two: it cannot do this scene"},
        {make_noisy, "two: the error is below twice the noise of its reference",
         "two: the noise of its reference, 3.0 %, is more than half of this"},
        {make_gone, "two: not measured", "two: not measured"},
    };
    for (size_t i = 0; i < ARRAY_SIZE(cases); i++) {
        made m;
        make(&m, cases[i].spoil);
        const cJSON *preset = mean_of(&m, "presets", "animated_light", 8, NAN);
        assert_means(preset, 2, 0.04, 20, 31.25);
        assert_reason(preset, 0, cases[i].preset);
        assert_reason(mean_of(&m, "headline", "animated_light", 8, 0.05), 0, cases[i].headline);
        bench_report_finish(&m.report);
    }
}

// No first picture was timed: that is why there is no figure, not the error, which frames of another kind have.
static void other_times(void **state)
{
    (void)state;
    made m;
    make(&m, NULL);
    const cJSON *headline = mean_of(&m, "headline", "first_picture", 8, 0.1);
    assert_int_equal(json_figure(headline, "scenes"), 0);
    for (int i = 0; i < 3; i++) {
        static const char *const expected[] = {"one: not measured", "two: not measured",
                                               "three: not measured"};
        assert_reason(headline, i, expected[i]);
        assert_reason(mean_of(&m, "presets", "first_picture", 8, NAN), i, expected[i]);
    }
    bench_report_finish(&m.report);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_scenes),
        cmocka_unit_test(not_finite),
        cmocka_unit_test(reasons),
        cmocka_unit_test(other_times),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
