// allocate.c -- Vulkan objects of resources, and memory for them.
#include "graph/internal.h"
#include <string.h>

enum { SHARED_LEAST = 64 << 10 }; // bytes

static tyn_result make_image(tyn_graph *g, const resource *r, phys *p)
{
    tyn_device *dev = g->dev;
    const VkPhysicalDeviceLimits *limits = &dev->properties.limits;
    uint32_t limit =
        r->dim == TYN_IMAGE_3D ? limits->maxImageDimension3D : limits->maxImageDimension2D;
    if (r->extent.x > limit || r->extent.y > limit || r->extent.z > limit) {
        return graph_fail(g, TYN_ERR_UNSUPPORTED,
                          "image '%s' of %u x %u x %u: the device's limit is %u per axis", r->name,
                          r->extent.x, r->extent.y, r->extent.z, limit);
    }
    const uint32_t width = limits->maxFramebufferWidth < limits->maxViewportDimensions[0]
                               ? limits->maxFramebufferWidth
                               : limits->maxViewportDimensions[0];
    const uint32_t height = limits->maxFramebufferHeight < limits->maxViewportDimensions[1]
                                ? limits->maxFramebufferHeight
                                : limits->maxViewportDimensions[1];
    const bool drawn = p->image_usage & (VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                         VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
    if (drawn && (r->extent.x > width || r->extent.y > height)) {
        return graph_fail(g, TYN_ERR_UNSUPPORTED,
                          "image '%s' of %u x %u: the device draws at most %u x %u", r->name,
                          r->extent.x, r->extent.y, width, height);
    }
    VkImageType type = r->dim == TYN_IMAGE_3D ? VK_IMAGE_TYPE_3D : VK_IMAGE_TYPE_2D;
    // An image that no needed node reads still gets a view, which wants one of these.
    const VkImageUsageFlags shader_uses = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT;
    VkResult made = TYN_VK_MADE(
        &p->image,
        dev->vk.CreateImage(
            dev->device,
            &(VkImageCreateInfo){.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                 .imageType = type,
                                 .format = r->format,
                                 .extent = {r->extent.x, r->extent.y, r->extent.z},
                                 .mipLevels = r->mips,
                                 .arrayLayers = 1,
                                 .samples = VK_SAMPLE_COUNT_1_BIT,
                                 .tiling = VK_IMAGE_TILING_OPTIMAL,
                                 .usage = p->image_usage & shader_uses
                                              ? p->image_usage
                                              : p->image_usage | VK_IMAGE_USAGE_SAMPLED_BIT,
                                 .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED},
            NULL, &p->image));
    tyn_device_name_object(dev, VK_OBJECT_TYPE_IMAGE, (uint64_t)p->image, r->name);
    return tyn_vk_check(dev, made, r->name);
}

// Of an image that has memory.
static tyn_result make_views(tyn_graph *g, const resource *r, phys *p)
{
    tyn_device *dev = g->dev;
    tyn_result result = TYN_OK;
    // View 0 sees all mips, the others one each.
    for (uint32_t v = 0; result == TYN_OK && v < (r->mips > 1 ? r->mips + 1 : 1); v++) {
        VkImageSubresourceRange range = {graph_aspect(r->format), 0, r->mips, 0, 1};
        if (v) {
            range.baseMipLevel = v - 1;
            range.levelCount = 1;
        }
        VkImageView *view = v ? &p->mip_views[v - 1] : &p->view;
        const VkResult made = TYN_VK_MADE(
            view,
            dev->vk.CreateImageView(
                dev->device,
                &(VkImageViewCreateInfo){.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                         .image = p->image,
                                         .viewType = r->dim == TYN_IMAGE_3D ? VK_IMAGE_VIEW_TYPE_3D
                                                                            : VK_IMAGE_VIEW_TYPE_2D,
                                         .format = r->format,
                                         .subresourceRange = range},
                NULL, view));
        result = tyn_vk_check(dev, made, r->name);
    }
    return result;
}

static tyn_result create_image(tyn_graph *g, tyn_heap *heap, const resource *r, phys *p,
                               VkDeviceSize expected)
{
    tyn_result result = make_image(g, r, p);
    if (result == TYN_OK) {
        result = tyn_heap_bind_image(g->dev, heap, p->image, expected);
    }
    return result == TYN_OK ? make_views(g, r, p) : result;
}

static tyn_result make_buffer(tyn_graph *g, VkDeviceSize size, VkBufferUsageFlags usage,
                              const char *name, VkBuffer *out)
{
    VkResult made = TYN_VK_MADE(
        out, g->dev->vk.CreateBuffer(
                 g->dev->device,
                 &(VkBufferCreateInfo){.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                       .size = size,
                                       .usage = usage ? usage : VK_BUFFER_USAGE_STORAGE_BUFFER_BIT},
                 NULL, out));
    tyn_device_name_object(g->dev, VK_OBJECT_TYPE_BUFFER, (uint64_t)*out, name);
    return tyn_vk_check(g->dev, made, name);
}

static tyn_result create_buffer(tyn_graph *g, tyn_heap *heap, VkDeviceSize size,
                                VkBufferUsageFlags usage, tyn_memory_kind kind,
                                VkDeviceSize expected, const char *name, VkBuffer *out,
                                void **mapped)
{
    tyn_result result = make_buffer(g, size, usage, name, out);
    if (result == TYN_OK) {
        result = tyn_heap_bind_buffer(g->dev, heap, *out, kind, expected, mapped);
    }
    return result;
}

static tyn_result create_texel_views(tyn_graph *g, phys *p, const char *name)
{
    const tyn_device *dev = g->dev;
    const uint32_t limit = dev->properties.limits.maxTexelBufferElements;
    tyn_result result = TYN_OK;
    for (int i = 0; result == TYN_OK && i < NUM_TEXEL_FORMATS; i++) {
        if (!(p->texel_uses >> i & 1) || p->texels[i]) { // histories have them already
            continue;
        }
        const uint32_t size = graph_texel_size(graph_texel_formats[i]);
        if (p->bytes / size > limit) {
            return graph_fail(g, TYN_ERR_UNSUPPORTED,
                              "buffer '%s' of %llu bytes: the device reads at most %u texels of %u "
                              "bytes from one",
                              name, (unsigned long long)p->bytes, limit, size);
        }
        result = tyn_vk_check(
            dev,
            TYN_VK_MADE(&p->texels[i],
                        dev->vk.CreateBufferView(
                            dev->device,
                            &(VkBufferViewCreateInfo){
                                .sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO,
                                .buffer = p->buffer,
                                .format = graph_texel_formats[i],
                                .range = p->bytes < size ? size : p->bytes / size * size},
                            NULL, &p->texels[i])),
            name);
    }
    return result;
}

// What nodes make, unless it is too small to be worth the barriers. Tests that fill it with NaN want it apart.
static bool may_share(const tyn_graph *g, const resource *r)
{
    return (r->kind == RESOURCE_OUT || r->kind == RESOURCE_SCRATCH) && !g->poison &&
           graph_resource_bytes(r) >= SHARED_LEAST;
}

static tyn_result create_resource(tyn_graph *g, const resource *r, phys *p, VkDeviceSize expected)
{
    const VkDeviceSize bytes = p->bytes < 16 ? 16 : p->bytes; // a texel at least
    if (p->shared) {
        return r->dim == TYN_BUFFER ? make_buffer(g, bytes, p->buffer_usage, r->name, &p->buffer)
                                    : make_image(g, r, p);
    }
    const bool history = r->kind == RESOURCE_HISTORY;
    tyn_heap *heap = history ? &p->heap : &g->heap;
    expected = history ? 0 : expected;
    return r->dim == TYN_BUFFER ? create_buffer(g, heap, bytes, p->buffer_usage, TYN_MEMORY_DEVICE,
                                                expected, r->name, &p->buffer, NULL)
                                : create_image(g, heap, r, p, expected);
}

// Memory, and views, of what shares it.
static tyn_result complete_shared(tyn_graph *g)
{
    VkDeviceSize passing = 0;
    tyn_result result = graph_bind_shared(g, &passing);
    g->transient_bytes += passing;
    for (uint32_t i = 0; result == TYN_OK && i < g->num_resources; i++) {
        if (g->phys[i].shared && g->resources[i].dim != TYN_BUFFER && !g->phys[i].view) {
            result = make_views(g, &g->resources[i], &g->phys[i]);
        }
    }
    return result;
}

static tyn_result create_readbacks(tyn_graph *g)
{
    tyn_result result = TYN_OK;
    for (uint32_t i = 0; result == TYN_OK && i < g->num_outputs; i++) {
        phys *p = &g->phys[g->outputs[i].ref.resource - 1];
        if (g->outputs[i].readback && !p->readback) {
            result = create_buffer(g, &g->heap, p->bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                   TYN_MEMORY_READBACK, p->bytes, "readback", &p->readback,
                                   &p->readback_ptr);
        }
    }
    return result;
}

tyn_result graph_create_resources(tyn_graph *g, heritage *old)
{
    VkDeviceSize expected = 0;
    for (uint32_t i = 0; i < g->num_resources; i++) {
        const resource *r = &g->resources[i];
        phys *p = &g->phys[i];
        if (r->kind == RESOURCE_UPLOAD || r->kind == RESOURCE_HISTORY || g->poison) {
            p->buffer_usage |= VK_BUFFER_USAGE_TRANSFER_DST_BIT;
            p->image_usage |= VK_IMAGE_USAGE_TRANSFER_DST_BIT;
        }
    }
    graph_inherit(g, old);
    if (graph_keep_places(g) != TYN_OK) {
        return graph_fail(g, TYN_ERR_MEMORY, "out of memory");
    }
    for (uint32_t i = 0; i < g->num_resources; i++) {
        const resource *r = &g->resources[i];
        const bool kept = g->phys[i].identity;
        g->phys[i].shared = kept ? g->phys[i].shared : may_share(g, r);
        expected += r->kind == RESOURCE_IMPORT || g->phys[i].shared || kept
                        ? 0
                        : graph_resource_bytes(r) + (64u << 10);
    }
    g->persistent_bytes = g->transient_bytes = 0;
    tyn_result result = TYN_OK;
    for (uint32_t i = 0; result == TYN_OK && i < g->num_resources; i++) {
        const resource *r = &g->resources[i];
        phys *p = &g->phys[i];
        p->bytes = graph_resource_bytes(r);
        if (r->kind == RESOURCE_IMPORT) {
            p->image = r->image.image;
            p->borrowed = true;
            continue;
        }
        if (r->kind != RESOURCE_SCRATCH) {
            g->persistent_bytes += p->bytes;
        } else if (!p->shared) {
            g->transient_bytes += p->bytes;
        }
        if (p->identity) {
            continue; // inherited
        }
        p->made = g->frame;
        p->identity = graph_identity(g, r);
        p->age = r->kind == RESOURCE_HISTORY ? 0 : g->age;
        result = create_resource(g, r, p, expected);
        if (!p->shared) {
            expected -= expected > p->bytes ? p->bytes : expected;
        }
    }
    result = result == TYN_OK ? complete_shared(g) : result;
    for (uint32_t i = 0; result == TYN_OK && i < g->num_resources; i++) {
        result = create_texel_views(g, &g->phys[i], g->resources[i].name);
    }
    return result == TYN_OK ? create_readbacks(g) : result;
}

// Zero-filled stand-ins for optional inputs that nothing is connected to: made once.
tyn_result graph_create_dummies(tyn_graph *g)
{
    if (g->dummy_heap.num_blocks) {
        return TYN_OK;
    }
    for (int d = 0; d < NUM_DUMMIES; d++) {
        g->dummy[d].made = g->frame;
    }
    tyn_result result = create_buffer(
        g, &g->dummy_heap, 256,
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
            VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
        TYN_MEMORY_DEVICE, 0, "none", &g->dummy[TYN_BUFFER].buffer, NULL);
    g->dummy[TYN_BUFFER].bytes = 256;
    g->dummy[TYN_BUFFER].texel_uses = (1u << NUM_TEXEL_FORMATS) - 1;
    result = result == TYN_OK ? create_texel_views(g, &g->dummy[TYN_BUFFER], "none") : result;
    for (int d = TYN_IMAGE_2D; result == TYN_OK && d < NUM_DUMMIES; d++) {
        const bool words = d == DUMMY_WORDS;
        g->dummy[d].image_usage =
            (words ? VK_IMAGE_USAGE_STORAGE_BIT : VK_IMAGE_USAGE_SAMPLED_BIT) |
            VK_IMAGE_USAGE_TRANSFER_DST_BIT;
        result = create_image(
            g, &g->dummy_heap,
            &(resource){.name = "none",
                        .dim = words ? TYN_IMAGE_2D : (tyn_dim)d,
                        .format = words ? VK_FORMAT_R32G32_UINT : VK_FORMAT_R32G32B32A32_SFLOAT,
                        .extent = {1, 1, 1},
                        .mips = 1},
            &g->dummy[d], 0);
    }
    g->dummy_ready = false;
    return result;
}

bool graph_uploads_staged(const tyn_graph *g)
{
    for (uint32_t i = 0; i < g->num_resources; i++) {
        const resource *r = &g->resources[i];
        bool big = r->kind == RESOURCE_UPLOAD && (r->fill || r->extent.x > INLINE_UPLOAD);
        if (big && g->phys[i].content != r->content && g->phys[i].staged != r->content) {
            return false;
        }
    }
    return true;
}

static bool wants_staging(const resource *r, const phys *p)
{
    const bool big = r->kind == RESOURCE_UPLOAD && (r->fill || r->extent.x > INLINE_UPLOAD);
    return big && p->content != r->content;
}

tyn_result graph_create_staging(tyn_graph *g)
{
    tyn_result result = TYN_OK;
    g->staging_made = g->frame;
    for (uint32_t i = 0; result == TYN_OK && i < g->num_resources; i++) {
        phys *p = &g->phys[i];
        if (wants_staging(&g->resources[i], p)) {
            result =
                create_buffer(g, &g->staging_heap, p->bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                              TYN_MEMORY_UPLOAD, p->bytes, "staging", &p->staging, &p->staging_ptr);
        }
    }
    return result;
}

void graph_fill_staging(tyn_graph *g)
{
    for (uint32_t i = 0; i < g->num_resources; i++) {
        const resource *r = &g->resources[i];
        phys *p = &g->phys[i];
        if (!wants_staging(r, p)) {
            continue;
        }
        if (r->fill) {
            r->fill(r->user, p->staging_ptr);
        } else {
            memcpy(p->staging_ptr, r->data, r->key);
        }
        p->staged = r->content;
    }
}

void graph_free_staging(tyn_graph *g)
{
    for (uint32_t i = 0; i < g->num_phys; i++) {
        graph_retire(g, VK_OBJECT_TYPE_BUFFER, (uint64_t)g->phys[i].staging, g->staging_made);
        g->phys[i].staging = VK_NULL_HANDLE;
        g->phys[i].staged = 0;
    }
    graph_retire_heap(g, &g->staging_heap, g->staging_made);
}

void graph_destroy_phys(tyn_graph *g, phys *p)
{
    for (uint32_t m = 0; m < MAX_MIPS; m++) {
        graph_retire(g, VK_OBJECT_TYPE_IMAGE_VIEW, (uint64_t)p->mip_views[m], p->made);
    }
    graph_retire(g, VK_OBJECT_TYPE_IMAGE_VIEW, (uint64_t)p->view, p->made);
    if (!p->borrowed) {
        graph_retire(g, VK_OBJECT_TYPE_IMAGE, (uint64_t)p->image, p->made);
    }
    for (int i = 0; i < NUM_TEXEL_FORMATS; i++) {
        graph_retire(g, VK_OBJECT_TYPE_BUFFER_VIEW, (uint64_t)p->texels[i], p->made);
    }
    graph_retire(g, VK_OBJECT_TYPE_BUFFER, (uint64_t)p->buffer, p->made);
    graph_retire(g, VK_OBJECT_TYPE_BUFFER, (uint64_t)p->readback, p->made);
    graph_retire_heap(g, &p->heap, p->made);
    *p = (phys){0};
}
