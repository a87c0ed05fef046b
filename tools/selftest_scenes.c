// selftest_scenes.c -- small scenes whose answers are known, made in memory.
#include "selftest_scenes.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static void unit_box(tyn_scene *scene, float sigma_s, float sigma_a, float g)
{
    tyn_scene_init(scene);
    scene->num_media = 1;
    tyn_medium *medium = &scene->media[0];
    *medium = (tyn_medium){.density_scale = 1, .volume = -1};
    for (int c = 0; c < 3; c++) {
        medium->sigma_s[c] = sigma_s;
        medium->sigma_a[c] = sigma_a;
        medium->phase[c].g = g;
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

// A horizontal square at y 0, facing up.
static bool ground_of(tyn_scene *scene, float albedo, bool wide)
{
    tyn_surfaces *f = &scene->surfaces;
    f->vertices = calloc(4, sizeof *f->vertices);
    f->triangles = calloc(2, sizeof *f->triangles);
    f->materials = calloc(1, sizeof *f->materials);
    if (!f->vertices || !f->triangles || !f->materials) {
        return false;
    }
    const float lo = wide ? -2 : 0, hi = wide ? 3 : 1;
    f->num_vertices = 4;
    f->num_triangles = 2;
    f->num_materials = 1;
    for (uint32_t i = 0; i < 4; i++) {
        const bool u = i == 1 || i == 2, v = i >= 2;
        f->vertices[i] =
            (tyn_surface_vertex){.position = {u ? hi : lo, 0, v ? lo : hi}, .normal = {0, 1, 0}};
    }
    f->triangles[0] = (tyn_surface_triangle){{0, 1, 2}, 0};
    f->triangles[1] = (tyn_surface_triangle){{0, 2, 3}, 0};
    f->materials[0] =
        (tyn_surface_material){.albedo = {albedo, albedo, albedo}, .texture = TYN_NO_TEXTURE};
    return true;
}

bool selftest_slab(tyn_scene *scene, float tau, float g, float albedo, float mu0, float ground,
                   bool wide)
{
    unit_box(scene, tau * albedo, tau - tau * albedo, g);
    scene->shapes[0].repeat[0] = scene->shapes[0].repeat[2] = true;
    sun(scene, sqrtf(1 - mu0 * mu0), -mu0, 0);
    for (int c = 0; c < 3; c++) {
        scene->lights[0].color[c] = 1 / mu0;
    }
    return ground <= 0 || ground_of(scene, ground, wide);
}

void selftest_lamp(tyn_scene *scene, float albedo, float extinction, float side)
{
    unit_box(scene, extinction * albedo, extinction - extinction * albedo, 0);
    const float to_world[16] = {side, 0, 0, 0, 0, side, 0, 0, 0, 0, side, 0, 0, 0, 0, 1};
    memcpy(scene->shapes[0].to_world, to_world, sizeof to_world);
    scene->num_lights = 1;
    scene->lights[0] =
        (tyn_light){.kind = TYN_LIGHT_POINT, .color = {1, 1, 1}, .direction = {0, 0, -1}};
}

void selftest_camera(tyn_camera *camera, float x, float y, float z, float half_height)
{
    const float middle[3] = {0.5f, 0.5f, 0.5f};
    const float from[3] = {0.5f - 3 * x, 0.5f - 3 * y, 0.5f - 3 * z};
    *camera = (tyn_camera){.projection = TYN_ORTHOGRAPHIC, .ymag = half_height, .aspect = 1};
    tyn_camera_look_at(camera, from, middle);
}
