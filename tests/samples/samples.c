// samples.c -- the sample scenes are what they are said to be: they load, the smoke fills its part of
// the picture, the cloud is thick. argv[1] is their folder.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <tyndall/io.h>
#include <tyndall/offline.h>

static const char *folder;

static void on_log(void *user, tyn_log_level level, const char *message)
{
    (void)user;
    (void)level;
    print_message("%s\n", message);
}
static const tyn_log log_all = {on_log, NULL, TYN_LOG_WARN};

static tyn_scene load(const char *name)
{
    char path[4096];
    snprintf(path, sizeof(path), "%s/%s.gltf", folder, name);
    tyn_scene scene;
    tyn_scene_init(&scene);
    assert_int_equal(tyn_scene_load(&scene, path, NULL, &log_all), TYN_OK);
    assert_int_equal(scene.num_warnings, 0);
    return scene;
}

static void all_load(void **state)
{
    (void)state;
    static const char *const names[] = {"cube",    "cube-oblique",  "sphere",   "slab",
                                        "slab-60", "furnace",       "smoke",    "cloud",
                                        "empty",   "furnace-smoke", "two-media"};
    for (size_t i = 0; i < sizeof(names) / sizeof(names[0]); i++) {
        tyn_scene scene = load(names[i]);
        assert_int_equal(tyn_scene_check(&scene, &log_all), TYN_OK);
        assert_true(scene.num_cameras >= 1);
        tyn_scene_finish(&scene);
    }
}

// The largest optical depth of a column of voxels along an axis.
static float thickest_column(const tyn_scene *scene, int axis)
{
    const tyn_volume *v = &scene->volumes[0];
    const tyn_medium *m = &scene->media[0];
    const int b = (axis + 1) % 3, c = (axis + 2) % 3;
    const float voxel = scene->shapes[0].to_world[5 * axis] / (float)v->size[axis];
    float most = 0;
    for (uint32_t j = 0; j < v->size[b]; j++) {
        for (uint32_t k = 0; k < v->size[c]; k++) {
            float sum = 0;
            for (uint32_t i = 0; i < v->size[axis]; i++) {
                uint32_t p[3];
                p[axis] = i;
                p[b] = j;
                p[c] = k;
                sum += v->data[((size_t)p[2] * v->size[1] + p[1]) * v->size[0] + p[0]];
            }
            most = fmaxf(most, sum * voxel * (m->sigma_s[0] + m->sigma_a[0]));
        }
    }
    return most;
}

static void cloud_is_thick(void **state)
{
    (void)state;
    tyn_scene scene = load("cloud");
    const float depth[3] = {thickest_column(&scene, 0), thickest_column(&scene, 1),
                            thickest_column(&scene, 2)};
    print_message("cloud: optical depth %.1f, %.1f, %.1f along x, y, z\n", (double)depth[0],
                  (double)depth[1], (double)depth[2]);
    assert_true(depth[0] > 50 && depth[1] > 50 && depth[2] > 50);
    assert_true(scene.media[0].g[0] == 0.85f);
    tyn_scene_finish(&scene);
}

// Nothing is cut off at the sides of the box.
static void smoke_is_inside(void **state)
{
    (void)state;
    tyn_scene scene = load("smoke");
    const tyn_volume *v = &scene.volumes[0];
    assert_true(v->size[0] >= 96 && v->size[1] >= 160 && v->size[2] >= 96);
    float edge = 0;
    for (uint32_t z = 0; z < v->size[2]; z++) {
        for (uint32_t y = 0; y < v->size[1]; y++) {
            for (uint32_t x = 0; x < v->size[0]; x++) {
                if (x == 0 || y == 0 || z == 0 || x + 1 == v->size[0] || y + 1 == v->size[1] ||
                    z + 1 == v->size[2]) {
                    edge = fmaxf(edge, v->data[((size_t)z * v->size[1] + y) * v->size[0] + x]);
                }
            }
        }
    }
    print_message("smoke: density at most %g at the faces of its box, %g inside\n", (double)edge,
                  (double)v->max_density);
    assert_true(edge < 0.02f);
    tyn_scene_finish(&scene);
}

// 40 +- 5 % of the pixels of a square picture have at least 1 % of the smoke in front of them.
static void smoke_fills_the_picture(void **state)
{
    (void)state;
    enum { SIZE = 512 };
    tyn_device *dev = NULL;
    if (tyn_device_open(tyn_device_open_params(.log = log_all), &dev) != TYN_OK) {
        print_message("skipped: no device\n");
        skip();
    }
    tyn_offline *off = NULL;
    assert_int_equal(tyn_offline_create(dev, tyn_offline_params(.method = "single"), &off), TYN_OK);
    tyn_scene scene = load("smoke");
    const tyn_view view = {.camera = scene.cameras[0],
                           .width = SIZE,
                           .height = SIZE,
                           .outputs = TYN_OUTPUT_RADIANCE,
                           .no_background = true};
    assert_int_equal(tyn_offline_frame(off, &scene, &view, false), TYN_OK);
    const float *rgba = tyn_offline_output(off, TYN_OUTPUT_RADIANCE);
    uint32_t covered = 0;
    for (size_t i = 0; i < (size_t)SIZE * SIZE; i++) {
        covered += rgba[4 * i + 3] >= 0.01f;
    }
    const double percent = 100.0 * covered / (SIZE * SIZE);
    print_message("smoke: covers %.1f %% of %d x %d pixels\n", percent, SIZE, SIZE);
    assert_true(percent >= 35 && percent <= 45);
    tyn_scene_finish(&scene);
    tyn_offline_destroy(&off);
    tyn_device_destroy(&dev);
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: samples FOLDER\n");
        return 2;
    }
    folder = argv[1];
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_load),
        cmocka_unit_test(cloud_is_thick),
        cmocka_unit_test(smoke_is_inside),
        cmocka_unit_test(smoke_fills_the_picture),
    };
    return cmocka_run_group_tests_name("samples", tests, NULL, NULL);
}
