// scenes.c -- see scenes.h.
#include "scenes.h"
#include <tyndall/io.h>

static const char *folder;

static void on_log(void *user, tyn_log_level level, const char *message)
{
    (void)user;
    (void)level;
    print_message("%s\n", message);
}
const tyn_log scenes_log = {on_log, NULL, TYN_LOG_WARN};

bool scenes_folder(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: %s FOLDER\n", argv[0]);
        return false;
    }
    folder = argv[1];
    return true;
}

tyn_scene scenes_load(const char *name)
{
    char path[4096];
    snprintf(path, sizeof(path), "%s/%s.gltf", folder, name);
    tyn_scene scene;
    tyn_scene_init(&scene);
    assert_int_equal(tyn_scene_load(&scene, path, NULL, &scenes_log), TYN_OK);
    assert_int_equal(scene.num_warnings, 0);
    assert_int_equal(tyn_scene_check(&scene, &scenes_log), TYN_OK);
    return scene;
}
