// constellation.c -- which nodes of method `constellation` run when something changes, on a device that only writes down what it is told.
#include "fake_vulkan.h"
#include "what_runs.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

static void changes(void **state)
{
    (void)state;
    static const char *const nodes[] = {
        "voxel_distance", "env_importance", "median_cut", "light_list",
        "validity_mask",  "constellation",  NULL};
    static const what_runs_row rows[] = {
        {"first frame", change_nothing, "rrrrrr"}, {"nothing", change_nothing, "uuuuuu"},
        {"map turned", turn_map, "uuurur"},        {"map dimmed", dim_map, "uuurur"},
        {"sun dimmed", dim_sun, "uuurur"},         {"camera moved", move_camera, "uuuurr"},
        {"another map", change_map, "urrrur"},     {"coefficients", thin_medium, "uuuurr"},
        {"grid", change_grid, "ruuurr"},           {"unlit", lights_out, "u--rur"},
        {"empty", take_medium, "------"},          {NULL},
    };
    assert_true(what_runs("constellation", nodes, rows));
}

// The widest picture there may be, in so many dispatches that rays are handed on, and lights in parts.
static void widest(void **state)
{
    (void)state;
    fake_vulkan *fake = fake_create();
    tyn_settings *settings;
    assert_int_equal(tyn_settings_create(&settings), TYN_OK);
    assert_int_equal(tyn_settings_set(settings, "constellation.slice", "0.05", NULL), TYN_OK);
    assert_int_equal(tyn_settings_set(settings, "constellation.lights", "64", NULL), TYN_OK);
    tyn_context *ctx;
    assert_int_equal(
        tyn_context_create(
            &fake->dev, tyn_context_params(.method = "constellation", .settings = settings), &ctx),
        TYN_OK);
    stage s;
    make_stage(&s);
    s.view.width = 16384;
    s.view.height = 3;
    s.scene.shapes[0].to_world[0] = 40; // 8193 slices at most
    assert_int_equal(tyn_context_prepare(ctx, tyn_frame(.scene = &s.scene, .view = &s.view)),
                     TYN_OK);
    char *graph = tyn_context_graph(ctx, false);
    static const char *const states[] = {"state_light", "state_through", "state_uncovered"};
    for (int i = 0; i < 3; i++) {
        char line[64];
        snprintf(line, sizeof line, "scratch %s (RGBA32F 16384 x 3,", states[i]);
        assert_non_null(strstr(graph, line));
    }
    int dispatches = 0;
    static const char march[] = "    dispatch constellation_march"; // a line each
    for (const char *at = graph; at; at = strchr(at, '\n')) {
        at += *at == '\n';
        dispatches += strncmp(at, march, sizeof march - 1) == 0;
    }
    print_message("%d dispatches\n", dispatches);
    assert_true(dispatches > 2 * 8192);
    free(graph);
    tyn_context_destroy(&ctx);
    tyn_settings_destroy(&settings);
    tyn_scene_finish(&s.scene);
    fake_destroy(&fake);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(changes), cmocka_unit_test(widest)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
