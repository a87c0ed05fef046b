// plugin_host.c -- a host that has the library inside it, as a static one, loads a plugin and renders with its method and its
// hook under validation.
//
// usage: plugin_host FILE.so; exits with 3 without a device that can validate.
#include <stdio.h>
#include <string.h>
#include <tyndall/offline.h>

enum { SIDE = 32 };

static void print_log(void *user, tyn_log_level level, const char *message)
{
    (void)user;
    (void)level;
    fprintf(stderr, "plugin_host: %s\n", message);
}

// A cube of fog, seen through along z: an optical depth of 2, in a sun from the left.
static void fill(tyn_scene *scene, tyn_view *view)
{
    tyn_scene_init(scene);
    scene->num_media = scene->num_shapes = scene->num_lights = 1;
    tyn_light *sun = &scene->lights[0];
    scene->media[0].volume = -1;
    scene->shapes[0].to_world[15] = 1;
    for (int i = 0; i < 3; i++) {
        scene->media[0].sigma_s[i] = 1.5f;
        scene->media[0].sigma_a[i] = 0.5f;
        scene->shapes[0].to_world[5 * i] = 1;
        sun->color[i] = 1;
    }
    sun->direction[0] = 1;
    *view = (tyn_view){.width = SIDE, .height = SIDE, .outputs = TYN_OUTPUT_RADIANCE};
    view->camera = (tyn_camera){.projection = TYN_ORTHOGRAPHIC,
                                .position = {0, 0, 3},
                                .right = {1, 0, 0},
                                .up = {0, 1, 0},
                                .back = {0, 0, 1},
                                .ymag = 0.4f};
}

// The value in the middle of the picture; negative: it failed.
static float render(tyn_device *device, const char *method, const char *setting, const char *value)
{
    float middle = -1;
    tyn_scene scene;
    tyn_view view = {0};
    tyn_settings *settings = NULL;
    tyn_offline *offline = NULL;
    const tyn_log log = {print_log, NULL, TYN_LOG_WARN};
    fill(&scene, &view);
    if (tyn_settings_create(&settings) == TYN_OK &&
        (!setting || tyn_settings_set(settings, setting, value, &log) == TYN_OK) &&
        tyn_offline_create(device, tyn_offline_params(.method = method, .settings = settings),
                           &offline) == TYN_OK &&
        tyn_offline_frame(offline, &scene, &view, false) == TYN_OK) {
        const float *pixels = tyn_offline_output(offline, TYN_OUTPUT_RADIANCE);
        middle = pixels ? pixels[4 * (SIDE / 2 * SIDE + SIDE / 2) + 1] : -1;
    }
    tyn_offline_destroy(&offline);
    tyn_settings_destroy(&settings);
    tyn_scene_finish(&scene);
    return middle;
}

int main(int argc, char **argv)
{
    const tyn_log log = {print_log, NULL, TYN_LOG_WARN};
    if (argc != 2 || tyn_plugin_load(argv[1], &log) != TYN_OK ||
        tyn_plugin_load(argv[1], &log) != TYN_OK) { // again: it is there
        return 1;
    }
    tyn_plugin_info info;
    tyn_plugin_at(0, &info);
    printf("%u plugin: %s, %u passes, %u methods, %u hooks\n", tyn_num_plugins(), info.name,
           info.num_passes, info.num_methods, info.num_hooks);
    tyn_device *device;
    if (tyn_device_open(tyn_device_open_params(.validation = true, .log = log), &device) !=
        TYN_OK) {
        return 3;
    }
    // Green of the middle knot of its colours: an optical depth of 2 of 4.
    const float pop = render(device, "pop", NULL, NULL);
    const float diffusion = render(device, "diffusion", NULL, NULL);
    const float colour = render(device, "pop", "false_colour.show", "1");
    const uint32_t messages = tyn_device_validation_messages(device);
    printf("pop %.4g, diffusion %.4g, colour %.4g, %u messages\n", pop, diffusion, colour,
           messages);
    tyn_device_destroy(&device);
    const float apart = diffusion / pop - 1;
    const bool right = pop > 0 && apart > -0.15f && apart < 0.15f && colour > 0.28f &&
                       colour < 0.286f && messages == 0 && tyn_num_plugins() == 1;
    return right ? 0 : 1;
}
