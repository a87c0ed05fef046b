// check_images.c -- are the images that the host lends fit?
#include "frame/context.h"
#include "base/fault.h"
#include "frame/output.h"
#include "gpu/device.h"
#include <stdio.h>

#define NEEDS(usage) VK_IMAGE_USAGE_##usage##_BIT, "VK_IMAGE_USAGE_" #usage "_BIT"

// An image that the host lends: `what` it is, and what it must be able to do.
static tyn_result check_image(const tyn_device *dev, const tyn_image *image, const char *what,
                              VkImageUsageFlags usage, const char *usage_name)
{
    const tyn_log *log = &dev->log;
    if (!image->image || !image->view) {
        FAULT("%s: image and view are required, %s is NULL", what, image->image ? "view" : "image");
    }
    if (!(image->usage & usage)) {
        FAULT("%s: its usage is 0x%x; it needs %s", what, image->usage, usage_name);
    }
    const VkImageAspectFlags has = graph_aspect(image->format);
    const bool depth_alone = image->aspect == VK_IMAGE_ASPECT_DEPTH_BIT && has & image->aspect;
    if (image->aspect && image->aspect != has && !(depth_alone && dev->separate_stencil)) {
        FAULT("%s: its aspect is 0x%x, its format %d has 0x%x; 0 is always right%s", what,
              image->aspect, (int)image->format, has,
              depth_alone ? " (depth without its stencil asks for separateDepthStencilLayouts)"
                          : "");
    }
    if (image->after.layout == VK_IMAGE_LAYOUT_UNDEFINED ||
        image->after.layout == VK_IMAGE_LAYOUT_PREINITIALIZED) {
        FAULT("%s: after.layout is %d; no image can be left in that layout", what,
              (int)image->after.layout);
    }
    return TYN_OK;
}

static tyn_result check_color(const tyn_device *dev, const tyn_image *color, const tyn_view *view)
{
    const tyn_log *log = &dev->log;
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
    return check_image(dev, color, "color", NEEDS(STORAGE));
}

static tyn_result check_depth(const tyn_device *dev, const tyn_frame *frame)
{
    const tyn_log *log = &dev->log;
    const tyn_image *depth = frame->depth;
    if (!(graph_aspect(depth->format) & VK_IMAGE_ASPECT_DEPTH_BIT)) {
        FAULT("depth: format %d is no depth format", (int)depth->format);
    }
    const VkExtent3D size = frame->color->extent;
    if (depth->extent.width != size.width || depth->extent.height != size.height) {
        FAULT("depth is %u x %u, color is %u x %u; make them equal", depth->extent.width,
              depth->extent.height, size.width, size.height);
    }
    return check_image(dev, depth, "depth", NEEDS(SAMPLED));
}

// Images that take results.
static tyn_result check_results(const tyn_device *dev, const tyn_frame *frame, uint32_t outputs)
{
    const tyn_log *log = &dev->log;
    for (uint32_t i = 0; i < TYN_NUM_LENT; i++) {
        const tyn_lent_image *lent = &tyn_lent_images[i];
        const tyn_image *image = tyn_lent(&frame->images, i);
        if (!image) {
            continue;
        }
        if (!(outputs & lent->output)) {
            FAULT("%s is given, but tyn_view.outputs has no TYN_OUTPUT_%s", lent->what,
                  lent->constant);
        }
        if (image->format != VK_FORMAT_R32G32B32A32_SFLOAT && image->format != lent->other) {
            FAULT("%s: its format is %d; it must be %s", lent->what, (int)image->format,
                  lent->formats);
        }
        if (image->extent.width != frame->view->width ||
            image->extent.height != frame->view->height) {
            FAULT("%s is %u x %u, the view is %u x %u; make them equal", lent->what,
                  image->extent.width, image->extent.height, frame->view->width,
                  frame->view->height);
        }
        TYN_TRY(check_image(dev, image, lent->what, NEEDS(STORAGE)));
    }
    return TYN_OK;
}

static tyn_result check_light(const tyn_device *dev, const tyn_frame_lights *light, bool asked)
{
    const tyn_log *log = &dev->log;
    const tyn_image *images[3] = {light->red, light->green, light->blue};
    static const char *const names[3] = {"light.red", "light.green", "light.blue"};
    for (int i = 0; i < 3; i++) {
        const tyn_image *image = images[i];
        if (!asked && image) {
            FAULT("%s is given, but tyn_view.outputs has no TYN_OUTPUT_LIGHT", names[i]);
        }
        if (!asked) {
            continue;
        }
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
        TYN_TRY(check_image(dev, image, names[i], NEEDS(STORAGE)));
    }
    return TYN_OK;
}

// The images of volumes without data; that there are some is known when the scene is fit.
static bool holds_density(VkFormat format)
{
    static const VkFormat formats[] = {VK_FORMAT_R8_UNORM,
                                       VK_FORMAT_R8G8_UNORM,
                                       VK_FORMAT_R8G8B8A8_UNORM,
                                       VK_FORMAT_R16_UNORM,
                                       VK_FORMAT_R16G16_UNORM,
                                       VK_FORMAT_R16G16B16A16_UNORM,
                                       VK_FORMAT_R16_SFLOAT,
                                       VK_FORMAT_R16G16_SFLOAT,
                                       VK_FORMAT_R16G16B16A16_SFLOAT,
                                       VK_FORMAT_R32_SFLOAT,
                                       VK_FORMAT_R32G32_SFLOAT,
                                       VK_FORMAT_R32G32B32A32_SFLOAT,
                                       VK_FORMAT_BC4_UNORM_BLOCK,
                                       VK_FORMAT_BC5_UNORM_BLOCK,
                                       VK_FORMAT_BC6H_UFLOAT_BLOCK,
                                       VK_FORMAT_B10G11R11_UFLOAT_PACK32};
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++) {
        if (format == formats[i]) {
            return true;
        }
    }
    return false;
}

static tyn_result check_densities(const tyn_device *dev, const tyn_frame *frame)
{
    const tyn_log *log = &dev->log;
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
        if (!holds_density(image->format)) {
            FAULT("densities[%u]: its format is %d; its red must be a number from 0 on: UNORM, "
                  "SFLOAT or UFLOAT",
                  n - 1, (int)image->format);
        }
        TYN_TRY(check_image(dev, image, "densities", NEEDS(SAMPLED)));
    }
    return TYN_OK;
}

static uint32_t count_densities(const tyn_scene *scene)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->num_volumes; i++) {
        count += !scene->volumes[i].data;
    }
    return count;
}

// Each is brought from its own `before` to its own `after`, so none may be lent twice.
static tyn_result check_distinct(const tyn_frame *frame, uint32_t outputs, const tyn_log *log)
{
    const bool composite = outputs & TYN_OUTPUT_COMPOSITE;
    const struct {
        const tyn_image *image;
        const char *what;
    } fixed[] = {
        {composite ? frame->color : NULL, "color"},
        {composite ? frame->depth : NULL, "depth"},
        {frame->images.radiance, "images.radiance"},
        {frame->images.transmittance, "images.transmittance"},
        {frame->images.depth, "images.depth"},
        {frame->light.red, "light.red"},
        {frame->light.green, "light.green"},
        {frame->light.blue, "light.blue"},
    };
    enum { FIXED = sizeof fixed / sizeof *fixed };
    const uint32_t num_densities = count_densities(frame->scene);
    char first[32], second[32];
    for (uint32_t i = 0; i < FIXED + num_densities; i++) {
        const tyn_image *a = i < FIXED ? fixed[i].image : &frame->densities[i - FIXED];
        for (uint32_t j = 0; a && j < i; j++) {
            const tyn_image *b = j < FIXED ? fixed[j].image : &frame->densities[j - FIXED];
            if (b && a->image == b->image) {
                snprintf(first, sizeof first, "densities[%u]", j - FIXED);
                snprintf(second, sizeof second, "densities[%u]", i - FIXED);
                FAULT("%s and %s are the same image; each needs its own",
                      j < FIXED ? fixed[j].what : first, i < FIXED ? fixed[i].what : second);
            }
        }
    }
    return TYN_OK;
}

tyn_result tyn_frame_check_images(const tyn_context *ctx, const tyn_frame *frame, uint32_t outputs)
{
    const tyn_device *dev = ctx->dev;
    if (outputs & TYN_OUTPUT_COMPOSITE) {
        TYN_TRY(check_color(dev, frame->color, frame->view));
    }
    if (outputs & TYN_OUTPUT_COMPOSITE && frame->depth) {
        TYN_TRY(check_depth(dev, frame));
    }
    TYN_TRY(check_results(dev, frame, outputs));
    TYN_TRY(check_light(dev, &frame->light, outputs & TYN_OUTPUT_LIGHT));
    TYN_TRY(check_densities(dev, frame));
    return check_distinct(frame, outputs, &dev->log);
}

tyn_result tyn_frame_check_content(const tyn_context *ctx, const tyn_frame *frame)
{
    const tyn_log *log = &ctx->dev->log;
    const uint32_t num_densities = count_densities(frame->scene);
    const bool composite = ctx->outputs & TYN_OUTPUT_COMPOSITE;
    const tyn_image *laid_over[] = {composite ? frame->color : NULL,
                                    composite ? frame->depth : NULL};
    static const char *const names[] = {"color", "depth", "densities"};
    for (uint32_t i = 0; i < 2 + num_densities; i++) {
        const tyn_image *image = i < 2 ? laid_over[i] : &frame->densities[i - 2];
        if (image && image->before.layout == VK_IMAGE_LAYOUT_UNDEFINED) {
            FAULT("%s: before.layout is UNDEFINED, in which an image has no content; it is read",
                  names[i < 2 ? i : 2]);
        }
    }
    return TYN_OK;
}
