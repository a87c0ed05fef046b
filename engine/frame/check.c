// check.c -- are the numbers of a frame fit?
#include "frame/context.h"
#include "gpu/device.h"
#include "scene/check.h"

tyn_result tyn_frame_check(const tyn_context *ctx, const tyn_frame *frame)
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
