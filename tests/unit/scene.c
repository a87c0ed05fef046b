// scene.c -- checks, bounds, overrides and cameras of scenes filled by hand.
#include <tyndall/scene.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "io_test.h"

// A homogeneous sphere of radius 2 at (1, 2, 3) under a sun.
static void fill(tyn_scene *scene)
{
    tyn_scene_init(scene);
    scene->num_media = scene->num_shapes = scene->num_lights = 1;
    scene->media[0] =
        (tyn_medium){.sigma_s = {1, 2, 3}, .sigma_a = {1, 0, 1}, .density_scale = 1, .volume = -1};
    scene->shapes[0] = (tyn_shape){.kind = TYN_SHAPE_SPHERE,
                                   .to_world = {4, 0, 0, 0, 0, 4, 0, 0, 0, 0, 4, 0, 1, 2, 3, 1}};
    scene->lights[0] = (tyn_light){.color = {1, 1, 1}, .direction = {0, -1, 0}};
}

static void near3(const float a[3], float x, float y, float z)
{
    assert_true(fabsf(a[0] - x) + fabsf(a[1] - y) + fabsf(a[2] - z) < 1e-5f);
}

static void bounds(void **state)
{
    tyn_scene scene;
    float lo[3], hi[3];
    (void)state;
    tyn_scene_init(&scene);
    assert_false(tyn_scene_bounds(&scene, lo, hi));
    fill(&scene);
    assert_true(tyn_scene_bounds(&scene, lo, hi));
    near3(lo, -1, 0, 1);
    near3(hi, 3, 4, 5);
    // Turned by 45 degrees about z, a box reaches further and a sphere does not.
    const float s = sqrtf(0.5f) * 4;
    const float turned[16] = {s, s, 0, 0, -s, s, 0, 0, 0, 0, 4, 0, 1, 2, 3, 1};
    memcpy(scene.shapes[0].to_world, turned, sizeof turned);
    tyn_scene_bounds(&scene, lo, hi);
    near3(lo, -1, 0, 1);
    scene.shapes[0].kind = TYN_SHAPE_BOX;
    tyn_scene_bounds(&scene, lo, hi);
    near3(hi, 1 + sqrtf(8), 2 + sqrtf(8), 5);
    tyn_scene_finish(&scene);
}

static void framing(void **state)
{
    tyn_scene scene;
    tyn_camera camera;
    (void)state;
    fill(&scene);
    tyn_camera_frame_scene(&camera, &scene);
    float d[3] = {camera.position[0] - 1, camera.position[1] - 2, camera.position[2] - 3};
    float distance = sqrtf(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    // The bounding sphere (of the box, radius 2 sqrt 3) fills the 40 degrees.
    assert_true(fabsf(camera.yfov - 40 * 3.14159265f / 180) < 1e-6f);
    assert_true(fabsf(distance * sinf(camera.yfov / 2) - 2 * sqrtf(3)) < 1e-4f);
    assert_true(camera.position[1] > 2); // from above
    near3(camera.back, d[0] / distance, d[1] / distance, d[2] / distance);
    near3(camera.right, 1, 0, 0);
    tyn_scene_finish(&scene);
    tyn_scene_init(&scene); // nothing to frame: still a camera
    tyn_camera_frame_scene(&camera, &scene);
    assert_true(isfinite(camera.position[2]) && camera.position[2] > 0);
}

static void look_at(void **state)
{
    tyn_camera camera = {0};
    (void)state;
    assert_int_equal(tyn_camera_look_at(&camera, (float[]){0, 0, 5}, (float[]){0, 0, 0}), TYN_OK);
    near3(camera.right, 1, 0, 0);
    near3(camera.up, 0, 1, 0);
    near3(camera.back, 0, 0, 1);
    assert_int_equal(tyn_camera_look_at(&camera, (float[]){3, 9, 1}, (float[]){3, 2, 1}), TYN_OK);
    near3(camera.up, 0, 0, -1); // straight down
    near3(camera.right, 1, 0, 0);
    assert_int_equal(tyn_camera_look_at(&camera, (float[]){1, 1, 1}, (float[]){1, 1, 1}),
                     TYN_ERR_PARAMS);
}

static void override(void **state)
{
    tyn_scene scene;
    io_log log;
    (void)state;
    io_log_init(&log);
    fill(&scene);
    tyn_medium_override o = {.albedo = (float[]){0.5f, 0.25f, 1}, .density_scale = 3};
    assert_int_equal(tyn_scene_override(&scene, &o, &log.log), TYN_OK);
    near3(scene.media[0].sigma_s, 1, 0.5f, 4); // sigma_t (2, 2, 4) is kept
    near3(scene.media[0].sigma_a, 1, 1.5f, 0);
    assert_true(scene.media[0].density_scale == 3);
    o = (tyn_medium_override){.sigma_s = (float[]){5, 5, 5}, .g = (float[]){0.1f, 0.2f, 0.3f}};
    assert_int_equal(tyn_scene_override(&scene, &o, &log.log), TYN_OK);
    near3(scene.media[0].sigma_s, 5, 5, 5);
    float g[3];
    tyn_phase_get(scene.media[0].phase, tyn_phase_parameters(), g);
    near3(g, 0.1f, 0.2f, 0.3f);
    assert_true(scene.media[0].density_scale == 3);
    const tyn_medium_override bad[] = {{.sigma_s = (float[]){-1, 0, 0}},
                                       {.sigma_a = (float[]){NAN, 0, 0}},
                                       {.g = (float[]){0, 1, 0}},
                                       {.albedo = (float[]){0, 0, 1.5f}},
                                       {.sigma_s = (float[]){INFINITY, 0, 0}},
                                       {.density_scale = INFINITY}};
    for (int i = 0; i < 6; i++) {
        io_log_init(&log);
        assert_int_equal(tyn_scene_override(&scene, &bad[i], &log.log), TYN_ERR_PARAMS);
        assert_int_equal(log.errors, 1);
    }
    tyn_scene_finish(&scene);
}

static void check(void **state)
{
    (void)state;
    for (int fault = -1; fault < 16; fault++) {
        tyn_scene s;
        tyn_camera camera = {.right = {1}, .up = {0, 1}, .back = {0, 0, 1}, .yfov = 1};
        float texel[3] = {1, 1, 1}, voxels[2] = {1, 2};
        tyn_volume volume = {.size = {2, 1, 1}, .data = voxels, .max_density = 2};
        io_log log;
        io_log_init(&log);
        fill(&s);
        s.cameras = &camera;
        s.num_cameras = 1;
        s.volumes = &volume;
        s.num_volumes = 1;
        s.environment.present = true;
        s.environment.size[0] = s.environment.size[1] = 1;
        s.environment.data = texel;
        switch (fault) {
        case 0:
            s.media[0].sigma_s[1] = -1;
            break;
        case 1:
            s.media[0].phase[2].g = 1;
            break;
        case 2:
            s.media[0].volume = 1;
            break;
        case 3:
            s.media[0].density_scale = NAN;
            break;
        case 4:
            s.shapes[0].medium = 7;
            break;
        case 5:
            s.shapes[0].to_world[0] = 0;
            break;
        case 6:
            s.shapes[0].to_world[3] = 1;
            break;
        case 7:
            s.shapes[0].repeat[0] = true;
            break; // a sphere
        case 8:
            s.lights[0].direction[1] = 0;
            break;
        case 9:
            s.lights[0].color[0] = INFINITY;
            break;
        case 10:
            camera.yfov = 4;
            break;
        case 11:
            camera.up[0] = 0.5f;
            break;
        case 12:
            s.environment.strength = -1;
            break;
        case 13:
            texel[1] = NAN;
            break;
        case 14:
            voxels[1] = -1;
            break;
        case 15:
            volume.size[2] = 0;
            break;
        }
        assert_int_equal(tyn_scene_check(&s, &log.log), fault < 0 ? TYN_OK : TYN_ERR_PARAMS);
        assert_int_equal(log.errors, fault >= 0);
        assert_int_equal(log.newlines, 0);
    }
}

// Grids of colours: each fault of them is one line, and an albedo from the command line drops a grid of it.
static void check_color_grids(void **state)
{
    (void)state;
    static const char *const lines[] = {
        "color_grids[0].size[1] = 0: must be 1 to 65536",
        "color_grids[0].channels = 2: must be 1 or 3",
        "color_grids[0].data = NULL: required",
        "color_grids[0].max = nan: must be >= 0",
        "color_grids[0].data[4] = nan: must be between 0 and max = 1",
        "color_grids[0].data[0] = -1: must be between 0 and max = 1",
        "color_grids[0].data[5] = 2: must be between 0 and max = 1",
        "media[0].radiance_grid = 2: there are 1 color_grids",
        "media[0].albedo_grid: color_grids[0].max = 4: an albedo must be 0 to 1",
        "color_grids = NULL, but there are to be 1"};
    for (int fault = -1; fault < 10; fault++) {
        tyn_scene s;
        float values[6] = {0, 0.5f, 1, 0, 0.25f, 1};
        tyn_color_grid grid = {.size = {2, 1, 1}, .channels = 3, .data = values, .max = 1};
        io_log log;
        io_log_init(&log);
        fill(&s);
        s.color_grids = &grid;
        s.num_color_grids = 1;
        s.media[0].albedo_grid = s.media[0].emission_grid = s.media[0].radiance_grid = 1;
        const float wrong = fault == 4 ? NAN : fault == 5 ? -1 : 2;
        grid.size[1] = fault != 0;
        grid.channels = fault == 1 ? 2 : 3;
        grid.data = fault == 2 ? NULL : values;
        grid.max = fault == 3 ? NAN : fault == 8 ? 4 : 1;
        values[fault == 4 ? 4 : fault == 5 ? 0 : 5] = fault >= 4 && fault <= 6 ? wrong : 1;
        s.media[0].radiance_grid += fault == 7;
        s.color_grids = fault == 9 ? NULL : &grid;
        assert_int_equal(tyn_scene_check(&s, &log.log), fault < 0 ? TYN_OK : TYN_ERR_PARAMS);
        assert_int_equal(log.errors, fault >= 0);
        if (fault >= 0 && !strstr(log.last, lines[fault])) {
            print_error("%s\n", log.last);
        }
        assert_true(fault < 0 || strstr(log.last, lines[fault]));
    }
    tyn_scene s;
    fill(&s);
    s.media[0].albedo_grid = s.media[0].emission_grid = 1;
    const tyn_medium_override o = {.albedo = (float[]){0.5f, 0.5f, 0.5f}};
    assert_int_equal(tyn_scene_override(&s, &o, NULL), TYN_OK);
    assert_true(s.media[0].albedo_grid == 0 && s.media[0].emission_grid == 1);
    tyn_medium_clear(&s.media[0]);
    assert_true(s.media[0].emission_grid == 0);
    tyn_scene_finish(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bounds),   cmocka_unit_test(framing), cmocka_unit_test(look_at),
        cmocka_unit_test(override), cmocka_unit_test(check),   cmocka_unit_test(check_color_grids)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
