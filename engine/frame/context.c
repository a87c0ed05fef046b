// context.c -- tyn_context: a method on a scene, recorded into the caller's command buffer.
#include <tyndall/context.h>
#include "frame/frame_scene.h"
#include "registry/registry.h"
#include "base/hash.h"
#include "frame/env_cdf.h"
#include "methods/limits.h"
#include "gpu/device.h"
#include "passes/medium/medium.h"
#include "scene/check.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_WARNINGS = 32 };

struct tyn_context {
    tyn_device *dev;
    const tyn_method *method;
    tyn_settings *settings;
    bool readback;
    const char *inspect; // pass to look at; NULL = none
    tyn_graph *graph;
    // What the last declaration was made from; the graph reads it until it has recorded.
    tyn_frame_scene frame;
    tyn_atlas atlas;
    const tyn_scene *scene;
    float (*points)[3]; // probe points in M
    uint32_t num_points;
    uint32_t outputs;
    // The environment's tables, made again when its texels change.
    uint64_t env_hash;
    uint64_t grid_hash; // of the grid that the two below were found for
    uint32_t open_faces;
    float mean_density, typical_density;
    uint64_t checked_data; // hash of the densities and texels that were found fit
    tyn_map_light map_light;
    void *env_cdf; // of a method that reads it
    tyn_surface_data surfaces;
    char *warnings[MAX_WARNINGS];
    uint32_t num_warnings;
    uint64_t logged[MAX_WARNINGS]; // hashes of those that went to the log: once each
    uint32_t num_logged;
    tyn_node_report *nodes; // of the last report
    tyn_balance balance;
};

// ---- create, destroy --------------------------------------------------------------------------

tyn_result tyn_context_create(tyn_device *dev, const tyn_context_params *params, tyn_context **out)
{
    *out = NULL;
    if (!dev || !params || params->struct_size < sizeof *params) {
        tyn_log_print(dev ? &dev->log : NULL, TYN_LOG_ERROR,
                      "tyn_context_create: use the tyn_context_params() macro");
        return TYN_ERR_PARAMS;
    }
    const tyn_method *method = tyn_method_find(params->method);
    if (!method) {
        char names[128];
        tyn_method_names(names, sizeof names);
        tyn_log_print(&dev->log, TYN_LOG_ERROR, "method '%s' is not known; there are: %s",
                      params->method, names);
        return TYN_ERR_PARAMS;
    }
    uint32_t slots = params->frames_in_flight ? params->frames_in_flight : 2;
    if (slots > 8) {
        tyn_log_print(&dev->log, TYN_LOG_ERROR, "frames_in_flight is %u; it must be 1 to 8", slots);
        return TYN_ERR_PARAMS;
    }
    tyn_context *ctx = calloc(1, sizeof *ctx);
    if (!ctx) {
        return TYN_ERR_MEMORY;
    }
    ctx->dev = dev;
    ctx->method = method;
    ctx->readback = params->readback;
    tyn_result result = tyn_settings_copy(params->settings, &ctx->settings);
    if (result == TYN_OK) {
        result = tyn_graph_create(dev, slots, &ctx->graph);
    }
    if (result != TYN_OK) {
        tyn_context_destroy(&ctx);
    }
    *out = ctx;
    return result;
}

static void clear_warnings(tyn_context *ctx)
{
    for (uint32_t i = 0; i < ctx->num_warnings; i++) {
        free(ctx->warnings[i]);
    }
    ctx->num_warnings = 0;
}

void tyn_context_destroy(tyn_context **context)
{
    tyn_context *ctx = context ? *context : NULL;
    if (!ctx) {
        return;
    }
    *context = NULL;
    tyn_graph_destroy(&ctx->graph);
    tyn_settings_destroy(&ctx->settings);
    clear_warnings(ctx);
    free(ctx->points);
    free(ctx->env_cdf);
    tyn_surface_data_finish(&ctx->surfaces);
    free(ctx->nodes);
    free(ctx);
}

// ---- declaring a frame ------------------------------------------------------------------------

// To the log once in a context's life, however many frames give it.
static void log_warning(tyn_context *ctx, const char *line)
{
    const uint64_t hash = tyn_hash_bytes(TYN_HASH_SEED, line, strlen(line));
    for (uint32_t i = 0; i < ctx->num_logged; i++) {
        if (ctx->logged[i] == hash) {
            return;
        }
    }
    if (ctx->num_logged < MAX_WARNINGS) {
        ctx->logged[ctx->num_logged++] = hash;
        tyn_log_print(&ctx->dev->log, TYN_LOG_WARN, "%s: %s", ctx->method->info.name, line);
    }
}

static void add_warning(void *user, const char *line)
{
    tyn_context *ctx = user;
    for (uint32_t i = 0; i < ctx->num_warnings; i++) {
        if (!strcmp(ctx->warnings[i], line)) {
            return;
        }
    }
    char *copy = ctx->num_warnings < MAX_WARNINGS ? strdup(line) : NULL;
    if (copy) {
        ctx->warnings[ctx->num_warnings++] = copy;
        log_warning(ctx, line);
    }
}

static tyn_result check_frame(const tyn_context *ctx, const tyn_frame *frame)
{
    const tyn_log *log = &ctx->dev->log;
    if (!frame || frame->struct_size < sizeof *frame || !frame->scene || !frame->view) {
        tyn_log_print(log, TYN_LOG_ERROR,
                      "tyn_frame: scene and view are required (use the tyn_frame() macro)");
        return TYN_ERR_PARAMS;
    }
    const tyn_view *view = frame->view;
    uint32_t outputs = view->outputs ? view->outputs : TYN_OUTPUT_RADIANCE;
    if (outputs & ~ctx->method->info.outputs) {
        uint32_t missing = outputs & ~ctx->method->info.outputs;
        tyn_log_print(log, TYN_LOG_ERROR, "method '%s' cannot make the output '%s'",
                      ctx->method->info.name, tyn_output_name((tyn_output)(missing & -missing)));
        return TYN_ERR_PARAMS;
    }
    if (!view->width || !view->height || view->width > 16384 || view->height > 16384) {
        tyn_log_print(log, TYN_LOG_ERROR, "size is %u x %u; each side must be 1 to 16384 pixels",
                      view->width, view->height);
        return TYN_ERR_PARAMS;
    }
    if ((outputs & TYN_OUTPUT_PROBE) && (!view->points || !view->num_points)) {
        tyn_log_print(log, TYN_LOG_ERROR, "a probe needs at least one point");
        return TYN_ERR_PARAMS;
    }
    if (outputs & TYN_OUTPUT_COMPOSITE) {
        const tyn_image *color = frame->color;
        if (!color || !(color->usage & VK_IMAGE_USAGE_STORAGE_BIT) ||
            (color->format != VK_FORMAT_R16G16B16A16_SFLOAT &&
             color->format != VK_FORMAT_R32G32B32A32_SFLOAT)) {
            tyn_log_print(log, TYN_LOG_ERROR,
                          "COMPOSITE needs tyn_frame.color: rgba16f or rgba32f with "
                          "VK_IMAGE_USAGE_STORAGE_BIT");
            return TYN_ERR_PARAMS;
        }
        if (color->extent.width != view->width || color->extent.height != view->height) {
            tyn_log_print(log, TYN_LOG_ERROR,
                          "color is %u x %u, the view is %u x %u; make them equal",
                          color->extent.width, color->extent.height, view->width, view->height);
            return TYN_ERR_PARAMS;
        }
    }
    tyn_result result = tyn_camera_check(&view->camera, 0, log);
    return result == TYN_OK ? tyn_scene_check_values(frame->scene, log) : result;
}

static void fill_atlas(void *user, void *texels)
{
    const tyn_context *ctx = user;
    tyn_atlas_fill(&ctx->atlas, ctx->scene, texels);
}

static void fill_environment(void *user, void *texels)
{
    const tyn_environment *env = &((const tyn_context *)user)->scene->environment;
    float *out = texels;
    for (size_t i = 0; i < (size_t)env->size[0] * env->size[1]; i++) {
        memcpy(out + i * 4, env->data + i * 3, 3 * sizeof(float));
        out[i * 4 + 3] = 1;
    }
}

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

static void upload_surfaces(tyn_context *ctx, const tyn_surfaces *s, tyn_scene_refs *refs)
{
    tyn_graph *g = ctx->graph;
    const tyn_surface_data *data = &ctx->surfaces;
    const struct surface_block *block = &ctx->frame.surfaces;
    if (!ctx->frame.num_triangles) {
        return;
    }
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
        {&refs->geometry.nodes, "nodes", s->nodes, s->num_nodes * sizeof *s->nodes},
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

static void upload_scene(tyn_context *ctx, const tyn_frame *frame, tyn_scene_refs *refs)
{
    tyn_graph *g = ctx->graph;
    const tyn_frame_scene *f = &ctx->frame;
    const tyn_scene *scene = frame->scene;
    if (ctx->atlas.host) {
        uint64_t version = frame->density_versions ? frame->density_versions[0] : 0;
        refs->atlas =
            tyn_graph_import_image(g, "atlas", TYN_IMAGE_3D, &frame->densities[0], version);
    } else if (ctx->atlas.extent.z) {
        refs->atlas = tyn_graph_upload_image(
            g, "atlas", TYN_IMAGE_3D, ctx->atlas.half ? VK_FORMAT_R16_SFLOAT : VK_FORMAT_R32_SFLOAT,
            ctx->atlas.extent, fill_atlas, ctx, tyn_atlas_hash(&ctx->atlas, scene));
    }
    refs->medium = tyn_graph_upload_buffer(g, "medium", &f->medium, sizeof f->medium, 0);
    refs->shapes = tyn_graph_upload_buffer(g, "shapes", f->shapes, sizeof f->shapes, 0);
    tyn_graph_mark_media(g, refs->atlas);
    tyn_graph_mark_media(g, refs->medium);
    tyn_graph_mark_media(g, refs->shapes);

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
    uint64_t hash = tyn_atlas_hash(&ctx->atlas, scene);
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

static void choose_storage(tyn_context *ctx)
{
    tyn_medium_params medium = {0};
    tyn_settings_params(ctx->settings, &tyn_pass_medium, &medium);
    if (medium.storage == TYN_MEDIUM_STORAGE_AUTO) {
        // Half floats save bandwidth; a CPU has to unpack them, which takes longer than to filter.
        ctx->atlas.half &= ctx->dev->properties.deviceType != VK_PHYSICAL_DEVICE_TYPE_CPU;
    } else {
        ctx->atlas.half &= medium.storage == TYN_MEDIUM_STORAGE_HALF;
    }
}

static tyn_result make_job(tyn_context *ctx, const tyn_frame *frame, tyn_job *job)
{
    const tyn_view *view = frame->view;
    const tyn_log *log = &ctx->dev->log;
    ctx->scene = frame->scene;
    tyn_result result = update_environment(ctx, &frame->scene->environment);
    if (result == TYN_OK) {
        result = tyn_surface_data_update(&ctx->surfaces, &frame->scene->surfaces, log);
    }
    if (result == TYN_OK && ctx->method->info.traces_rays) {
        result = tyn_surface_data_tables(&ctx->surfaces, &frame->scene->surfaces,
                                         view->outputs & TYN_OUTPUT_BALANCE);
    }
    if (result == TYN_OK) {
        result = tyn_frame_scene_build(&ctx->frame, frame->scene, view, &ctx->map_light,
                                       &ctx->surfaces, log);
    }
    if (result == TYN_OK) {
        result = tyn_atlas_plan(&ctx->atlas, frame->scene, log);
        choose_storage(ctx);
    }
    if (result == TYN_OK) {
        look_at_grid(ctx, frame->scene);
    }
    if (result == TYN_OK && ctx->atlas.host && !frame->densities) {
        tyn_log_print(log, TYN_LOG_ERROR, "volume 0 has no data and tyn_frame.densities is NULL");
        result = TYN_ERR_PARAMS;
    }
    if (result == TYN_OK && (view->outputs & TYN_OUTPUT_PROBE)) {
        result = update_points(ctx, view);
    }
    if (result != TYN_OK) {
        return result;
    }
    *job = (tyn_job){.method = &ctx->method->info,
                     .scene = frame->scene,
                     .view = view,
                     .settings = ctx->settings,
                     .frame = &ctx->frame,
                     .outputs = view->outputs ? view->outputs : TYN_OUTPUT_RADIANCE,
                     .readback = ctx->readback,
                     .log = log,
                     .warn = add_warning,
                     .warn_user = ctx};
    memcpy(job->view_to_clip, frame->view_to_clip, sizeof job->view_to_clip);
    return TYN_OK;
}

static tyn_result declare(tyn_context *ctx, const tyn_frame *frame)
{
    tyn_result result = check_frame(ctx, frame);
    tyn_job job;
    if (result == TYN_OK) {
        result = make_job(ctx, frame, &job);
    }
    if (result != TYN_OK) {
        return result;
    }
    ctx->outputs = job.outputs;
    tyn_graph_begin(ctx->graph);
    if (frame->recompute) {
        tyn_graph_recompute(ctx->graph);
    }
    if (frame->setup_only) {
        tyn_graph_setup_only(ctx->graph);
    }
    tyn_graph_inspect(ctx->graph, ctx->readback ? ctx->inspect : NULL);
    upload_scene(ctx, frame, &job.refs);
    tyn_limits_warn(&job, 0);
    result = ctx->method->declare(ctx->graph, &job);
    return result == TYN_OK ? tyn_graph_status(ctx->graph) : result;
}

// ---- prepare, record --------------------------------------------------------------------------

tyn_result tyn_context_prepare(tyn_context *ctx, const tyn_frame *frame)
{
    clear_warnings(ctx);
    tyn_result result = declare(ctx, frame);
    uint64_t data = result == TYN_OK
                        ? tyn_hash_u64(tyn_atlas_hash(&ctx->atlas, frame->scene), ctx->env_hash)
                        : 0;
    if (result == TYN_OK && data != ctx->checked_data) {
        result = tyn_scene_check_data(frame->scene, &ctx->dev->log);
        ctx->checked_data = result == TYN_OK ? data : 0;
    }
    if (result == TYN_OK && tyn_graph_matches(ctx->graph)) {
        tyn_graph_trim(ctx->graph);
    } else if (result == TYN_OK) {
        result = tyn_graph_compile(ctx->graph);
    }
    return result;
}

tyn_result tyn_context_record(tyn_context *ctx, const tyn_frame *frame)
{
    if (!frame || !frame->cmd) {
        tyn_log_print(&ctx->dev->log, TYN_LOG_ERROR, "tyn_frame: cmd is required");
        return TYN_ERR_PARAMS;
    }
    tyn_result result = declare(ctx, frame);
    return result == TYN_OK ? tyn_graph_record(ctx->graph, frame->cmd) : result;
}

uint32_t tyn_context_batch(tyn_context *ctx, const tyn_frame *frame)
{
    tyn_job job;
    if (!ctx->method->batch || check_frame(ctx, frame) != TYN_OK ||
        make_job(ctx, frame, &job) != TYN_OK) {
        return 1;
    }
    uint32_t batch = ctx->method->batch(&job);
    return batch ? batch : 1;
}

// ---- outputs ----------------------------------------------------------------------------------

const void *tyn_context_output(tyn_context *ctx, tyn_output output)
{
    return ctx->outputs & output ? tyn_graph_map(ctx->graph, tyn_output_name(output), NULL, NULL)
                                 : NULL;
}

// ---- what happened ----------------------------------------------------------------------------

static const char *state_name(tyn_node_state state)
{
    static const char *const names[] = {"ran", "unchanged", "culled", "empty"};
    return names[state];
}

static void add_work(tyn_node_report *node, const char *name, double amount)
{
    if (node->num_work < sizeof node->work / sizeof node->work[0]) {
        node->work[node->num_work].name = name;
        node->work[node->num_work++].amount = amount;
    }
}

// In percent to one digit: no more is known, and frames of a film say the same line.
static double percent_of(double share)
{
    const double percent = 100 * fmin(share, 1), unit = pow(10, floor(log10(percent)));
    return unit * round(percent / unit);
}

// What the node itself counted, by the table of its pass.
static void add_counters(tyn_node_report *node, tyn_context *ctx)
{
    const tyn_pass_desc *pass = tyn_pass_find(node->name);
    const uint8_t *data = tyn_graph_map(ctx->graph, node->name, NULL, NULL);
    for (const tyn_counter *c = pass && data ? pass->counters : NULL; c && c->name; c++) {
        double most = 0;
        for (uint32_t i = 0; i < (c->count ? c->count : 1); i++) {
            const void *at = data + c->offset + 4 * i;
            most = fmax(most, c->real ? (double)*(const float *)at : *(const uint32_t *)at);
        }
        add_work(node, c->name, most);
        if (c->warning && most > c->limit) {
            char line[256];
            snprintf(line, sizeof line, c->warning, percent_of(most));
            add_warning(ctx, line);
        }
    }
}

void tyn_context_report(tyn_context *ctx, tyn_report *report)
{
    *report = (tyn_report){0};
    const tyn_node_stats *stats;
    uint32_t count = tyn_graph_stats(ctx->graph, &stats);
    tyn_node_report *nodes = realloc(ctx->nodes, (count ? count : 1) * sizeof *nodes);
    if (!nodes) {
        return;
    }
    ctx->nodes = nodes;
    for (uint32_t i = 0; i < count; i++) {
        const tyn_node_stats *s = &stats[i];
        nodes[i] = (tyn_node_report){.name = s->name,
                                     .state = state_name(s->state),
                                     .gpu_ms = s->gpu_ms,
                                     .cpu_ms = s->cpu_ms,
                                     .dispatches = s->dispatches,
                                     .barriers = s->barriers,
                                     .bytes = s->bytes,
                                     .media_only = s->media_only};
        for (uint32_t w = 0; w < s->num_work; w++) {
            if (!strcmp(s->work[w].name, "flops")) {
                nodes[i].flops = s->work[w].amount;
            } else {
                add_work(&nodes[i], s->work[w].name, s->work[w].amount);
            }
        }
        if (s->state != TYN_NODE_CULLED) {
            add_counters(&nodes[i], ctx);
        }
    }
    report->nodes = nodes;
    report->num_nodes = count;
    report->warnings = (const char *const *)ctx->warnings;
    report->num_warnings = ctx->num_warnings;
    tyn_graph_memory(ctx->graph, &report->persistent_bytes, &report->transient_bytes);
}

void tyn_context_inspect(tyn_context *ctx, const char *pass)
{
    ctx->inspect = pass;
}

bool tyn_context_inspection(tyn_context *ctx, tyn_inspection *inspection)
{
    *inspection = (tyn_inspection){0};
    const tyn_pass_desc *pass = ctx->inspect ? tyn_pass_find(ctx->inspect) : NULL;
    tyn_extent extent = {0};
    const void *texels = tyn_graph_map(ctx->graph, "inspect", &extent, &inspection->format);
    if (!pass || !texels) {
        return false;
    }
    inspection->port = pass->ports[pass->debug_port].name;
    inspection->meaning = pass->debug_meaning;
    inspection->size[0] = extent.x;
    inspection->size[1] = extent.y;
    inspection->size[2] = extent.z ? extent.z : 1;
    inspection->texels = texels;
    return true;
}

char *tyn_context_graph(tyn_context *ctx, bool dot)
{
    return tyn_graph_dump(ctx->graph, dot, ctx->method->info.passes);
}
