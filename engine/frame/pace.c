// pace.c -- how long a sample of a progressive method's picture takes on this device, from the records before.
#include "frame/context.h"
#include <string.h>

// True if the frame starts the statistics anew. Another camera, or scene, takes another time.
static bool begins(const tyn_view *view)
{
    return view->first_sample == 0 ||
           (view->resume && view->first_sample == view->resume->num_samples);
}

void tyn_frame_sampled(tyn_context *ctx, const tyn_frame *frame)
{
    const tyn_view *view = frame->view;
    const uint64_t number = tyn_graph_records(ctx->graph);
    if (begins(view)) {
        memset(ctx->sampled, 0, sizeof ctx->sampled);
    }
    if (!frame->setup_only) {
        ctx->sampled[number % MAX_IN_FLIGHT].number = number;
        ctx->sampled[number % MAX_IN_FLIGHT].samples = view->num_samples ? view->num_samples : 1;
    }
}

double tyn_frame_sample_ms(tyn_context *ctx, const tyn_view *view, uint32_t *samples)
{
    double ms;
    const uint64_t number = tyn_graph_finished(ctx->graph, &ms);
    if (!number || begins(view) || ctx->sampled[number % MAX_IN_FLIGHT].number != number) {
        return 0;
    }
    *samples = ctx->sampled[number % MAX_IN_FLIGHT].samples;
    return ms / *samples;
}
