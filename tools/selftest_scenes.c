// selftest_scenes.c -- small scenes whose answers are known, made in memory.
#include "selftest_scenes.h"

static void unit_box(tyn_scene *scene, float sigma_s, float sigma_a, float g)
{
    tyn_scene_init(scene);
    scene->num_media = 1;
    tyn_medium *medium = &scene->media[0];
    *medium = (tyn_medium){.density_scale = 1, .volume = -1};
    for (int c = 0; c < 3; c++) {
        medium->sigma_s[c] = sigma_s;
        medium->sigma_a[c] = sigma_a;
        medium->g[c] = g;
    }
    scene->num_shapes = 1;
    scene->shapes[0] =
        (tyn_shape){.kind = TYN_SHAPE_BOX,
                    .to_world = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.5f, 0.5f, 0.5f, 1}};
}

static void sun(tyn_scene *scene, float x, float y, float z)
{
    scene->num_lights = 1;
    scene->lights[0] =
        (tyn_light){.kind = TYN_LIGHT_DIRECTIONAL, .color = {1, 1, 1}, .direction = {x, y, z}};
}

void selftest_cube(tyn_scene *scene, float g, bool furnace)
{
    unit_box(scene, 4, 0, g);
    if (furnace) {
        scene->environment =
            (tyn_environment){.present = true, .radiance = {1, 1, 1}, .strength = 1};
    } else {
        sun(scene, 1, 0, 0);
    }
}

void selftest_slab(tyn_scene *scene)
{
    unit_box(scene, 0.9f, 0.1f, 0.5f);
    scene->shapes[0].repeat[0] = scene->shapes[0].repeat[2] = true;
    sun(scene, 0, -1, 0);
}

void selftest_camera(tyn_camera *camera, float x, float y, float z, float half_height)
{
    const float middle[3] = {0.5f, 0.5f, 0.5f};
    const float from[3] = {0.5f - 3 * x, 0.5f - 3 * y, 0.5f - 3 * z};
    *camera = (tyn_camera){.projection = TYN_ORTHOGRAPHIC, .ymag = half_height, .aspect = 1};
    tyn_camera_look_at(camera, from, middle);
}
