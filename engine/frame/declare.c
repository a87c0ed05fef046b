// declare.c -- a frame as nodes of the graph.
#include "frame/context.h"
#include "base/fault.h"

tyn_result tyn_frame_declare(tyn_context *ctx, const tyn_frame *frame)
{
    tyn_job job;
    TYN_TRY(tyn_frame_check(ctx, frame));
    TYN_TRY(tyn_frame_build(ctx, frame, &job));
    ctx->outputs = job.outputs;
    tyn_graph_begin(ctx->graph);
    *tyn_graph_mode(ctx->graph) = (tyn_record_mode){.recompute = frame->recompute,
                                                    .setup_only = frame->setup_only,
                                                    .counters = ctx->readback,
                                                    .inspect = ctx->readback ? ctx->inspect : NULL,
                                                    .background = frame->background,
                                                    .idle = frame->idle};
    tyn_frame_upload(ctx, frame, &job.refs);
    for (uint32_t i = 0; i < job.num_hooks; i++) {
        if (job.hooks[i]->prepare) {
            job.hooks[i]->prepare(ctx->graph, &job);
        }
    }
    TYN_TRY(ctx->method->declare(ctx->graph, &job));
    return tyn_graph_status(ctx->graph);
}
