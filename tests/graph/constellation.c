// constellation.c -- which nodes of method `constellation` run when something changes, on a device that only writes down what it is told.
#include "fake_vulkan.h"
#include <tyndall/context.h>
#include <tyndall/registry.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

enum { NX = 20, NY = 16, NZ = 12, VOXELS = NX * NY * NZ, MAP = 64 * 32 * 3 };

typedef struct stage {
    tyn_scene scene;
    tyn_view view;
} stage;

static void make_stage(stage *s)
{
    memset(s, 0, sizeof *s);
    tyn_scene_init(&s->scene);
    s->scene.volumes = calloc(1, sizeof *s->scene.volumes);
    s->scene.num_volumes = 1;
    s->scene.volumes[0] = (tyn_volume){
        .size = {NX, NY, NZ}, .data = calloc(VOXELS, sizeof(float)), .max_density = 1, .hash = 77};
    s->scene.volumes[0].data[VOXELS / 2] = 1;
    s->scene.num_media = s->scene.num_shapes = s->scene.num_lights = 1;
    s->scene.media[0] = (tyn_medium){.sigma_s = {20, 20, 9}, .density_scale = 1, .volume = 0};
    s->scene.shapes[0] = (tyn_shape){.kind = TYN_SHAPE_BOX, .medium = 0};
    for (int i = 0; i < 4; i++) {
        s->scene.shapes[0].to_world[5 * i] = 1;
    }
    s->scene.lights[0] =
        (tyn_light){.kind = TYN_LIGHT_DIRECTIONAL, .color = {3, 2, 1}, .direction = {0, 0, -1}};
    s->scene.environment = (tyn_environment){.present = true,
                                             .size = {64, 32},
                                             .data = malloc(MAP * sizeof(float)),
                                             .radiance = {1, 1, 1},
                                             .strength = 1,
                                             .hash = 5};
    for (int i = 0; i < MAP; i++) {
        s->scene.environment.data[i] = (float)(i % 17);
    }
    const float from[3] = {1, 2, 4}, at[3] = {0, 0, 0};
    s->view =
        (tyn_view){.width = 48, .height = 32, .num_samples = 1, .outputs = TYN_OUTPUT_RADIANCE};
    s->view.camera.yfov = 0.7f;
    assert_int_equal(tyn_camera_look_at(&s->view.camera, from, at), TYN_OK);
}

// ---- changes ----------------------------------------------------------------------------------

static void change_nothing(stage *s)
{
    (void)s;
}

static void turn_map(stage *s)
{
    s->scene.environment.rotation[1] = 0.6f;
    s->scene.environment.rotation[3] = 0.8f;
}

static void dim_map(stage *s)
{
    s->scene.environment.strength *= 0.5f;
}

static void change_map(stage *s)
{
    s->scene.environment.data[100] = 300;
    s->scene.environment.hash++;
}

static void move_camera(stage *s)
{
    s->view.camera.position[0] += 0.1f;
}

static void dim_sun(stage *s)
{
    for (int c = 0; c < 3; c++) {
        s->scene.lights[0].color[c] *= 0.5f;
    }
}

static void thin_medium(stage *s) // coefficients, not the grid
{
    s->scene.media[0].sigma_s[2] = 4;
}

static void change_grid(stage *s)
{
    s->scene.volumes[0].data[11] = 0.5f;
    s->scene.volumes[0].hash++;
}

static void lights_out(stage *s)
{
    s->scene.environment.present = false;
    s->scene.num_lights = 0;
}

static void take_medium(stage *s)
{
    s->scene.num_shapes = 0;
}

// ---- the table --------------------------------------------------------------------------------

static const char *const nodes[] = {"voxel_distance", "env_importance", "median_cut",
                                    "validity_mask", "constellation"};
enum { NUM_NODES = sizeof nodes / sizeof *nodes };

// r: ran, u: unchanged, -: not declared; in the order of `nodes`. Where nodes come or go all run.
static const struct {
    const char *what;
    void (*change)(stage *s);
    const char *right;
} rows[] = {
    {"first frame", change_nothing, "rrrrr"}, {"nothing", change_nothing, "uuuuu"},
    {"map turned", turn_map, "uuuur"},        {"map dimmed", dim_map, "uuuur"},
    {"sun dimmed", dim_sun, "uuuur"},         {"camera moved", move_camera, "uuurr"},
    {"another map", change_map, "urrur"},     {"coefficients", thin_medium, "uuurr"},
    {"grid", change_grid, "ruurr"},           {"unlit", lights_out, "u--ur"},
    {"empty", take_medium, "-----"},
};

static char state_of(tyn_context *ctx, const char *node)
{
    tyn_report report;
    tyn_context_report(ctx, &report);
    for (uint32_t i = 0; i < report.num_nodes; i++) {
        if (!strcmp(report.nodes[i].name, node)) {
            return report.nodes[i].state[0];
        }
    }
    return '-';
}

static void what_runs(void **state)
{
    (void)state;
    fake_vulkan *fake = fake_create();
    tyn_context *ctx;
    assert_int_equal(
        tyn_context_create(&fake->dev, tyn_context_params(.method = "constellation"), &ctx),
        TYN_OK);
    stage s;
    make_stage(&s);
    bool all = true;
    print_message("%-13s voxel_distance env_importance median_cut validity_mask march\n", "");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        rows[i].change(&s);
        fake_clear(fake);
        assert_int_equal(tyn_context_prepare(ctx, tyn_frame(.scene = &s.scene, .view = &s.view)),
                         TYN_OK);
        fake->recording = true;
        assert_int_equal(tyn_context_record(ctx, tyn_frame(.cmd = (VkCommandBuffer)(uintptr_t)1,
                                                           .scene = &s.scene, .view = &s.view)),
                         TYN_OK);
        fake->recording = false;
        char found[NUM_NODES + 1] = {0};
        for (int n = 0; n < NUM_NODES; n++) {
            found[n] = state_of(ctx, nodes[n]);
        }
        const bool right = !strcmp(found, rows[i].right);
        print_message("%-13s %s%s%s\n", rows[i].what, found, right ? "" : ", should be ",
                      right ? "" : rows[i].right);
        all = all && right;
    }
    tyn_context_destroy(&ctx);
    s.scene.environment.present = true;
    tyn_scene_finish(&s.scene);
    fake_destroy(&fake);
    assert_true(all);
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
    const struct CMUnitTest tests[] = {cmocka_unit_test(what_runs), cmocka_unit_test(widest)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
