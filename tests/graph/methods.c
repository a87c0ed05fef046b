// methods.c -- every method on every kind of scene, on a device that only writes down what it is told:
// nothing fails or leaks, an unchanged frame records nothing, a moved camera or sun runs no more than
// it must.
#include "fake_vulkan.h"
#include "solids.h"
#include <tyndall/context.h>
#include <tyndall/registry.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

// ---- scenes -----------------------------------------------------------------------------------

static const float identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

static void add_medium(tyn_scene *s, float sigma_s, float g, float x, int32_t volume)
{
    uint32_t m = s->num_media++;
    s->media[m] = (tyn_medium){.sigma_s = {sigma_s, sigma_s, sigma_s},
                               .phase = {{.g = g}, {.g = g}, {.g = g}},
                               .density_scale = 1,
                               .volume = volume};
    tyn_shape *shape = &s->shapes[s->num_shapes++];
    *shape = (tyn_shape){.kind = TYN_SHAPE_BOX, .medium = m};
    memcpy(shape->to_world, identity, sizeof identity);
    shape->to_world[12] = x;
}

static void add_sun(tyn_scene *s, float x, float y, float z)
{
    s->lights[s->num_lights++] =
        (tyn_light){.kind = TYN_LIGHT_DIRECTIONAL, .color = {3, 2, 1}, .direction = {x, y, z}};
}

static void add_volume(tyn_scene *s)
{
    enum { N = 16 * 12 * 20 };
    s->volumes = calloc(1, sizeof *s->volumes);
    s->num_volumes = 1;
    s->volumes[0] = (tyn_volume){
        .size = {16, 12, 20}, .data = malloc(N * sizeof(float)), .max_density = 1, .hash = 77};
    for (int i = 0; i < N; i++) {
        s->volumes[0].data[i] = (float)(i % 11) * 0.1f;
    }
}

static void cube(tyn_scene *s)
{
    add_medium(s, 4, 0.5f, 0, -1);
    add_sun(s, 0, 0, -1);
}

static void cloud(tyn_scene *s) // heterogeneous, turned, two suns and a sky
{
    add_volume(s);
    add_medium(s, 8, 0.8f, 0, 0);
    float *m = s->shapes[0].to_world;
    m[0] = m[5] = 0.8f;
    m[1] = 0.6f;
    m[4] = -0.6f;
    add_sun(s, 0.6f, -0.8f, 0);
    add_sun(s, 0, -1, 0);
    s->environment = (tyn_environment){.present = true, .radiance = {1, 1, 2}, .strength = 1};
}

static void two_media(tyn_scene *s) // unequal and overlapping, one of them glows
{
    add_medium(s, 4, 0.5f, 0, -1);
    add_medium(s, 2, -0.3f, 0.5f, -1);
    s->media[1].sigma_a[0] = 1;
    s->media[1].emission[1] = 0.5f;
    add_sun(s, 1, 0, 0);
}

static void empty(tyn_scene *s)
{
    add_sun(s, 1, 0, 0);
}

static void dark(tyn_scene *s)
{
    add_medium(s, 4, 0, 0, -1);
}

static void lamps(tyn_scene *s) // more suns than have grids, and a lamp
{
    cube(s);
    for (int i = 0; i < 5; i++) {
        add_sun(s, 0, i % 2 ? 1.0f : -1.0f, 0);
    }
    s->lights[s->num_lights++] =
        (tyn_light){.kind = TYN_LIGHT_POINT, .color = {5, 5, 5}, .position = {0.2f, 0, 0}};
}

// A floor and a lamp's shade that glows, without any medium; the hierarchy is one leaf.
static void walls(tyn_scene *s)
{
    const float grey[3] = {0.5f, 0.5f, 0.5f}, black[3] = {0, 0, 0}, glow[3] = {3, 2, 1};
    const uint32_t floor = solids_material(s, grey, black), shade = solids_material(s, grey, glow);
    solids_quad(s, (float[]){-2, -0.4f, 2}, (float[]){4, 0, 0}, (float[]){0, 0, -4}, floor);
    solids_box(s, (float[]){0.1f, 0, 0.1f}, (float[]){0.3f, 0.2f, 0.3f}, 0.5f, false, shade);
    s->surfaces.nodes = calloc(1, sizeof *s->surfaces.nodes);
    s->surfaces.num_nodes = 1;
    s->surfaces.nodes[0] =
        (tyn_surface_node){{-2, -1, -2}, 0, {2, 2, 2}, s->surfaces.num_triangles};
    add_sun(s, 0, -1, 0);
    s->lights[s->num_lights++] =
        (tyn_light){.kind = TYN_LIGHT_POINT, .color = {5, 5, 5}, .position = {0.2f, 0.3f, 0}};
}

static void walls_in_fog(tyn_scene *s)
{
    walls(s);
    add_medium(s, 4, 0.5f, 0, -1);
}

static void (*const scenes[])(tyn_scene *) = {cube, cloud, two_media, empty,
                                              dark, lamps, walls,     walls_in_fog};
static const char *const scene_names[] = {"cube", "cloud", "two_media", "empty",
                                          "dark", "lamps", "walls",     "walls_in_fog"};
enum { NUM_SCENES = sizeof scenes / sizeof *scenes };

// ---- frames -----------------------------------------------------------------------------------

typedef struct stage {
    fake_vulkan *fake;
    tyn_context *ctx;
    tyn_scene scene;
    tyn_view view;
    char label[64];
} stage;

static void open_stage(stage *st, const char *method, int scene)
{
    *st = (stage){.fake = fake_create()};
    snprintf(st->label, sizeof st->label, "%s on %s", method, scene_names[scene]);
    assert_int_equal(tyn_context_create(&st->fake->dev,
                                        tyn_context_params(.method = method, .readback = true),
                                        &st->ctx),
                     TYN_OK);
    tyn_scene_init(&st->scene);
    scenes[scene](&st->scene);
    const float from[3] = {1, 2, 4}, at[3] = {0, 0, 0};
    st->view =
        (tyn_view){.width = 48,
                   .height = 32,
                   .num_samples = 1,
                   .outputs = TYN_OUTPUT_RADIANCE | TYN_OUTPUT_TRANSMITTANCE | TYN_OUTPUT_DISPLAY};
    st->view.camera.yfov = 0.7f;
    assert_int_equal(tyn_camera_look_at(&st->view.camera, from, at), TYN_OK);
}

static void close_stage(stage *st)
{
    tyn_context_destroy(&st->ctx);
    tyn_scene_finish(&st->scene);
    fake_destroy(&st->fake); // fails if anything is left
}

static tyn_result prepare(stage *st)
{
    return tyn_context_prepare(st->ctx, tyn_frame(.scene = &st->scene, .view = &st->view));
}

// Prepares and records; the number of dispatches.
static uint32_t frame(stage *st)
{
    fake_clear(st->fake);
    if (prepare(st) != TYN_OK) {
        fail_msg("%s: %s", st->label, st->fake->log);
    }
    st->fake->recording = true;
    tyn_result result =
        tyn_context_record(st->ctx, tyn_frame(.cmd = (VkCommandBuffer)(uintptr_t)1,
                                              .scene = &st->scene, .view = &st->view));
    st->fake->recording = false;
    if (result != TYN_OK || st->fake->created_while_recording) {
        fail_msg("%s: record gives %d, creates %u: %s", st->label, result,
                 st->fake->created_while_recording, st->fake->log);
    }
    return st->fake->dispatches;
}

// None of the nodes in the list ran.
static void assert_spared(stage *st, const char *const *names)
{
    tyn_report report;
    tyn_context_report(st->ctx, &report);
    for (uint32_t i = 0; i < report.num_nodes; i++) {
        for (const char *const *n = names; *n; n++) {
            if (strcmp(report.nodes[i].name, *n) == 0 &&
                strcmp(report.nodes[i].state, "ran") == 0) {
                fail_msg("%s: %s ran for nothing", st->label, *n);
            }
        }
    }
}

// What a method declares is on its list of passes.
static void assert_listed(stage *st, const tyn_method_info *info)
{
    tyn_report report;
    tyn_context_report(st->ctx, &report);
    for (uint32_t i = 0; i < report.num_nodes; i++) {
        bool listed = false;
        for (const tyn_pass_desc *const *p = info->passes; *p; p++) {
            listed = listed || strcmp(report.nodes[i].name, (*p)->name) == 0;
        }
        if (!listed) {
            fail_msg("%s: pass %s is not on the method's list", st->label, report.nodes[i].name);
        }
    }
}

static void one(const tyn_method_info *info, int scene)
{
    const char *method = info->name;
    static const char *const view_independent[] = {
        "medium", "beam", "scatter_lut", "lattice_cells", "lattice_source", "lattice", NULL};
    static const char *const light_independent[] = {"medium", "scatter_lut", "lattice_cells", NULL};
    stage st;
    open_stage(&st, method, scene);
    frame(&st);
    assert_listed(&st, info);
    assert_true(st.fake->copies > 0); // the picture is read back
    bool progressive = strcmp(method, "path") == 0;
    if (!progressive) {
        assert_int_equal(frame(&st), 0);
        assert_int_equal(st.fake->copies, 0);
    } else {
        st.view.first_sample = 1;
        assert_true(frame(&st) > 0 || scene == 3);
        st.view.first_sample = 0;
    }
    st.view.camera.position[0] += 0.1f;
    frame(&st);
    assert_spared(&st, view_independent);
    for (uint32_t i = 0; i < st.scene.num_lights; i++) { // dimmer; one colour for all stays so
        for (int c = 0; c < 3; c++) {
            st.scene.lights[i].color[c] *= 0.5f;
        }
    }
    frame(&st);
    assert_spared(&st, light_independent);
    st.scene.media[0].sigma_s[0] *= 1.5f;
    frame(&st);
    st.view.width = 32; // another structure
    frame(&st);
    close_stage(&st);
}

static void every_method_on_every_scene(void **state)
{
    (void)state;
    for (uint32_t m = 0; m < tyn_num_methods(); m++) {
        tyn_method_info info;
        tyn_method_at(m, &info);
        for (int scene = 0; scene < NUM_SCENES; scene++) {
            one(&info, scene);
        }
    }
}

// What a picture takes on the device grows with its pixels by no more than a few values for each, four samples of
// surfaces and all: 12 B of distance and radiance a sample, 32 of normals and colours, 16 of the picture, 16 of the
// march's nodes and 5 of its lists, 4 of the list of edges; all else that passes keep for themselves has a place among these.
static void bytes_of_a_pixel(void **state)
{
    (void)state;
    const struct {
        int scene;
        uint64_t most;
    } rows[] = {{0, 40}, {6, 124}, {7, 124}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        uint64_t bytes[2];
        for (uint32_t k = 0; k < 2; k++) {
            stage st;
            open_stage(&st, "pop", rows[i].scene);
            st.view.outputs = TYN_OUTPUT_RADIANCE;
            st.view.width = st.view.height = 1024 * (k + 1);
            frame(&st);
            tyn_report report;
            tyn_context_report(st.ctx, &report);
            bytes[k] = report.persistent_bytes + report.transient_bytes;
            close_stage(&st);
        }
        const double each = (double)(bytes[1] - bytes[0]) / (3 << 20);
        print_message("%s: %.1f B a pixel\n", scene_names[rows[i].scene], each);
        assert_true(each <= (double)rows[i].most);
    }
}

// Memory fails at any call of any method's first frame: an error, and nothing is left.
static void out_of_memory(void **state)
{
    (void)state;
    for (uint32_t m = 0; m < tyn_num_methods(); m++) {
        tyn_method_info info;
        tyn_method_at(m, &info);
        tyn_result result = TYN_ERR_MEMORY;
        for (uint32_t at = 1; result != TYN_OK; at += 1 + at / 16) {
            stage st;
            open_stage(&st, info.name, 1);
            st.fake->fail_at = st.fake->created + at;
            result = prepare(&st);
            if (result != TYN_OK && (result != TYN_ERR_MEMORY || !st.fake->log[0])) {
                fail_msg("%s, call %u: %d '%s'", st.label, at, result, st.fake->log);
            }
            close_stage(&st);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_method_on_every_scene),
                                       cmocka_unit_test(bytes_of_a_pixel),
                                       cmocka_unit_test(out_of_memory)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
