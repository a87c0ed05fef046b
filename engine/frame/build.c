// build.c -- what a frame makes of its scene: tables where something has changed, and the job.
#include "frame/context.h"
#include "base/fault.h"
#include <tyndall/extend/hash.h>
#include "frame/env_cdf.h"
#include "gpu/device.h"
#include "registry/registry.h"
#include <stdlib.h>
#include <string.h>

static tyn_result update_environment(tyn_context *ctx, const tyn_environment *env)
{
    size_t texels = (size_t)env->size[0] * env->size[1];
    uint64_t hash = 1;
    if (env->present && texels) {
        hash = env->hash ? env->hash
                         : tyn_hash_bytes(TYN_HASH_SEED, env->data, texels * 3 * sizeof(float));
        hash = tyn_hash_u64(hash, env->size[0]);
    }
    if (hash != ctx->env_hash) {
        ctx->env_hash = 0; // what is here is of no map until all of it is made
        free(ctx->env_cdf);
        ctx->env_cdf = NULL;
        if (!tyn_map_light_find(env, &ctx->map_light)) {
            return TYN_ERR_MEMORY;
        }
        if (ctx->method->reads_env_cdf && tyn_env_cdf_size(env)) {
            ctx->env_cdf = malloc(tyn_env_cdf_size(env));
            if (!ctx->env_cdf || !tyn_env_cdf_build(env, ctx->env_cdf)) {
                return TYN_ERR_MEMORY;
            }
        }
        ctx->env_hash = hash;
    }
    return TYN_OK;
}

static tyn_result update_points(tyn_context *ctx, const tyn_view *view)
{
    if (view->num_points > ctx->num_points || !ctx->points) {
        void *grown = realloc(ctx->points, view->num_points * sizeof *ctx->points);
        if (!grown) {
            return TYN_ERR_MEMORY;
        }
        ctx->points = grown;
    }
    ctx->num_points = view->num_points;
    const float *m = ctx->frame.m_from_world;
    for (uint32_t i = 0; i < view->num_points; i++) {
        const float *p = view->points[i];
        for (int a = 0; a < 3; a++) {
            ctx->points[i][a] = (float)((double)m[a] * p[0] + (double)m[4 + a] * p[1] +
                                        (double)m[8 + a] * p[2] + m[12 + a]);
        }
    }
    return TYN_OK;
}

// What the density grid says of the medium, as far as is known; looked up again when the grid changes.
static void look_at_grid(tyn_context *ctx, const tyn_scene *scene)
{
    tyn_frame_scene *out = &ctx->frame;
    out->open_faces = 63;
    out->mean_density = out->direct && scene->num_volumes == 0 ? 1.0f : 0.0f;
    if (!out->direct || scene->num_volumes != 1) {
        return;
    }
    uint64_t hash = tyn_atlas_hash(&ctx->atlas);
    if (hash != ctx->grid_hash) {
        ctx->open_faces = tyn_volume_open_faces(&scene->volumes[0]);
        ctx->mean_density = tyn_volume_mean(&scene->volumes[0]);
        ctx->typical_density = tyn_volume_typical(&scene->volumes[0]);
        ctx->grid_hash = hash;
    }
    out->open_faces = ctx->open_faces;
    out->mean_density = ctx->mean_density;
    out->typical_density = ctx->typical_density;
}

// 1 - albedo is a difference: a half float next to 1 would lose what is absorbed.
static bool has_albedo(const tyn_scene *scene)
{
    bool has = false;
    for (uint32_t i = 0; i < scene->num_media; i++) {
        has = has || scene->media[i].albedo_grid > 0;
    }
    return has;
}

static void choose_storage(tyn_context *ctx)
{
    tyn_setting storage;
    tyn_settings_get(ctx->settings, "medium.storage", &storage, NULL);
    // Half floats save bandwidth; a CPU has to unpack them, which takes longer than to filter.
    const bool half =
        strcmp(storage.word, "auto") ? !strcmp(storage.word, "half") : !ctx->dev->capacity.software;
    ctx->atlas.half &= half;
    ctx->colors.half = half && !has_albedo(ctx->scene);
}

tyn_result tyn_frame_build(tyn_context *ctx, const tyn_frame *frame, tyn_job *job)
{
    const tyn_view *view = frame->view;
    const tyn_log *log = &ctx->dev->log;
    ctx->scene = frame->scene;
    tyn_frame_projection projection;
    TYN_TRY(tyn_frame_projection_find(&projection, frame, log));
    TYN_TRY(update_environment(ctx, &frame->scene->environment));
    TYN_TRY(tyn_surface_data_update(&ctx->surfaces, &frame->scene->surfaces, log));
    if (ctx->method->info.traces_rays) {
        TYN_TRY(tyn_surface_data_tables(&ctx->surfaces, &frame->scene->surfaces,
                                        view->outputs & TYN_OUTPUT_BALANCE));
    }
    TYN_TRY(tyn_frame_scene_build(&ctx->frame, frame->scene, view, &projection, &ctx->map_light,
                                  &ctx->surfaces, log));
    TYN_TRY(tyn_frame_phases(ctx, frame->scene));
    TYN_TRY(tyn_atlas_plan(&ctx->atlas, frame->scene, log));
    tyn_colors_plan(&ctx->colors, frame->scene);
    choose_storage(ctx);
    look_at_grid(ctx, frame->scene);
    if (view->outputs & TYN_OUTPUT_PROBE) {
        TYN_TRY(update_points(ctx, view));
    }
    *job = (tyn_job){.method = &ctx->method->info,
                     .capacity = ctx->dev->capacity,
                     .scene = frame->scene,
                     .view = view,
                     .settings = ctx->settings,
                     .frame = &ctx->frame,
                     .outputs = view->outputs ? view->outputs : TYN_OUTPUT_RADIANCE,
                     .readback = ctx->readback,
                     .log = log,
                     .warn = tyn_context_warn,
                     .warn_user = ctx};
    job->hooks = tyn_picture_hooks(&job->num_hooks);
    job->light = &frame->light;
    job->half_view =
        job->outputs & TYN_OUTPUT_COMPOSITE && frame->color->extent.width != view->width;
    memcpy(job->host_depth, projection.depth, sizeof job->host_depth);
    return TYN_OK;
}
