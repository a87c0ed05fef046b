// what_runs.c -- see what_runs.h.
#include "what_runs.h"
#include "fake_vulkan.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

enum { NX = 20, NY = 16, NZ = 12, VOXELS = NX * NY * NZ, MAP = 64 * 32 * 3 };

void make_stage(stage *s)
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

void change_nothing(stage *s)
{
    (void)s;
}

void turn_map(stage *s)
{
    s->scene.environment.rotation[1] = 0.6f;
    s->scene.environment.rotation[3] = 0.8f;
}

void dim_map(stage *s)
{
    s->scene.environment.strength *= 0.5f;
}

void change_map(stage *s)
{
    s->scene.environment.data[100] = 300;
    s->scene.environment.hash++;
}

void move_camera(stage *s)
{
    s->view.camera.position[0] += 0.1f;
}

void dim_sun(stage *s)
{
    for (int c = 0; c < 3; c++) {
        s->scene.lights[0].color[c] *= 0.5f;
    }
}

void thin_medium(stage *s) // coefficients, not the grid
{
    s->scene.media[0].sigma_s[2] = 4;
}

void change_grid(stage *s)
{
    s->scene.volumes[0].data[11] = 0.5f;
    s->scene.volumes[0].hash++;
}

void turn_sun(stage *s)
{
    s->scene.lights[0].direction[0] = 0.6f;
    s->scene.lights[0].direction[2] = -0.8f;
}

void lights_out(stage *s)
{
    s->scene.environment.present = false;
    s->scene.num_lights = 0;
}

void take_medium(stage *s)
{
    s->scene.num_shapes = 0;
}

// ---- the table --------------------------------------------------------------------------------

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

static void draw(fake_vulkan *fake, tyn_context *ctx, const stage *s)
{
    fake_clear(fake);
    assert_int_equal(tyn_context_prepare(ctx, tyn_frame(.scene = &s->scene, .view = &s->view)),
                     TYN_OK);
    fake->recording = true;
    assert_int_equal(tyn_context_record(ctx, tyn_frame(.cmd = (VkCommandBuffer)(uintptr_t)1,
                                                       .scene = &s->scene, .view = &s->view)),
                     TYN_OK);
    fake->recording = false;
}

bool what_runs(const char *method, const char *const *nodes, const what_runs_row *rows)
{
    fake_vulkan *fake = fake_create();
    tyn_context *ctx;
    assert_int_equal(tyn_context_create(&fake->dev, tyn_context_params(.method = method), &ctx),
                     TYN_OK);
    stage s;
    make_stage(&s);
    bool all = true;
    print_message("%-13s", "");
    for (int n = 0; nodes[n]; n++) {
        print_message(" %s", nodes[n]);
    }
    print_message("\n");
    for (size_t i = 0; rows[i].what; i++) {
        rows[i].change(&s);
        for (int frame = 0; frame <= rows[i].before; frame++) {
            draw(fake, ctx, &s);
        }
        char found[16] = {0};
        for (int n = 0; nodes[n] && n < 15; n++) {
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
    return all;
}
