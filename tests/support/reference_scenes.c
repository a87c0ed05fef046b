// reference_scenes.c -- the scenes with surfaces of the shared reference images, and their cameras.
#include "reference_scenes.h"
#include "path_run.h"
#include "solids.h"
#include <math.h>

static const float BLACK[3] = {0, 0, 0};

void reference_room(tyn_scene *scene, tyn_view *view)
{
    tyn_scene_init(scene);
    uint32_t grey = solids_material(scene, (float[]){0.75f, 0.75f, 0.75f}, BLACK);
    uint32_t red = solids_material(scene, (float[]){0.75f, 0.15f, 0.10f}, BLACK);
    solids_quad(scene, (float[]){0, 0, 0}, (float[]){0, 0, 4}, (float[]){4, 0, 0}, grey);
    solids_quad(scene, (float[]){0, 0, 0}, (float[]){0, 3, 0}, (float[]){0, 0, 4}, red);
    solids_quad(scene, (float[]){4, 0, 0}, (float[]){0, 0, 4}, (float[]){0, 3, 0}, grey);
    solids_quad(scene, (float[]){0, 0, 0}, (float[]){4, 0, 0}, (float[]){0, 3, 0}, grey);
    solids_quad(scene, (float[]){0, 0, 4}, (float[]){0, 3, 0}, (float[]){4, 0, 0}, grey);
    // The ceiling, around the hole.
    solids_quad(scene, (float[]){0, 3, 0}, (float[]){4, 0, 0}, (float[]){0, 0, 1.75f}, grey);
    solids_quad(scene, (float[]){0, 3, 2.25f}, (float[]){4, 0, 0}, (float[]){0, 0, 1.75f}, grey);
    solids_quad(scene, (float[]){0, 3, 1.75f}, (float[]){1.5f, 0, 0}, (float[]){0, 0, 0.5f}, grey);
    solids_quad(scene, (float[]){2, 3, 1.75f}, (float[]){2, 0, 0}, (float[]){0, 0, 0.5f}, grey);
    solids_hierarchy(scene, 2);
    tyn_medium fog = grey_medium(0.3f, 0.02f, 0.6f);
    scene_add_box(scene, &fog, (float[]){0, 0, 0}, (float[]){4, 3, 4}, NULL, NULL);
    float to_hole[3] = {0.55f, -1.5f, 0}, length = sqrtf(0.55f * 0.55f + 1.5f * 1.5f);
    scene_add_lamp(scene, (float[]){1.2f, 4.5f, 2}, 40);
    tyn_light *l = &scene->lights[0];
    l->kind = TYN_LIGHT_SPOT;
    l->cos_inner = l->cos_outer = cosf(20 * (float)M_PI / 180);
    for (int a = 0; a < 3; a++) {
        l->direction[a] = to_hole[a] / length;
    }
    *view = (tyn_view){0};
    view_perspective(view, (float[]){3.6f, 1.5f, 3.8f}, (float[]){1.8f, 1.3f, 1.6f},
                     tanf((float)M_PI / 6), 64);
}

void reference_sphere(tyn_scene *scene, tyn_view *view, float g)
{
    tyn_scene_init(scene);
    const float l = 1 / ((float)M_PI * 0.01f);
    uint32_t emitter = solids_material(scene, BLACK, (float[]){l, l, l});
    solids_sphere(scene, (float[]){0, 0, 0}, 0.1f, 32, false, emitter);
    solids_hierarchy(scene, 2);
    tyn_medium fog = grey_medium(1, 0, g);
    fog.sigma_s[0] = 0.8f;
    fog.sigma_s[2] = 1.3f;
    tyn_shape *shape = scene_add_box(scene, &fog, (float[]){-2.5f, -2.5f, -2.5f},
                                     (float[]){2.5f, 2.5f, 2.5f}, NULL, NULL);
    shape->kind = TYN_SHAPE_SPHERE;
    *view = (tyn_view){0};
    view_orthographic(view, (float[]){0, 0, 0}, 0, -1, 0, (float[]){0, 0, 1}, 2.75f, 64);
}
