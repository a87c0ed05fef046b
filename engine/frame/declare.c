// declare.c -- a frame as nodes of the graph.
#include "frame/context.h"
#include "frame/impostor.h"
#include <tyndall/extend/limits.h>
#include "passes/halve_depth/halve_depth.h"

// The march ends at a depth of its own size.
static void halve_depth(tyn_graph *g, tyn_scene_refs *refs)
{
    const tyn_halve_depth_params params = {0};
    tyn_ref ports[HALVE_DEPTH_NUM_PORTS] = {[HALVE_DEPTH_PORT_FULL_DEPTH] = refs->depth};
    tyn_graph_add(g, &tyn_pass_halve_depth, &params, ports);
    refs->full_depth = refs->depth;
    refs->depth = ports[HALVE_DEPTH_PORT_HALF_DEPTH];
}

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
    if (frame->recompute) {
        tyn_graph_recompute(ctx->graph);
    }
    if (frame->background) {
        tyn_graph_background(ctx->graph);
    }
    if (frame->idle) {
        tyn_graph_idle(ctx->graph);
    }
    if (frame->setup_only) {
        tyn_graph_setup_only(ctx->graph);
    }
    tyn_graph_inspect(ctx->graph, ctx->readback ? ctx->inspect : NULL);
    tyn_frame_upload(ctx, frame, &job.refs);
    if (job.refs.depth.resource && job.half_view) {
        halve_depth(ctx->graph, &job.refs);
    }
    tyn_frame_impostor(ctx, &job);
    tyn_limits_warn(&job, 0);
    result = ctx->method->declare(ctx->graph, &job);
    return result == TYN_OK ? tyn_graph_status(ctx->graph) : result;
}
