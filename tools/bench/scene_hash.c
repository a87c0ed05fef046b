// scene_hash.c -- a hash of all that a picture shows.
#include "reference.h"

#define HASH(value, seed) text_hash(&(value), sizeof(value), seed)

// Of lobes by their g alone.
static uint64_t hash_phase(const tyn_phase phase[3], uint64_t key)
{
    const float g[3] = {phase[0].g, phase[1].g, phase[2].g};
    key = HASH(g, key);
    for (int c = 0; c < 3; c++) {
        key = phase[c].table ? HASH(phase[c].key, key) : key;
    }
    return key;
}

static uint64_t hash_media(const tyn_scene *scene, uint64_t key)
{
    for (uint32_t i = 0; i < scene->num_volumes; i++) {
        key = HASH(scene->volumes[i].hash, HASH(scene->volumes[i].size, key));
    }
    for (uint32_t i = 0; i < scene->num_color_grids; i++) {
        key = HASH(scene->color_grids[i].hash, HASH(scene->color_grids[i].size, key));
    }
    for (uint32_t i = 0; i < scene->num_media; i++) {
        const tyn_medium *m = &scene->media[i];
        key = hash_phase(m->phase, HASH(m->emission, key));
        key = HASH(m->sigma_s, HASH(m->sigma_a, key));
        key = HASH(m->density_scale, HASH(m->volume, key));
        if (m->emission_grid || m->radiance_grid || m->albedo_grid) {
            key = HASH(m->emission_grid, HASH(m->radiance_grid, HASH(m->albedo_grid, key)));
        }
    }
    for (uint32_t i = 0; i < scene->num_shapes; i++) {
        const tyn_shape *s = &scene->shapes[i];
        key = HASH(s->kind, HASH(s->medium, HASH(s->to_world, HASH(s->repeat, key))));
    }
    return key;
}

static uint64_t hash_lights(const tyn_scene *scene, uint64_t key)
{
    for (uint32_t i = 0; i < scene->num_lights; i++) {
        const tyn_light *l = &scene->lights[i];
        key = HASH(l->kind, HASH(l->color, HASH(l->position, HASH(l->direction, key))));
        key = HASH(l->cos_inner, HASH(l->cos_outer, key));
    }
    const tyn_environment *e = &scene->environment;
    if (e->present) {
        key = HASH(e->hash, HASH(e->size, HASH(e->radiance, HASH(e->rotation, key))));
        key = HASH(e->strength, key);
    }
    return key;
}

static uint64_t hash_surfaces(const tyn_surfaces *s, uint64_t key)
{
    if (s->num_triangles == 0) {
        return key;
    }
    key = text_hash(s->vertices, s->num_vertices * sizeof *s->vertices, key);
    key = text_hash(s->triangles, s->num_triangles * sizeof *s->triangles, key);
    key = text_hash(s->materials, s->num_materials * sizeof *s->materials, key);
    for (uint32_t i = 0; i < s->num_textures; i++) {
        const tyn_texture *t = &s->textures[i];
        key = text_hash(t->texels, (size_t)4 * t->size[0] * t->size[1], HASH(t->wrap, key));
        // The number of texels tells the size of a square; others may share it.
        key = t->size[0] == t->size[1] ? key : HASH(t->size, key);
    }
    return key;
}

uint64_t bench_scene_hash(const tyn_scene *scene, const tyn_view *view)
{
    uint64_t key = hash_media(scene, 1);
    key = hash_lights(scene, key);
    key = hash_surfaces(&scene->surfaces, key);
    const tyn_camera *c = &view->camera;
    key = HASH(c->projection, HASH(c->position, HASH(c->right, HASH(c->up, HASH(c->back, key)))));
    key = HASH(c->yfov, HASH(c->ymag, key));
    key = view->whole[0] ? HASH(view->whole, HASH(view->corner, key)) : key;
    return HASH(view->width, HASH(view->height, HASH(view->no_background, key)));
}
