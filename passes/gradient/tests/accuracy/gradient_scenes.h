// gradient_scenes.h -- what the tests of method `gradient` light.
#pragma once
#include "picture.h"
#include <stdlib.h>

static inline tyn_scene *open_scene(void)
{
    tyn_scene *scene = malloc(sizeof *scene);
    tyn_scene_init(scene);
    return scene;
}

static inline void close_scene(tyn_scene *scene)
{
    tyn_scene_finish(scene);
    free(scene);
}

// The unit cube.
static inline tyn_scene *cube(float sigma_s, float sigma_a, float g)
{
    tyn_scene *scene = open_scene();
    const tyn_medium medium = grey_medium(sigma_s, sigma_a, g);
    scene_add_box(scene, &medium, (float[]){0, 0, 0}, (float[]){1, 1, 1}, NULL, NULL);
    return scene;
}
