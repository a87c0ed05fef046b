// check.c -- are the numbers of a frame fit?
#include "frame/context.h"
#include "gpu/device.h"
#include "registry/registry.h"
#include "scene/check.h"

#define FAULT(...) return (tyn_log_print(log, TYN_LOG_ERROR, __VA_ARGS__), TYN_ERR_PARAMS)

// An image that the host lends: `what` it is, and what it must be able to do.
static tyn_result check_image(const tyn_image *image, const char *what, VkImageUsageFlags usage,
                              const char *usage_name, const tyn_log *log)
{
    if (!image->image || !image->view) {
        FAULT("%s: image and view are required, %s is NULL", what, image->image ? "view" : "image");
    }
    if (!(image->usage & usage)) {
        FAULT("%s: its usage is 0x%x; it needs %s", what, image->usage, usage_name);
    }
    if (image->after.layout == VK_IMAGE_LAYOUT_UNDEFINED ||
        image->after.layout == VK_IMAGE_LAYOUT_PREINITIALIZED) {
        FAULT("%s: after.layout is %d; no image can be left in that layout", what,
              (int)image->after.layout);
    }
    return TYN_OK;
}

static tyn_result check_color(const tyn_image *color, const tyn_view *view, const tyn_log *log)
{
    if (!color || (color->format != VK_FORMAT_R16G16B16A16_SFLOAT &&
                   color->format != VK_FORMAT_R32G32B32A32_SFLOAT)) {
        FAULT(
            "COMPOSITE needs tyn_frame.color: rgba16f or rgba32f with VK_IMAGE_USAGE_STORAGE_BIT");
    }
    const uint32_t times = color->extent.width == 2 * view->width ? 2 : 1;
    if (color->extent.width != times * view->width ||
        color->extent.height != times * view->height) {
        FAULT("color is %u x %u, the view is %u x %u; make them equal, or color exactly twice the "
              "view",
              color->extent.width, color->extent.height, view->width, view->height);
    }
    return check_image(color, "color", VK_IMAGE_USAGE_STORAGE_BIT, "VK_IMAGE_USAGE_STORAGE_BIT",
                       log);
}

static tyn_result check_depth(const tyn_frame *frame, const tyn_log *log)
{
    static const VkFormat formats[] = {VK_FORMAT_D16_UNORM,         VK_FORMAT_X8_D24_UNORM_PACK32,
                                       VK_FORMAT_D32_SFLOAT,        VK_FORMAT_D16_UNORM_S8_UINT,
                                       VK_FORMAT_D24_UNORM_S8_UINT, VK_FORMAT_D32_SFLOAT_S8_UINT};
    const tyn_image *depth = frame->depth;
    bool known = false;
    for (size_t i = 0; i < sizeof formats / sizeof formats[0]; i++) {
        known = known || depth->format == formats[i];
    }
    if (!known) {
        FAULT("depth: format %d is no depth format", (int)depth->format);
    }
    const VkExtent3D size = frame->color->extent;
    if (depth->extent.width != size.width || depth->extent.height != size.height) {
        FAULT("depth is %u x %u, color is %u x %u; make them equal", depth->extent.width,
              depth->extent.height, size.width, size.height);
    }
    return check_image(depth, "depth", VK_IMAGE_USAGE_SAMPLED_BIT, "VK_IMAGE_USAGE_SAMPLED_BIT",
                       log);
}

// Images that take results.
static tyn_result check_results(const tyn_frame *frame, uint32_t outputs, const tyn_log *log)
{
    const tyn_frame_images *to = &frame->images;
    const struct {
        const tyn_image *image;
        const char *what, *output, *formats;
        tyn_output needs;
        VkFormat other;
    } results[] = {
        {to->radiance, "images.radiance", "RADIANCE", "rgba16f or rgba32f", TYN_OUTPUT_RADIANCE,
         VK_FORMAT_R16G16B16A16_SFLOAT},
        {to->transmittance, "images.transmittance", "TRANSMITTANCE", "rgba16f or rgba32f",
         TYN_OUTPUT_TRANSMITTANCE, VK_FORMAT_R16G16B16A16_SFLOAT},
        {to->depth, "images.depth", "DEPTH", "r32f or rgba32f", TYN_OUTPUT_DEPTH,
         VK_FORMAT_R32_SFLOAT},
    };
    for (size_t i = 0; i < sizeof results / sizeof results[0]; i++) {
        const tyn_image *image = results[i].image;
        if (!image) {
            continue;
        }
        if (!(outputs & results[i].needs)) {
            FAULT("%s is given, but tyn_view.outputs has no TYN_OUTPUT_%s", results[i].what,
                  results[i].output);
        }
        if (image->format != VK_FORMAT_R32G32B32A32_SFLOAT && image->format != results[i].other) {
            FAULT("%s: its format is %d; it must be %s", results[i].what, (int)image->format,
                  results[i].formats);
        }
        if (image->extent.width != frame->view->width ||
            image->extent.height != frame->view->height) {
            FAULT("%s is %u x %u, the view is %u x %u; make them equal", results[i].what,
                  image->extent.width, image->extent.height, frame->view->width,
                  frame->view->height);
        }
        const tyn_result result = check_image(image, results[i].what, VK_IMAGE_USAGE_STORAGE_BIT,
                                              "VK_IMAGE_USAGE_STORAGE_BIT", log);
        if (result != TYN_OK) {
            return result;
        }
    }
    return TYN_OK;
}

static tyn_result check_light(const tyn_frame_lights *light, const tyn_log *log)
{
    const tyn_image *images[3] = {light->red, light->green, light->blue};
    static const char *const names[3] = {"light.red", "light.green", "light.blue"};
    for (int i = 0; i < 3; i++) {
        const tyn_image *image = images[i];
        if (!image) {
            FAULT("LIGHT needs tyn_frame.light: %s is NULL", names[i]);
        }
        const VkExtent3D e = image->extent, first = images[0]->extent;
        if (image->format != VK_FORMAT_R16G16B16A16_SFLOAT &&
            image->format != VK_FORMAT_R32G32B32A32_SFLOAT) {
            FAULT("%s: its format is %d; it must be rgba16f or rgba32f", names[i],
                  (int)image->format);
        }
        if (image->format != images[0]->format || e.width != first.width ||
            e.height != first.height || e.depth != first.depth) {
            FAULT("%s: its format and its size must be those of light.red", names[i]);
        }
        if (!e.width || !e.height || !e.depth ||
            (uint64_t)e.width * e.height > (1u << 20) / e.depth) {
            FAULT("%s is %u x %u x %u; it must have 1 to 1048576 texels", names[i], e.width,
                  e.height, e.depth);
        }
        const tyn_result result = check_image(image, names[i], VK_IMAGE_USAGE_STORAGE_BIT,
                                              "VK_IMAGE_USAGE_STORAGE_BIT", log);
        if (result != TYN_OK) {
            return result;
        }
    }
    return TYN_OK;
}

// The images of volumes without data; that there are some is known when the scene is fit.
static tyn_result check_densities(const tyn_frame *frame, const tyn_log *log)
{
    const tyn_scene *scene = frame->scene;
    for (uint32_t i = 0, n = 0; i < scene->num_volumes; i++) {
        const tyn_volume *v = &scene->volumes[i];
        if (v->data) {
            continue;
        }
        if (!frame->densities) {
            FAULT("volume %u has no data and tyn_frame.densities is NULL", i);
        }
        const tyn_image *image = &frame->densities[n++];
        if (image->extent.width != v->size[0] || image->extent.height != v->size[1] ||
            image->extent.depth != v->size[2]) {
            FAULT("densities[%u] is %u x %u x %u, volume %u is %u x %u x %u; make them equal",
                  n - 1, image->extent.width, image->extent.height, image->extent.depth, i,
                  v->size[0], v->size[1], v->size[2]);
        }
        const tyn_result result = check_image(image, "densities", VK_IMAGE_USAGE_SAMPLED_BIT,
                                              "VK_IMAGE_USAGE_SAMPLED_BIT", log);
        if (result != TYN_OK) {
            return result;
        }
    }
    return TYN_OK;
}

// Of outputs that the method does not make, the first.
static tyn_result refuse_outputs(const tyn_context *ctx, uint32_t missing)
{
    const tyn_method_info *method = &ctx->method->info;
    const uint32_t first = missing & -missing;
    const bool no_probes = first == TYN_OUTPUT_LIGHT && !(method->outputs & TYN_OUTPUT_PROBE);
    char makers[256] = "";
    tyn_method_names(first, makers, sizeof makers);
    tyn_log_print(&ctx->dev->log, TYN_LOG_ERROR, "method '%s' cannot make the output '%s'%s%s%s",
                  method->name, tyn_output_name((tyn_output)first),
                  no_probes ? ": it has no probes, of which the light field is made" : "",
                  *makers ? "; these can: " : "", makers);
    return TYN_ERR_PARAMS;
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
        return refuse_outputs(ctx, outputs & ~ctx->method->info.outputs);
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
    tyn_frame_projection projection;
    tyn_result result = tyn_frame_projection_find(&projection, frame, log);
    if (result == TYN_OK && view->resume) {
        result = check_resume(ctx, view, outputs);
    }
    if (result == TYN_OK && (outputs & TYN_OUTPUT_COMPOSITE)) {
        result = check_color(frame->color, view, log);
        if (result == TYN_OK && frame->depth) {
            result = check_depth(frame, log);
        }
    }
    if (result == TYN_OK) {
        result = check_results(frame, outputs, log);
    }
    if (result == TYN_OK && (outputs & TYN_OUTPUT_LIGHT)) {
        result = check_light(&frame->light, log);
    }
    if (result == TYN_OK) {
        result = tyn_scene_check_values(frame->scene, log);
    }
    return result == TYN_OK ? check_densities(frame, log) : result;
}
