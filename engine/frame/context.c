// context.c -- tyn_context: made, destroyed, and its warnings. The way of a frame: context.h.
#include "frame/context.h"
#include "gpu/device.h"
#include "registry/registry.h"
#include <tyndall/extend/hash.h>
#include "base/given.h"
#include <stdlib.h>
#include <string.h>

tyn_result tyn_context_create(tyn_device *dev, const tyn_context_params *params, tyn_context **out)
{
    if (out) {
        *out = NULL;
    }
    if (!TYN_GIVEN(dev ? &dev->log : NULL, dev, params, out) ||
        !tyn_sized(&dev->log, __func__, params->struct_size, sizeof *params,
                   "tyn_context_params")) {
        return TYN_ERR_PARAMS;
    }
    const tyn_method *method = tyn_method_find(params->method);
    if (!method) {
        char names[128];
        tyn_method_names(0, names, sizeof names);
        return TYN_FAULT(&dev->log, TYN_ERR_PARAMS, "method '%s' is not known; there are: %s",
                         params->method, names);
    }
    uint32_t slots = params->frames_in_flight ? params->frames_in_flight : 2;
    if (slots > 8) {
        return TYN_FAULT(&dev->log, TYN_ERR_PARAMS, "frames_in_flight is %u; it must be 1 to 8",
                         slots);
    }
    tyn_context *ctx = calloc(1, sizeof *ctx);
    if (!ctx) {
        return TYN_ERR_MEMORY;
    }
    ctx->dev = dev;
    ctx->method = method;
    ctx->readback = params->readback;
    tyn_result result =
        tyn_settings_copy(params->settings, params->quality, &dev->log, &ctx->settings);
    if (result == TYN_OK) {
        result = tyn_graph_create(dev, slots, &ctx->graph);
    }
    if (result == TYN_OK) {
        tyn_graph_budget(ctx->graph, params->memory_budget);
    }
    if (result != TYN_OK) {
        tyn_context_destroy(&ctx);
    }
    *out = ctx;
    return result;
}

tyn_result tyn_context_set(tyn_context *ctx, const char *name, const char *value)
{
    return ctx ? tyn_settings_set(ctx->settings, name, value, &ctx->dev->log) : TYN_ERR_PARAMS;
}

tyn_result tyn_context_set_quality(tyn_context *ctx, tyn_quality quality)
{
    const char *preset = tyn_quality_name(quality);
    if (ctx && !preset) {
        tyn_log_print(&ctx->dev->log, TYN_LOG_ERROR, "quality is %d; it is one of tyn_quality",
                      (int)quality);
    }
    return ctx && preset ? tyn_settings_quality(ctx->settings, preset, &ctx->dev->log)
                         : TYN_ERR_PARAMS;
}

tyn_result tyn_context_get(tyn_context *ctx, const char *name, double *value)
{
    if (!ctx || !TYN_GIVEN(&ctx->dev->log, name, value)) {
        return TYN_ERR_PARAMS;
    }
    tyn_setting setting;
    const tyn_result result = tyn_settings_get(ctx->settings, name, &setting, &ctx->dev->log);
    *value = setting.value;
    return result;
}

void tyn_context_clear_warnings(tyn_context *ctx)
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
    tyn_context_clear_warnings(ctx);
    free(ctx->points);
    free(ctx->env_cdf);
    free(ctx->phase_rows);
    tyn_surface_data_finish(&ctx->surfaces);
    free(ctx->nodes);
    free(ctx);
}

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

void tyn_context_warn(void *user, const char *line)
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
