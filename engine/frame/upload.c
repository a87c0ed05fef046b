// upload.c -- the scene of a frame as resources of the graph.
#include "frame/context.h"
#include <tyndall/extend/hash.h>
#include "frame/env_cdf.h"
#include "frame/output.h"
#include <string.h>

static void fill_environment(void *user, void *texels)
{
    const tyn_environment *env = &((const tyn_context *)user)->scene->environment;
    float *out = texels;
    for (size_t i = 0; i < (size_t)env->size[0] * env->size[1]; i++) {
        memcpy(out + i * 4, env->data + i * 3, 3 * sizeof(float));
        out[i * 4 + 3] = 1;
    }
}

// Of densities or of colours.
static tyn_ref upload_atlas(tyn_graph *g, const char *name, tyn_atlas *atlas)
{
    static const VkFormat formats[2][2] = {
        {VK_FORMAT_R32_SFLOAT, VK_FORMAT_R16_SFLOAT},
        {VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R16G16B16A16_SFLOAT}};
    return tyn_graph_upload_image(g, name, TYN_IMAGE_3D, formats[atlas->colors][atlas->half],
                                  atlas->extent, tyn_atlas_fill, atlas, tyn_atlas_hash(atlas));
}

static void fill_resumed(void *user, void *texels)
{
    const tyn_resumed_image *image = user;
    memcpy(texels, image->texels, image->size);
}

static void upload_resumed(tyn_context *ctx, const tyn_view *view, tyn_scene_refs *refs)
{
    static const char *const names[6] = {"resumed",           "resumed_low",
                                         "resumed_deviation", "resumed_single",
                                         "resumed_multiple",  "resumed_transmittance"};
    const tyn_resume *r = view->resume;
    if (!r) {
        return;
    }
    const float *images[6] = {r->radiance, r->low,      r->deviation,
                              r->single,   r->multiple, r->transmittance};
    for (int i = 0; i < 6; i++) {
        if (images[i]) {
            ctx->resumed[i].texels = images[i];
            ctx->resumed[i].size = (size_t)view->width * view->height * 4 * sizeof(float);
            refs->resumed[i] = tyn_graph_upload_image(
                ctx->graph, names[i], TYN_IMAGE_2D, VK_FORMAT_R32G32B32A32_SFLOAT,
                (tyn_extent){view->width, view->height, 1}, fill_resumed, &ctx->resumed[i],
                tyn_hash_u64(tyn_hash_string(TYN_HASH_SEED, names[i]), r->hash));
        }
    }
}

static void upload_surfaces(tyn_context *ctx, const tyn_surfaces *s, tyn_scene_refs *refs)
{
    tyn_graph *g = ctx->graph;
    const tyn_surface_data *data = &ctx->surfaces;
    const struct surface_block *block = &ctx->frame.surfaces;
    if (!ctx->frame.num_triangles) {
        return;
    }
    const tyn_surface_node *nodes = s->num_nodes ? s->nodes : &data->leaf;
    const uint32_t num_nodes = ctx->frame.surfaces.num_nodes;
    struct {
        tyn_ref *ref;
        const char *name;
        const void *data;
        size_t size;
    } buffers[] = {
        {&refs->geometry.vertices, "vertices", s->vertices, s->num_vertices * sizeof *s->vertices},
        {&refs->geometry.triangles, "triangles", s->triangles,
         s->num_triangles * sizeof *s->triangles},
        {&refs->materials.materials, "materials", s->materials,
         s->num_materials * sizeof *s->materials},
        {&refs->materials.textures, "textures", data->textures,
         data->num_textures * sizeof *data->textures},
        {&refs->materials.texels, "texels", data->texels, data->num_texels * sizeof *data->texels},
        {&refs->geometry.nodes, "nodes", nodes, num_nodes * sizeof *nodes},
        {&refs->emitters, "emitters", data->emitters, data->emitters_size},
        {&refs->areas, "areas", data->areas, data->areas_size},
    };
    refs->geometry.surfaces = tyn_graph_upload_buffer(g, "surfaces", block, sizeof *block, 0);
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; i++) {
        if (buffers[i].size) {
            *buffers[i].ref = tyn_graph_upload_buffer(g, buffers[i].name, buffers[i].data,
                                                      buffers[i].size, data->hash);
        }
    }
}

void tyn_frame_upload(tyn_context *ctx, const tyn_frame *frame, tyn_scene_refs *refs)
{
    tyn_graph *g = ctx->graph;
    const tyn_frame_scene *f = &ctx->frame;
    const tyn_scene *scene = frame->scene;
    if (ctx->atlas.host) {
        uint64_t version = frame->density_versions ? frame->density_versions[0] : 0;
        refs->atlas =
            tyn_graph_import_image(g, "atlas", TYN_IMAGE_3D, &frame->densities[0], version);
    } else if (ctx->atlas.extent.z) {
        refs->atlas = upload_atlas(g, "atlas", &ctx->atlas);
    }
    if (ctx->colors.extent.z) {
        refs->colors = upload_atlas(g, "colors", &ctx->colors);
        tyn_graph_mark_media(g, refs->colors);
    }
    refs->medium = tyn_graph_upload_buffer(g, "medium", &f->medium, sizeof f->medium, 0);
    refs->shapes = tyn_graph_upload_buffer(g, "shapes", f->shapes, sizeof f->shapes, 0);
    tyn_graph_mark_media(g, refs->atlas);
    tyn_graph_mark_media(g, refs->medium);
    tyn_graph_mark_media(g, refs->shapes);

    if (f->phase_tables) {
        refs->phases = tyn_graph_upload_buffer(
            g, "phases", ctx->phase_rows,
            scene->num_phase_tables * TYN_PHASE_NODES * sizeof *ctx->phase_rows, ctx->phase_hash);
        tyn_graph_mark_media(g, refs->phases);
    }

    refs->lights = tyn_graph_upload_buffer(g, "lights", f->lights.scene, sizeof f->lights.scene, 0);
    refs->suns = tyn_graph_upload_buffer(g, "suns", f->lights.suns, sizeof f->lights.suns, 0);
    refs->camera = tyn_graph_upload_buffer(g, "camera", &f->camera, sizeof f->camera, 0);
    refs->environment =
        tyn_graph_upload_buffer(g, "environment", &f->environment, sizeof f->environment, 0);
    const tyn_environment *env = &scene->environment;
    if (f->environment.has_map) {
        refs->env_map = tyn_graph_upload_image(
            g, "env_map", TYN_IMAGE_2D, VK_FORMAT_R32G32B32A32_SFLOAT,
            (tyn_extent){env->size[0], env->size[1], 1}, fill_environment, ctx, ctx->env_hash);
        if (ctx->env_cdf) {
            refs->env_cdf = tyn_graph_upload_buffer(g, "env_cdf", ctx->env_cdf,
                                                    tyn_env_cdf_size(env), ctx->env_hash);
        }
    }
    upload_surfaces(ctx, &scene->surfaces, refs);
    upload_resumed(ctx, frame->view, refs);
    if (frame->view->outputs & TYN_OUTPUT_PROBE) {
        refs->points = tyn_graph_upload_buffer(g, "points", ctx->points,
                                               ctx->num_points * sizeof *ctx->points, 0);
    }
    if (frame->view->outputs & TYN_OUTPUT_COMPOSITE) {
        refs->color = tyn_graph_import_image(g, "color", TYN_IMAGE_2D, frame->color, 0);
        if (frame->depth) {
            refs->depth = tyn_graph_import_image(g, "depth", TYN_IMAGE_2D, frame->depth, 0);
        }
    }
    for (uint32_t i = 0; i < TYN_NUM_LENT; i++) {
        const tyn_image *lent = tyn_lent(&frame->images, i);
        if (lent) {
            refs->images[i] =
                tyn_graph_import_image(g, tyn_lent_images[i].given, TYN_IMAGE_2D, lent, 0);
        }
    }
    if (frame->view->outputs & TYN_OUTPUT_LIGHT) {
        const tyn_image *light[3] = {frame->light.red, frame->light.green, frame->light.blue};
        static const char *const colours[3] = {"light_red", "light_green", "light_blue"};
        for (int i = 0; i < 3; i++) {
            refs->light[i] = tyn_graph_import_image(g, colours[i], TYN_IMAGE_3D, light[i], 0);
        }
    }
}
