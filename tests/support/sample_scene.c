// sample_scene.c -- see sample_scene.h.
#include "sample_scene.h"
#include <tyndall/io.h>
#include <stdio.h>

void sample_scene_load(tyn_scene *scene, const char *name, const gpu_test *t)
{
    char path[512];
    snprintf(path, sizeof path, "%s/%s.gltf", TYN_SAMPLE_SCENES, name);
    tyn_scene_init(scene);
    assert_int_equal(tyn_scene_load(scene, path, NULL, &t->log), TYN_OK);
    assert_int_equal(tyn_surfaces_build_nodes(&scene->surfaces, &t->log), TYN_OK);
}
