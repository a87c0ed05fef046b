// samples.c -- the sample scenes are what they are said to be: they load, the smoke fills its part of
// the picture, the cloud is thick, the sky has its sun. argv[1] is their folder.
#include "offline_frame.h"
#include "numbers.h"
#include "scenes.h"
#include "skip.h"
#include <tyndall/offline.h>

static void all_load(void **state)
{
    (void)state;
    static const char *const names[] = {
        "cube",        "cube-oblique", "sphere",  "slab",           "slab-60",
        "furnace",     "smoke",        "cloud",   "furnace-smoke",  "two-media",
        "smoke-sky",   "cloud-sunset", "milk",    "plume-contrast", "empty",
        "room",        "fog-hall",     "lantern", "cornell-smoke",  "vpl-cave",
        "many-lights",
    };
    for (size_t i = 0; i < sizeof(names) / sizeof(names[0]); i++) {
        tyn_scene scene = scenes_load(names[i]);
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
            most = (float)maximum(most, sum * voxel * (m->sigma_s[0] + m->sigma_a[0]));
        }
    }
    return most;
}

static void cloud_is_thick(void **state)
{
    (void)state;
    tyn_scene scene = scenes_load("cloud");
    const float depth[3] = {thickest_column(&scene, 0), thickest_column(&scene, 1),
                            thickest_column(&scene, 2)};
    print_message("cloud: optical depth %.1f, %.1f, %.1f along x, y, z\n", (double)depth[0],
                  (double)depth[1], (double)depth[2]);
    assert_true(depth[0] > 50 && depth[1] > 50 && depth[2] > 50);
    assert_true(scene.media[0].phase[0].g == 0.85f);
    tyn_scene_finish(&scene);
}

// Nothing is cut off at the sides of the box.
static void smoke_is_inside(void **state)
{
    (void)state;
    tyn_scene scene = scenes_load("smoke");
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

// Irradiance of a map on a plane that faces `towards`, from within `cosine` of that direction.
static double irradiance(const tyn_environment *e, const double towards[3], double cosine,
                         double *brightest, double *darkest)
{
    const double pi = 3.14159265358979;
    double sum = 0;
    *brightest = 0;
    *darkest = 1e30;
    for (uint32_t y = 0; y < e->size[1]; y++) {
        const double t0 = pi * y / e->size[1], t1 = pi * (y + 1) / e->size[1], t = 0.5 * (t0 + t1);
        const double solid = 2 * pi / e->size[0] * (cos(t0) - cos(t1));
        for (uint32_t x = 0; x < e->size[0]; x++) {
            const double phi = 2 * pi * ((x + 0.5) / e->size[0] - 0.5);
            const double c = sin(t) * sin(phi) * towards[0] + cos(t) * towards[1] -
                             sin(t) * cos(phi) * towards[2];
            const float *rgb = e->data + 3 * ((size_t)y * e->size[0] + x);
            const double grey = ((double)rgb[0] + (double)rgb[1] + (double)rgb[2]) / 3;
            sum += c > cosine ? grey * c * solid : 0;
            *brightest = grey > *brightest ? grey : *brightest;
            *darkest = grey < *darkest ? grey : *darkest;
        }
    }
    return sum;
}

// The clear sky: the sun stands where it is said to, and gives most of the light.
static void sky_has_its_sun(void **state)
{
    (void)state;
    tyn_scene scene = scenes_load("smoke-sky");
    const double pi = 3.14159265358979, e = 35 * pi / 180, a = 75 * pi / 180;
    const double sun[3] = {cos(e) * sin(a), sin(e), -cos(e) * cos(a)}, up[3] = {0, 1, 0};
    double bright, dark;
    const double direct = irradiance(&scene.environment, sun, cos(1.0 * pi / 180), &bright, &dark);
    const double all = irradiance(&scene.environment, up, 0, &bright, &dark);
    const double sky = all - direct * sin(e);
    print_message(
        "clear sky: sun %.2f W/m^2, sky %.2f W/m^2 on the ground, radiance %.2f to %.0f\n", direct,
        sky, dark, bright);
    // 12 W/m^2 above the atmosphere, of which a clear one lets three quarters through; a clear sky
    // gives a tenth to a third of what falls on the ground.
    assert_true(direct > 0.6 * 12 && direct < 0.9 * 12);
    assert_true(sky > 0.1 * all && sky < 0.33 * all);
    tyn_environment_sun suns[TYN_MAX_MAP_SUNS];
    assert_int_equal(tyn_environment_suns(&scene.environment, suns), 1);
    double cosine = 0, found = 0;
    for (int k = 0; k < 3; k++) {
        cosine -= (double)suns[0].direction[k] * sun[k];
        found += (double)suns[0].irradiance[k] / 3;
    }
    assert_true(cosine > cos(0.3 * pi / 180) && fabs(found / direct - 1) < 0.02);
    tyn_scene_finish(&scene);
}

static void courtyard_has_contrast(void **state)
{
    (void)state;
    tyn_scene scene = scenes_load("plume-contrast");
    const double up[3] = {0, 1, 0};
    double bright, dark;
    const double down = irradiance(&scene.environment, up, 0, &bright, &dark);
    print_message("courtyard: radiance %.3f to %.2f, %.2f W/m^2 on the ground\n", dark, bright,
                  down);
    assert_true(bright > 100 * dark && bright < 20);
    tyn_scene_finish(&scene);
}

// The milk absorbs less than one part in a thousand, and is some hundred mean free paths thick.
static void milk_is_thick(void **state)
{
    (void)state;
    tyn_scene scene = scenes_load("milk");
    const tyn_medium *m = &scene.media[0];
    for (int k = 0; k < 3; k++) {
        assert_true(m->sigma_a[k] < 1e-3f * m->sigma_s[k]);
    }
    const float across = thickest_column(&scene, 0), up = thickest_column(&scene, 1);
    print_message("milk: optical depth %.0f across, %.0f up\n", (double)across, (double)up);
    assert_true(across > 100 && up > 200);
    tyn_scene_finish(&scene);
}

// 40 +- 5 % of the pixels of a square picture have at least 1 % of the smoke in front of them.
static void smoke_fills_the_picture(void **state)
{
    (void)state;
    enum { SIZE = 512 };
    tyn_device *dev = NULL;
    if (tyn_device_open(tyn_device_open_params(.log = scenes_log), &dev) != TYN_OK) {
        skip_case("no device");
    }
    tyn_offline *off = NULL;
    assert_int_equal(tyn_offline_create(dev, tyn_offline_params(.method = "single"), &off), TYN_OK);
    tyn_scene scene = scenes_load("smoke");
    const tyn_view view = {.camera = scene.cameras[0],
                           .width = SIZE,
                           .height = SIZE,
                           .outputs = TYN_OUTPUT_RADIANCE,
                           .no_background = true};
    offline_frame(off, &scene, &view);
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
    if (!scenes_folder(argc, argv)) {
        return 2;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_load),
        cmocka_unit_test(cloud_is_thick),
        cmocka_unit_test(smoke_is_inside),
        cmocka_unit_test(sky_has_its_sun),
        cmocka_unit_test(courtyard_has_contrast),
        cmocka_unit_test(milk_is_thick),
        cmocka_unit_test(smoke_fills_the_picture),
    };
    return run_cases(tests, NULL, NULL);
}
