// check.c -- are the numbers of a frame fit?
#include "frame/context.h"
#include "base/fault.h"
#include "gpu/device.h"
#include "gpu/needs.h"
#include "registry/registry.h"
#include "scene/check.h"

// Of outputs that the method does not make, the first.
static tyn_result refuse_outputs(const tyn_context *ctx, uint32_t missing)
{
    const tyn_method_info *method = &ctx->method->info;
    const uint32_t first = missing & -missing;
    const bool no_probes = first == TYN_OUTPUT_LIGHT && !(method->outputs & TYN_OUTPUT_PROBE);
    char makers[256] = "";
    tyn_method_names(first, makers, sizeof makers);
    return TYN_FAULT(&ctx->dev->log, TYN_ERR_PARAMS,
                     "method '%s' cannot make the output '%s'%s%s%s", method->name,
                     tyn_output_name((tyn_output)first),
                     no_probes ? ": it has no probes, of which the light field is made" : "",
                     *makers ? "; these can: " : "", makers);
}

static tyn_result check_resume(const tyn_context *ctx, const tyn_view *view, uint32_t outputs)
{
    const tyn_resume *r = view->resume;
    const tyn_log *log = &ctx->dev->log;
    if (!(ctx->method->info.outputs & TYN_OUTPUT_LOW)) {
        FAULT("tyn_view.resume: method '%s' does not go on from what earlier samples left",
              ctx->method->info.name);
    }
    if (!r->num_samples || !r->hash || !r->radiance || !r->low || !r->deviation) {
        FAULT("tyn_resume: num_samples, hash, radiance, low and deviation are required");
    }
    if ((outputs & TYN_OUTPUT_SINGLE && !r->single) ||
        (outputs & TYN_OUTPUT_MULTIPLE && !r->multiple) ||
        (outputs & TYN_OUTPUT_TRANSMITTANCE && !r->transmittance)) {
        FAULT("tyn_resume: of single, multiple and transmittance those are required that are "
              "outputs of the frame");
    }
    if (view->first_sample < r->num_samples) {
        FAULT("tyn_view.first_sample is %u: after %u samples in tyn_resume it must be that or more",
              view->first_sample, r->num_samples);
    }
    return TYN_OK;
}

uint32_t tyn_frame_most_pixels(const tyn_device *dev)
{
    const uint32_t side = dev->properties.limits.maxImageDimension2D;
    return side < TYN_MOST_SIDE ? side : TYN_MOST_SIDE;
}

tyn_result tyn_frame_check(const tyn_context *ctx, const tyn_frame *frame)
{
    const tyn_log *log = &ctx->dev->log;
    if (!frame || frame->struct_size < sizeof *frame || !frame->scene || !frame->view) {
        return TYN_FAULT(log, TYN_ERR_PARAMS,
                         "tyn_frame: scene and view are required (use the tyn_frame() macro)");
    }
    const tyn_view *view = frame->view;
    uint32_t outputs = view->outputs ? view->outputs : TYN_OUTPUT_RADIANCE;
    if (outputs & ~ctx->method->info.outputs) {
        return refuse_outputs(ctx, outputs & ~ctx->method->info.outputs);
    }
    const uint32_t most = tyn_frame_most_pixels(ctx->dev);
    if (!view->width || !view->height || view->width > most || view->height > most) {
        FAULT("size is %u x %u; each side must be 1 to %u pixels", view->width, view->height, most);
    }
    const uint64_t bytes = 16ull * view->width * view->height; // of an image in rgba32f
    if (ctx->dev->image_bytes && bytes > ctx->dev->image_bytes) {
        FAULT("size is %u x %u: an image of it takes %.0f MiB, this device allows %.0f",
              view->width, view->height, (double)bytes / (1 << 20),
              (double)ctx->dev->image_bytes / (1 << 20));
    }
    if ((outputs & TYN_OUTPUT_PROBE) && (!view->points || !view->num_points)) {
        return TYN_FAULT(log, TYN_ERR_PARAMS, "a probe needs at least one point");
    }
    tyn_frame_projection projection;
    TYN_TRY(tyn_frame_projection_find(&projection, frame, log));
    if (view->resume) {
        TYN_TRY(check_resume(ctx, view, outputs));
    }
    TYN_TRY(tyn_scene_check_values(frame->scene, log));
    return tyn_frame_check_images(ctx, frame, outputs);
}
