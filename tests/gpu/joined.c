// joined.c -- kernels that are joined for cards and parted for software devices: pictures of surfaces are the same by both.
#include "gpu_test.h"
#include "numbers.h"
#include "picture.h"
#include "solids.h"
#include <math.h>

enum { SIZE = 48 };

// A room of walls that light each other, with a box in it and smoke; `sky`: without a ceiling, else with a lamp.
static void make_scene(tyn_scene *scene, bool sky)
{
    tyn_scene_init(scene);
    const tyn_medium smoke = grey_medium(0.4f, 0.1f, 0.5f);
    scene_add_box(scene, &smoke, (float[]){0, 0, 0}, (float[]){1, 1, 1}, NULL, NULL);
    scene_add_sun(scene, 0.3f, -0.9f, 0.2f, 3, 2, 1);
    const uint32_t white = solids_material(scene, (float[]){0.7f, 0.6f, 0.5f}, (float[3]){0});
    const uint32_t red = solids_material(scene, (float[]){0.8f, 0.2f, 0.1f}, (float[3]){0});
    solids_quad(scene, (float[]){0.02f, 0.02f, 0.02f}, (float[]){0, 0, 1.2f},
                (float[]){0.96f, 0, 0}, white);
    solids_quad(scene, (float[]){0.02f, 0.02f, 0.02f}, (float[]){0, 1, 0}, (float[]){0, 0, 1.2f},
                red);
    solids_quad(scene, (float[]){0.02f, 0.02f, 0.02f}, (float[]){0.96f, 0, 0}, (float[]){0, 1, 0},
                white);
    solids_box(scene, (float[]){0.4f, 0.02f, 0.3f}, (float[]){0.7f, 0.45f, 0.6f}, 0.4f, false,
               white);
    solids_hierarchy(scene, 2);
    if (sky) {
        scene_set_sky(scene, 0.3f);
    } else {
        scene->lights[scene->num_lights++] = (tyn_light){
            .kind = TYN_LIGHT_POINT, .color = {0.2f, 0.3f, 0.4f}, .position = {0.25f, 0.7f, 0.7f}};
    }
}

static void same_picture(void **state)
{
    gpu_test *t = *state;
    const tyn_capacity own = t->dev->capacity;
    // Rays of nodes and pixels, pixels and listed ones of surfaces; with `step`, smooth light of surfaces in places two apart.
    static const char *const settings[2] = {"medium.storage=float lattice.cells=16",
                                            "medium.storage=float lattice.cells=16 shade.step=2"};
    for (int i = 0; i < 2; i++) {
        tyn_scene scene;
        make_scene(&scene, i == 1);
        tyn_view view = {.width = SIZE, .height = SIZE};
        view.camera.yfov = 0.7f;
        assert_int_equal(tyn_camera_look_at(&view.camera, (float[]){1.4f, 1.1f, 2.2f},
                                            (float[]){0.5f, 0.4f, 0.4f}),
                         TYN_OK);
        picture parted, joined;
        t->dev->capacity = (tyn_capacity){.software = true};
        picture_render(&parted, t->dev, "pop", &scene, &view, settings[i], 1);
        t->dev->capacity = (tyn_capacity){.threads = 65536};
        picture_render(&joined, t->dev, "pop", &scene, &view, settings[i], 1);
        t->dev->capacity = own;
        double light = 0, most = 0;
        for (uint32_t k = 0; k < 3 * SIZE * SIZE; k++) {
            light += (double)parted.rgb[k] / (3 * SIZE * SIZE);
        }
        for (uint32_t k = 0; k < 3 * SIZE * SIZE; k++) {
            const double right = (double)parted.rgb[k];
            most = maximum(most, fabs((double)joined.rgb[k] - right) / (right + 0.1 * light));
        }
        print_message("%s: mean %g, a pixel %g apart at most\n", i ? "sky" : "lamp", light, most);
        assert_true(light > 0);
        assert_true(most <= 1e-5); // rounding
        picture_free(&parted);
        picture_free(&joined);
        tyn_scene_finish(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(same_picture)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
