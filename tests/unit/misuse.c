// misuse.c -- public functions that need no device are given what they must not get: each says so, and none crashes.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <tyndall/io.h>
#include <tyndall/offline.h>
#include <tyndall/registry.h>

static int lines; // of level error
static int cases;

static void count(void *user, tyn_log_level level, const char *message)
{
    (void)user;
    lines += level == TYN_LOG_ERROR;
    print_message("  %s\n", message);
}

static const tyn_log listener = {count, NULL, TYN_LOG_WARN};

// A result below 0 and one line; the log is called `log` in what is tried.
#define REFUSED(...)                                                                               \
    do {                                                                                           \
        const tyn_log *log = &listener;                                                            \
        lines = 0;                                                                                 \
        cases++;                                                                                   \
        (void)log;                                                                                 \
        assert_true((__VA_ARGS__) < 0);                                                            \
        assert_int_equal(lines, 1);                                                                \
    } while (0)
// A result below 0 of a function that has no log.
#define REFUSED_SILENTLY(...)                                                                      \
    do {                                                                                           \
        cases++;                                                                                   \
        assert_true((__VA_ARGS__) < 0);                                                            \
    } while (0)
#define GIVES(expected, ...)                                                                       \
    do {                                                                                           \
        cases++;                                                                                   \
        assert_true((__VA_ARGS__) == (expected));                                                  \
    } while (0)
#define DOES_NOTHING(...)                                                                          \
    do {                                                                                           \
        cases++;                                                                                   \
        __VA_ARGS__;                                                                               \
    } while (0)

static void null_handles(void **state)
{
    (void)state;
    tyn_frame frame = {.struct_size = sizeof frame};
    tyn_device *dev = (tyn_device *)&frame, *const unchanged = dev; // any address
    tyn_context *ctx = NULL;
    tyn_offline *off = NULL;
    tyn_report report;
    tyn_inspection inspection;
    tyn_pipeline_stats kernels = {.compiled = 1};
    size_t size = 1;
    REFUSED_SILENTLY(tyn_device_create(NULL, &dev));
    assert_null(dev);
    dev = unchanged;
    REFUSED_SILENTLY(tyn_device_open(NULL, &dev));
    assert_null(dev);
    REFUSED(tyn_device_create(tyn_device_params(.log = *log), NULL));
    REFUSED(tyn_device_open(tyn_device_open_params(.log = *log), NULL));
    REFUSED(tyn_device_create(&(tyn_device_params){.log = *log}, &dev)); // no size
    REFUSED(tyn_device_open(&(tyn_device_open_params){.log = *log}, &dev));
    REFUSED(tyn_device_create(tyn_device_params(.log = *log), &dev)); // nothing that it requires
    DOES_NOTHING(tyn_device_destroy(NULL));
    DOES_NOTHING(tyn_device_destroy(&dev));
    GIVES(0, strcmp(tyn_device_name(NULL), ""));
    GIVES(0, strcmp(tyn_device_driver(NULL), ""));
    GIVES(0, tyn_device_validation_messages(NULL));
    REFUSED_SILENTLY(tyn_device_pipeline_cache(NULL, NULL, &size));
    REFUSED_SILENTLY(tyn_device_pipeline_cache(NULL, &frame, &size));
    REFUSED_SILENTLY(tyn_device_pipeline_cache(NULL, NULL, NULL));
    DOES_NOTHING(tyn_device_pipelines(NULL, &kernels));
    assert_int_equal(kernels.compiled, 0);
    DOES_NOTHING(tyn_device_pipelines(NULL, NULL));
    REFUSED(tyn_devices_list(NULL, 4, log));
    REFUSED_SILENTLY(tyn_context_create(NULL, tyn_context_params(), &ctx));
    REFUSED_SILENTLY(tyn_context_create(NULL, NULL, NULL));
    DOES_NOTHING(tyn_context_destroy(NULL));
    DOES_NOTHING(tyn_context_destroy(&ctx));
    REFUSED_SILENTLY(tyn_context_prepare(NULL, &frame));
    REFUSED_SILENTLY(tyn_context_record(NULL, &frame));
    REFUSED_SILENTLY(tyn_context_prepare(NULL, NULL));
    REFUSED_SILENTLY(tyn_context_record(NULL, NULL));
    REFUSED_SILENTLY(tyn_context_set(NULL, "lattice.cells", "8"));
    REFUSED_SILENTLY(tyn_context_set_quality(NULL, TYN_QUALITY_HIGH));
    REFUSED_SILENTLY(tyn_context_get(NULL, "lattice.cells", &(double){0}));
    GIVES(0, tyn_context_pending(NULL));
    GIVES(1, tyn_context_batch(NULL, &frame));
    GIVES(NULL, tyn_context_output(NULL, TYN_OUTPUT_RADIANCE));
    DOES_NOTHING(tyn_context_report(NULL, &report));
    assert_int_equal(report.num_nodes, 0);
    DOES_NOTHING(tyn_context_report(NULL, NULL));
    DOES_NOTHING(tyn_context_inspect(NULL, "merge"));
    GIVES(false, tyn_context_inspection(NULL, &inspection));
    GIVES(false, tyn_context_inspection(NULL, NULL));
    GIVES(NULL, tyn_context_graph(NULL, true));
    REFUSED_SILENTLY(tyn_offline_create(NULL, tyn_offline_params(), &off));
    REFUSED_SILENTLY(tyn_offline_create(NULL, NULL, NULL));
    DOES_NOTHING(tyn_offline_destroy(NULL));
    DOES_NOTHING(tyn_offline_destroy(&off));
    REFUSED_SILENTLY(tyn_offline_frame(NULL, NULL, NULL, false));
    DOES_NOTHING(tyn_offline_on_progress(NULL, NULL, NULL));
    GIVES(NULL, tyn_offline_output(NULL, TYN_OUTPUT_RADIANCE));
    DOES_NOTHING(tyn_offline_report(NULL, &report));
    DOES_NOTHING(tyn_offline_report(NULL, NULL));
    GIVES(NULL, tyn_offline_context(NULL));
    GIVES(0, tyn_offline_setup_ms(NULL));
    GIVES(0, tyn_offline_frame_ms(NULL));
    REFUSED_SILENTLY(tyn_offline_time_pass(NULL, tyn_pass_at(0), NULL, 1, &(double){0}));
}

static void registry(void **state)
{
    (void)state;
    tyn_settings *s = NULL;
    tyn_method_info info;
    float params[256];
    char line[8] = "x";
    const tyn_regime regime = {0};
    GIVES(NULL, tyn_pass_at(UINT32_MAX));
    DOES_NOTHING(tyn_method_at(0, NULL));
    DOES_NOTHING(tyn_method_at(UINT32_MAX, &info));
    assert_null(info.name);
    GIVES(false, tyn_method_named("none", NULL));
    GIVES(true, tyn_method_named(NULL, NULL));
    REFUSED_SILENTLY(tyn_settings_create(NULL));
    assert_int_equal(tyn_settings_create(&s), TYN_OK);
    REFUSED(tyn_settings_set(NULL, "lattice.cells", "8", log));
    REFUSED(tyn_settings_set(s, NULL, "8", log));
    REFUSED(tyn_settings_set(s, "lattice.cells", NULL, log));
    REFUSED(tyn_settings_set(s, "", "8", log));
    REFUSED(tyn_settings_set(s, ".", "8", log));
    REFUSED(tyn_settings_set(s, "lattice.", "8", log));
    REFUSED(tyn_settings_set(s, "lattice.cells", "", log));
    REFUSED(tyn_settings_set(s, "lattice.cells", "nan", log));
    REFUSED(tyn_settings_set(s, "lattice.cells", "8.5", log));
    REFUSED(tyn_settings_set(s, "lattice.cells", "1e9", log));
    REFUSED_SILENTLY(tyn_settings_set(s, "lattice.cells", "x", NULL));
    REFUSED(tyn_settings_quality(s, NULL, log));
    REFUSED(tyn_settings_quality(NULL, "high", log));
    REFUSED(tyn_settings_quality(s, "best", log));
    tyn_setting setting;
    REFUSED(tyn_settings_get(s, NULL, &setting, log));
    REFUSED(tyn_settings_get(s, "lattice.cells", NULL, log));
    REFUSED(tyn_settings_get(s, "lattice.cell", &setting, log));
    REFUSED(tyn_settings_get(NULL, "cells", &setting, log));
    DOES_NOTHING(tyn_settings_params(s, NULL, params));
    DOES_NOTHING(tyn_settings_params(s, tyn_pass_at(0), NULL));
    DOES_NOTHING(tyn_settings_params(NULL, NULL, NULL));
    DOES_NOTHING(tyn_pass_defaults(NULL, params));
    DOES_NOTHING(tyn_pass_defaults(tyn_pass_at(0), NULL));
    DOES_NOTHING(tyn_settings_destroy(NULL));
    tyn_settings_destroy(&s);
    DOES_NOTHING(tyn_settings_destroy(&s));
    assert_true(tyn_method_named("pop", &info));
    GIVES(NULL, tyn_limit_next(NULL, NULL, &regime));
    GIVES(NULL, tyn_limit_next(info.limits, NULL, NULL));
    GIVES(0, tyn_limit_error(NULL, &regime));
    GIVES(0, tyn_limit_error(info.limits, NULL));
    DOES_NOTHING(tyn_limit_say(NULL, NULL, NULL, line, sizeof line));
    assert_int_equal(line[0], 0);
    DOES_NOTHING(tyn_limit_say(info.limits, &info.limits->advice, &regime, NULL, 0));
}

// What was set is what is got; a preset takes the place of another and leaves other settings.
static void settings_and_presets(void **state)
{
    (void)state;
    tyn_settings *s;
    tyn_setting got;
    assert_int_equal(tyn_settings_create(&s), TYN_OK);
    assert_int_equal(tyn_settings_get(NULL, "lattice.cells", &got, &listener), TYN_OK);
    const double normal = got.value;
    assert_true(!got.given && got.param->type == TYN_PARAM_INT && !got.word);
    assert_int_equal(tyn_settings_set(s, "lattice.sweeps", "7", &listener), TYN_OK);
    assert_int_equal(tyn_settings_set(s, "raymarch.antialias", "off", &listener), TYN_OK);
    assert_int_equal(tyn_settings_quality(s, "draft", &listener), TYN_OK);
    assert_int_equal(tyn_settings_get(s, "lattice.cells", &got, &listener), TYN_OK);
    assert_true(got.given && got.value < normal);
    assert_int_equal(tyn_settings_quality(s, "high", &listener), TYN_OK);
    assert_int_equal(tyn_settings_get(s, "lattice.cells", &got, &listener), TYN_OK);
    assert_true(got.given && got.value > normal);
    assert_int_equal(tyn_settings_get(s, "lattice.sweeps", &got, &listener), TYN_OK);
    assert_false(got.given); // a preset's
    assert_int_equal(tyn_settings_get(s, "raymarch.antialias", &got, &listener), TYN_OK);
    assert_true(got.given && got.value == 0);
    assert_int_equal(tyn_settings_quality(s, "normal", &listener), TYN_OK);
    assert_int_equal(tyn_settings_get(s, "lattice.cells", &got, &listener), TYN_OK);
    assert_true(!got.given && got.value == normal);
    for (uint32_t i = 0; i < tyn_num_passes(); i++) { // words have their names
        const tyn_pass_desc *pass = tyn_pass_at(i);
        for (uint32_t k = 0; k < pass->num_params; k++) {
            char name[128];
            snprintf(name, sizeof name, "%s.%s", pass->name, pass->params[k].name);
            assert_int_equal(tyn_settings_get(NULL, name, &got, &listener), TYN_OK);
            assert_true(got.value == pass->params[k].def);
            assert_true((got.word != NULL) == (pass->params[k].type == TYN_PARAM_ENUM));
        }
    }
    tyn_settings_destroy(&s);
}

static void scenes(void **state)
{
    (void)state;
    tyn_scene scene;
    float lo[3] = {1, 1, 1}, hi[3];
    tyn_camera camera;
    const float here[3] = {1, 2, 3};
    DOES_NOTHING(tyn_scene_init(NULL));
    DOES_NOTHING(tyn_scene_finish(NULL));
    DOES_NOTHING(tyn_scene_warn(NULL, "x"));
    tyn_scene_init(&scene);
    DOES_NOTHING(tyn_scene_warn(&scene, NULL));
    DOES_NOTHING(tyn_medium_clear(NULL));
    GIVES(false, tyn_scene_bounds(NULL, lo, hi));
    assert_true(lo[0] == 0 && hi[2] == 0);
    GIVES(false, tyn_scene_bounds(&scene, NULL, NULL));
    DOES_NOTHING(tyn_camera_frame_scene(NULL, &scene));
    DOES_NOTHING(tyn_camera_frame_scene(&camera, NULL));
    REFUSED_SILENTLY(tyn_camera_look_at(NULL, here, here));
    REFUSED_SILENTLY(tyn_camera_look_at(&camera, NULL, here));
    REFUSED_SILENTLY(tyn_camera_look_at(&camera, here, NULL));
    REFUSED_SILENTLY(tyn_camera_look_at(&camera, here, here));
    REFUSED(tyn_scene_override(NULL, &(tyn_medium_override){0}, log));
    REFUSED(tyn_scene_override(&scene, NULL, log));
    REFUSED(tyn_scene_check(NULL, log));
    REFUSED_SILENTLY(tyn_scene_check(NULL, NULL));
    GIVES(0, tyn_environment_suns(NULL, NULL));
    GIVES(0, tyn_environment_suns(&scene.environment, NULL));
    GIVES(NULL, tyn_light_traits_of((tyn_light_kind)77));
    GIVES(0, tyn_light_solid_angle(NULL));
    DOES_NOTHING(tyn_phase_get(NULL, NULL, lo));
    DOES_NOTHING(tyn_phase_set(NULL, NULL, lo));
    tyn_scene_finish(&scene);
}

// Everything in a scene that may be wrong, one at a time, of a scene that is right.
static tyn_result check_with(int fault)
{
    static tyn_volume volume;
    static float data[8] = {0, 1, 0, 1, 0, 1, 0, 1};
    static tyn_surface_vertex vertices[3];
    static tyn_surface_triangle triangle;
    static tyn_surface_material material;
    static tyn_camera camera;
    tyn_scene s;
    tyn_scene_init(&s);
    volume = (tyn_volume){.size = {2, 2, 2}, .data = data, .max_density = 1};
    s.volumes = &volume;
    s.num_volumes = s.num_media = s.num_shapes = s.num_lights = s.num_cameras = 1;
    s.media[0] = (tyn_medium){.sigma_s = {1, 1, 1}};
    s.shapes[0] = (tyn_shape){.to_world = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
    s.lights[0] = (tyn_light){.color = {1, 1, 1}, .direction = {0, -1, 0}};
    camera = (tyn_camera){.right = {1, 0, 0}, .up = {0, 1, 0}, .back = {0, 0, 1}, .yfov = 1};
    s.cameras = &camera;
    s.environment.present = true;
    for (int i = 0; i < 3; i++) {
        vertices[i] = (tyn_surface_vertex){.normal = {0, 1, 0}, .position = {i == 1, 0, i == 2}};
    }
    triangle = (tyn_surface_triangle){.vertices = {0, 1, 2}};
    material = (tyn_surface_material){.texture = TYN_NO_TEXTURE};
    tyn_surfaces *f = &s.surfaces;
    *f = (tyn_surfaces){.vertices = vertices,
                        .num_vertices = 3,
                        .triangles = &triangle,
                        .num_triangles = 1,
                        .materials = &material,
                        .num_materials = 1};
    tyn_medium *m = &s.media[0];
    tyn_light *l = &s.lights[0];
    switch (fault) {
    case 1:
        s.volumes = NULL;
        break;
    case 2:
        s.cameras = NULL;
        break;
    case 3:
        f->vertices = NULL;
        break;
    case 4:
        f->triangles = NULL;
        break;
    case 5:
        f->materials = NULL;
        break;
    case 6:
        f->num_textures = 1;
        break;
    case 7:
        f->num_nodes = 1;
        break;
    case 8:
        volume.size[1] = 0;
        break;
    case 9:
        volume.max_density = NAN;
        break;
    case 10:
        volume.max_density = 0.5f;
        break;
    case 11:
        volume.data = NULL, volume.max_density = 0;
        break;
    case 12:
        m->sigma_s[0] = -1;
        break;
    case 13:
        m->sigma_a[1] = INFINITY;
        break;
    case 14:
        m->emission[2] = NAN;
        break;
    case 15:
        m->phase[0].g = 1;
        break;
    case 16:
        m->density_scale = -1;
        break;
    case 17:
        m->volume = 1;
        break;
    case 18:
        m->volume = -2;
        break;
    case 19:
        s.num_media = 17;
        break;
    case 20:
        s.num_shapes = 65;
        break;
    case 21:
        s.num_lights = 65;
        break;
    case 22:
        s.shapes[0].kind = (tyn_shape_kind)9;
        break;
    case 23:
        s.shapes[0].medium = 5;
        break;
    case 24:
        memset(s.shapes[0].to_world, 0, sizeof s.shapes[0].to_world);
        break;
    case 25:
        s.shapes[0].to_world[5] = NAN;
        break;
    case 26:
        s.shapes[0].kind = TYN_SHAPE_SPHERE, s.shapes[0].repeat[0] = true;
        break;
    case 27:
        l->kind = (tyn_light_kind)9;
        break;
    case 28:
        l->color[0] = NAN;
        break;
    case 29:
        memset(l->direction, 0, sizeof l->direction);
        break;
    case 30:
        l->kind = TYN_LIGHT_POINT, l->position[0] = INFINITY;
        break;
    case 31:
        l->kind = TYN_LIGHT_SPOT, l->cos_inner = 0.1f, l->cos_outer = 0.5f;
        break;
    case 32:
        camera.projection = (tyn_projection)7;
        break;
    case 33:
        camera.yfov = 0;
        break;
    case 34:
        camera.up[1] = 0;
        break;
    case 35:
        camera.projection = TYN_ORTHOGRAPHIC;
        break;
    case 36:
        camera.position[2] = NAN;
        break;
    case 37:
        s.environment.radiance[0] = -1;
        break;
    case 38:
        s.environment.strength = NAN;
        break;
    case 39:
        s.environment.rotation[0] = 3;
        break;
    case 40:
        s.environment.size[0] = s.environment.size[1] = 4;
        break;
    case 41:
        vertices[1].position[0] = NAN;
        break;
    case 42:
        memset(vertices[1].normal, 0, sizeof vertices[1].normal);
        break;
    case 43:
        triangle.vertices[2] = 3;
        break;
    case 44:
        triangle.material = 1;
        break;
    case 45:
        material.albedo[0] = 2;
        break;
    case 46:
        material.emission[0] = NAN;
        break;
    case 47:
        material.texture = 0;
        break;
    case 48:
        material.flags = 8;
        break;
    default:
        break;
    }
    return tyn_scene_check(&s, &listener);
}

static void faults_of_scenes(void **state)
{
    (void)state;
    assert_int_equal(check_with(0), TYN_OK);
    for (int fault = 1; fault <= 48; fault++) {
        REFUSED(check_with(fault));
    }
}

// {0} is the default of what is not required.
static void defaults(void **state)
{
    (void)state;
    tyn_medium medium = {0};
    assert_true(tyn_medium_scale(&medium) == 1);
    medium.density_scale = 0.25f;
    assert_true(tyn_medium_scale(&medium) == 0.25f);
    tyn_environment environment = {.present = true};
    assert_true(tyn_environment_strength(&environment) == 1);
}

static void files(void **state)
{
    (void)state;
    tyn_scene scene;
    tyn_volume volume;
    tyn_environment env = {0};
    tyn_surfaces surfaces = {.num_triangles = 1};
    tyn_image_file image = {0}, hollow = {.width = 1, .height = 1, .num_channels = 1};
    tyn_channel channel = {.name = "R"};
    uint32_t w, h;
    uint8_t *rgba;
    void *data;
    size_t size;
    const uint8_t pixel[4] = {0};
    REFUSED(tyn_scene_load(NULL, "x.gltf", NULL, log));
    REFUSED(tyn_scene_load(&scene, NULL, NULL, log));
    REFUSED(tyn_scene_load(&scene, "", NULL, log));
    REFUSED(tyn_scene_load(&scene, "/", NULL, log));
    REFUSED(tyn_scene_load(&scene, "/nowhere/x.gltf", NULL, log));
    REFUSED(tyn_scene_load_frame(&scene, NULL, NULL, 1, log));
    REFUSED(tyn_volume_load(NULL, "x.nvdb", NULL, NULL, log));
    REFUSED(tyn_volume_load(&volume, NULL, NULL, NULL, log));
    REFUSED(tyn_volume_load(&volume, "x", NULL, NULL, log));
    DOES_NOTHING(tyn_volume_finish(NULL));
    REFUSED(tyn_environment_load(NULL, "x.hdr", log));
    REFUSED(tyn_environment_load(&env, NULL, log));
    REFUSED(tyn_environment_load(&env, "x.hdr", log));
    REFUSED(tyn_surfaces_build_nodes(NULL, log));
    REFUSED(tyn_surfaces_build_nodes(&surfaces, log));
    REFUSED(tyn_exr_read(NULL, "x.exr", log));
    REFUSED(tyn_exr_read(&image, NULL, log));
    REFUSED(tyn_exr_write(NULL, "x.exr", false, log));
    REFUSED(tyn_exr_write(&image, NULL, false, log));
    REFUSED(tyn_exr_write(&image, "x.exr", false, log));
    REFUSED(tyn_exr_write(&hollow, "x.exr", false, log));
    hollow.channels = &channel;
    REFUSED(tyn_exr_write(&hollow, "x.exr", false, log));
    DOES_NOTHING(tyn_image_file_finish(NULL));
    GIVES(NULL, tyn_image_file_channel(NULL, "R"));
    GIVES(NULL, tyn_image_file_channel(&image, NULL));
    REFUSED(tyn_png_write(NULL, 1, 1, 4, pixel, log));
    REFUSED(tyn_png_write("x.png", 1, 1, 4, NULL, log));
    REFUSED(tyn_png_write("x.png", 0, 1, 4, pixel, log));
    REFUSED(tyn_png_write("x.png", 1, 1, 2, pixel, log));
    REFUSED(tyn_png_read(NULL, &w, &h, &rgba, log));
    REFUSED(tyn_png_read("x.png", NULL, NULL, NULL, log));
    REFUSED(tyn_file_read(NULL, 1, &data, &size, log));
    REFUSED(tyn_file_read("x", 1, NULL, NULL, log));
    REFUSED(tyn_file_write(NULL, pixel, 1, log));
    REFUSED(tyn_file_write("x", NULL, 1, log));
    REFUSED(tyn_file_write("/nowhere/x", pixel, 1, log));
}

static int all_counted(void **state)
{
    (void)state;
    print_message("%d cases\n", cases);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(null_handles),
        cmocka_unit_test(registry),
        cmocka_unit_test(settings_and_presets),
        cmocka_unit_test(scenes),
        cmocka_unit_test(faults_of_scenes),
        cmocka_unit_test(defaults),
        cmocka_unit_test(files),
    };
    return cmocka_run_group_tests(tests, NULL, all_counted);
}
