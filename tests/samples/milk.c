// milk.c -- the thick milk is solved in six sweeps, where plain iteration takes more than a hundred.
// argv[1] is the folder of the sample scenes.
#include "numbers.h"
#include "offline_frame.h"
#include "scenes.h"
#include "skip.h"
#include <tyndall/offline.h>

typedef struct solver {
    const char *name;
    const char *cycles, *anderson; // of the lattice
    int sweeps;
    double least, most; // of the imbalance of any channel
} solver;

// The largest imbalance of a channel: what neither left the box nor was absorbed, of what came in.
static double imbalance(tyn_device *dev, const tyn_scene *scene, const solver *how)
{
    char sweeps[16];
    snprintf(sweeps, sizeof(sweeps), "%d", how->sweeps);
    const char *const set[][2] = {{"lattice.sweeps", sweeps},
                                  {"lattice.cycles", how->cycles},
                                  {"lattice.anderson", how->anderson},
                                  {"lattice.cells", "24"}};
    tyn_settings *settings = NULL;
    assert_int_equal(tyn_settings_create(&settings), TYN_OK);
    for (size_t i = 0; i < sizeof(set) / sizeof(set[0]); i++) {
        assert_int_equal(tyn_settings_set(settings, set[i][0], set[i][1], &scenes_log), TYN_OK);
    }
    tyn_offline *off = NULL;
    assert_int_equal(
        tyn_offline_create(dev, tyn_offline_params(.method = "pop", .settings = settings), &off),
        TYN_OK);
    tyn_view view = {.width = 1, .height = 1, .outputs = TYN_OUTPUT_BALANCE};
    tyn_camera_frame_scene(&view.camera, scene);
    offline_frame(off, scene, &view);
    const tyn_balance *balance = tyn_offline_output(off, TYN_OUTPUT_BALANCE);
    assert_non_null(balance);
    double most = 0;
    for (int k = 0; k < 3; k++) {
        most = maximum(most, fabs(balance->imbalance[k]));
    }
    tyn_offline_destroy(&off);
    tyn_settings_destroy(&settings);
    return most;
}

static void solve(const tyn_scene *scene, const char *light)
{
    static const solver solvers[] = {
        {"plain", "0", "0", 8, 0, 1},        {"plain", "0", "0", 32, 0, 1},
        {"plain", "0", "0", 100, 0.005, 1},  {"as it is", "2", "1", 4, 0, 0.03},
        {"as it is", "2", "1", 6, 0, 0.005}, {"as it is", "2", "1", 8, 0, 0.002},
    };
    tyn_device *dev = NULL;
    if (tyn_device_open(tyn_device_open_params(.log = scenes_log), &dev) != TYN_OK) {
        skip_case("no device");
    }
    const bool sun = scene->num_lights > 0;
    for (size_t i = 0; i < sizeof(solvers) / sizeof(solvers[0]); i++) {
        const solver *s = &solvers[i];
        const double found = imbalance(dev, scene, s);
        print_message("milk under %s: %s, %d sweeps: imbalance %.3f %%\n", light, s->name,
                      s->sweeps, 100 * found);
        // The sky alone is nearly the first guess in milk: no sweeps are needed to get close.
        assert_true(found <= s->most && (!sun || found >= s->least));
    }
    tyn_device_destroy(&dev);
}

static void under_its_sky(void **state)
{
    (void)state;
    tyn_scene scene = scenes_load("milk");
    solve(&scene, "its sky");
    tyn_scene_finish(&scene);
}

static void under_a_sun(void **state)
{
    (void)state;
    tyn_scene scene = scenes_load("milk");
    scene.environment.present = false;
    scene.num_lights = 1;
    scene.lights[0] = (tyn_light){.kind = TYN_LIGHT_DIRECTIONAL,
                                  .color = {5, 5, 5},
                                  .direction = {0, -0.70710678f, -0.70710678f}};
    solve(&scene, "a sun");
    tyn_scene_finish(&scene);
}

int main(int argc, char **argv)
{
    if (!scenes_folder(argc, argv)) {
        return 2;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(under_a_sun),
        cmocka_unit_test(under_its_sky),
    };
    return run_cases(tests, NULL, NULL);
}
