// record.c -- prepares a frame, records it into the caller's command buffer, and gives out what it made.
#include "frame/context.h"
#include "base/fault.h"
#include "base/given.h"
#include <tyndall/extend/hash.h>
#include "gpu/device.h"
#include "frame/output.h"
#include "scene/check.h"

tyn_result tyn_context_prepare(tyn_context *ctx, const tyn_frame *frame)
{
    if (!ctx) {
        return TYN_ERR_PARAMS;
    }
    tyn_context_clear_warnings(ctx);
    TYN_TRY(tyn_frame_declare(ctx, frame));
    uint64_t data = tyn_hash_u64(tyn_atlas_hash(&ctx->atlas), ctx->env_hash);
    data = tyn_hash_u64(data, tyn_atlas_hash(&ctx->colors));
    const uint64_t phases = tyn_phase_tables_hash(frame->scene);
    data = phases ? tyn_hash_u64(data, phases) : data;
    if (data != ctx->checked_data) {
        ctx->checked_data = 0;
        TYN_TRY(tyn_scene_check_data(frame->scene, &ctx->dev->log));
        ctx->checked_data = data;
    }
    if (tyn_graph_matches(ctx->graph)) {
        tyn_graph_trim(ctx->graph);
    } else {
        TYN_TRY(tyn_graph_compile(ctx->graph));
    }
    ctx->sizes = tyn_frame_sizes(ctx, frame);
    return TYN_OK;
}

tyn_result tyn_context_record(tyn_context *ctx, const tyn_frame *frame)
{
    if (!ctx) {
        return TYN_ERR_PARAMS;
    }
    if (!frame || !frame->cmd) {
        return TYN_FAULT(&ctx->dev->log, TYN_ERR_PARAMS, "tyn_frame: cmd is required");
    }
    TYN_TRY(tyn_frame_declare(ctx, frame));
    TYN_TRY(tyn_frame_check_content(ctx, frame));
    tyn_graph_mode(ctx->graph)->yields = ctx->sizes == tyn_frame_sizes(ctx, frame);
    TYN_TRY(tyn_graph_record(ctx->graph, frame->cmd));
    tyn_frame_sampled(ctx, frame);
    return TYN_OK;
}

void tyn_context_forget(tyn_context *ctx)
{
    if (ctx) {
        tyn_graph_forget(ctx->graph);
    }
}

uint32_t tyn_context_pending(tyn_context *ctx)
{
    return ctx ? tyn_graph_pending(ctx->graph) : 0;
}

uint32_t tyn_context_batch(tyn_context *ctx, const tyn_frame *frame)
{
    tyn_job job;
    if (!ctx || !ctx->method->batch || tyn_frame_check(ctx, frame) != TYN_OK ||
        tyn_frame_build(ctx, frame, &job) != TYN_OK) {
        return 1;
    }
    // On a processor estimates are good enough, and records of the same samples give the same bits.
    enum { STEP = 8 };
    uint32_t samples, most = UINT32_MAX;
    job.sample_ms = job.capacity.software ? 0 : tyn_frame_sample_ms(ctx, frame->view, &samples);
    if (job.sample_ms > 0 && samples < most / STEP) {
        most = STEP * samples;
    }
    const uint32_t batch = ctx->method->batch(&job);
    return batch < 1 ? 1 : batch > most ? most : batch;
}

tyn_result tyn_context_light(const tyn_context *ctx, float world_to_texture[16])
{
    if (!ctx || !TYN_GIVEN(&ctx->dev->log, world_to_texture)) {
        return TYN_ERR_PARAMS;
    }
    if (!(ctx->outputs & TYN_OUTPUT_LIGHT)) {
        return TYN_FAULT(&ctx->dev->log, TYN_ERR_PARAMS,
                         "tyn_context_light: no frame with TYN_OUTPUT_LIGHT has been prepared");
    }
    for (int i = 0; i < 16; i++) {
        const float size = i % 4 < 3 ? ctx->frame.medium.extent[i % 4] : 1;
        world_to_texture[i] = ctx->frame.m_from_world[i] / size;
    }
    return TYN_OK;
}

const void *tyn_context_output(tyn_context *ctx, tyn_output output)
{
    return ctx && ctx->outputs & output
               ? tyn_graph_map(ctx->graph, tyn_job_output_name(output), NULL, NULL)
               : NULL;
}
