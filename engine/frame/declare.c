// declare.c -- a frame as nodes of the graph.
#include "frame/context.h"

tyn_result tyn_frame_declare(tyn_context *ctx, const tyn_frame *frame)
{
    tyn_result result = tyn_frame_check(ctx, frame);
    tyn_job job;
    if (result == TYN_OK) {
        result = tyn_frame_build(ctx, frame, &job);
    }
    if (result != TYN_OK) {
        return result;
    }
    ctx->outputs = job.outputs;
    tyn_graph_begin(ctx->graph);
    *tyn_graph_mode(ctx->graph) = (tyn_record_mode){.recompute = frame->recompute,
                                                    .setup_only = frame->setup_only,
                                                    .background = frame->background,
                                                    .idle = frame->idle};
    tyn_graph_inspect(ctx->graph, ctx->readback ? ctx->inspect : NULL);
    tyn_frame_upload(ctx, frame, &job.refs);
    for (uint32_t i = 0; i < job.num_hooks; i++) {
        if (job.hooks[i]->prepare) {
            job.hooks[i]->prepare(ctx->graph, &job);
        }
    }
    result = ctx->method->declare(ctx->graph, &job);
    return result == TYN_OK ? tyn_graph_status(ctx->graph) : result;
}
