// sizes.c -- what of a frame must be as it was prepared: sizes, formats, counts and settings. All else are values.
#include "frame/context.h"
#include "frame/output.h"
#include <tyndall/extend/hash.h>
#include "registry/registry.h"

static uint64_t add_image(uint64_t h, const tyn_image *image)
{
    if (!image) {
        return tyn_hash_u64(h, 0);
    }
    h = tyn_hash_u64(h, (uint64_t)image->format << 1 | 1);
    return tyn_hash_bytes(h, &image->extent, sizeof image->extent);
}

static uint64_t add_view(uint64_t h, const tyn_view *view)
{
    h = tyn_hash_u64(h, (uint64_t)view->width << 32 | view->height);
    h = tyn_hash_u64(h, (uint64_t)view->whole[0] << 32 | view->whole[1]);
    h = tyn_hash_u64(h, (uint64_t)view->outputs << 32 | view->num_points);
    h = tyn_hash_u64(h, (uint64_t)(view->resume != NULL) << 1 | view->scattered_only);
    return tyn_hash_u64(h, (uint64_t)view->max_depth << 32 | view->rr_depth);
}

static uint64_t add_scene(uint64_t h, const tyn_scene *scene)
{
    const tyn_surfaces *s = &scene->surfaces;
    const uint32_t counts[] = {scene->num_volumes,
                               scene->num_phase_tables,
                               scene->num_media,
                               scene->num_shapes,
                               scene->num_lights,
                               scene->environment.present,
                               scene->environment.size[0],
                               scene->environment.size[1],
                               s->num_vertices,
                               s->num_triangles,
                               s->num_materials,
                               s->num_textures,
                               s->num_nodes};
    h = tyn_hash_bytes(h, counts, sizeof counts);
    for (uint32_t i = 0; i < scene->num_volumes; i++) {
        const tyn_volume *v = &scene->volumes[i];
        h = tyn_hash_bytes(h, v->size, sizeof v->size);
        h = tyn_hash_u64(h, v->data != NULL);
    }
    for (uint32_t i = 0; i < scene->num_color_grids; i++) {
        h = tyn_hash_bytes(h, scene->color_grids[i].size, sizeof scene->color_grids[i].size);
    }
    for (uint32_t i = 0; i < scene->num_media; i++) {
        const tyn_medium *m = &scene->media[i];
        const uint32_t slots[] = {m->emission_grid, m->radiance_grid, m->albedo_grid};
        h = tyn_hash_bytes(h, slots, sizeof slots);
    }
    for (uint32_t i = 0; i < s->num_textures; i++) {
        h = tyn_hash_bytes(h, s->textures[i].size, sizeof s->textures[i].size);
    }
    for (uint32_t i = 0; i < scene->num_shapes; i++) {
        const tyn_shape *shape = &scene->shapes[i];
        const bool *repeat = shape->repeat;
        h = tyn_hash_u64(h, (uint64_t)shape->kind << 35 | (uint64_t)shape->medium << 3 |
                                repeat[0] << 2 | repeat[1] << 1 | repeat[2]);
    }
    for (uint32_t i = 0; i < scene->num_lights; i++) {
        h = tyn_hash_u64(h, (uint64_t)scene->lights[i].kind);
    }
    return h;
}

uint64_t tyn_frame_sizes(const tyn_context *ctx, const tyn_frame *frame)
{
    const tyn_frame_lights *light = &frame->light;
    const tyn_image *images[] = {frame->color, frame->depth, light->red, light->green, light->blue};
    uint64_t h = add_scene(add_view(TYN_HASH_SEED, frame->view), frame->scene);
    for (size_t i = 0; i < sizeof images / sizeof images[0]; i++) {
        h = add_image(h, images[i]);
    }
    for (uint32_t i = 0; i < TYN_NUM_LENT; i++) {
        h = add_image(h, tyn_lent(&frame->images, i));
    }
    if (ctx->atlas.host) {
        h = add_image(h, &frame->densities[0]);
    }
    h = tyn_hash_u64(h, tyn_settings_hash(ctx->settings));
    h = tyn_hash_string(h, ctx->inspect ? ctx->inspect : "");
    return h ? h : 1;
}
