// allocate.c -- Vulkan objects of resources: made and placed without memory first, bound once there is memory.
#include "graph/internal.h"
#include "base/fault.h"
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
    // View 0 sees all mips, the others one each.
    for (uint32_t v = 0; v < (r->mips > 1 ? r->mips + 1 : 1); v++) {
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
        TYN_TRY(tyn_vk_check(dev, made, r->name));
    }
    return TYN_OK;
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

VkMemoryRequirements graph_requirements(const tyn_graph *g, const phys *p)
{
    const tyn_device *dev = g->dev;
    VkMemoryRequirements need;
    if (p->image) {
        dev->vk.GetImageMemoryRequirements(dev->device, p->image, &need);
    } else {
        dev->vk.GetBufferMemoryRequirements(dev->device, p->buffer, &need);
    }
    return need;
}

// A buffer in memory that the host sees.
static tyn_result draft_host_buffer(tyn_graph *g, tyn_heap *heap, VkDeviceSize size,
                                    VkBufferUsageFlags usage, tyn_memory_kind kind,
                                    const char *name, host_buffer *out)
{
    TYN_TRY(make_buffer(g, size, usage, name, &out->buffer));
    VkMemoryRequirements need;
    g->dev->vk.GetBufferMemoryRequirements(g->dev->device, out->buffer, &need);
    return tyn_heap_place(g->dev, heap, &need, kind, size, &out->place);
}

static tyn_result bind_host_buffer(tyn_graph *g, const tyn_heap *heap, host_buffer *b)
{
    return b->buffer && !b->mapped
               ? tyn_heap_bind_buffer(g->dev, heap, b->buffer, b->place, &b->mapped)
               : TYN_OK;
}

static tyn_result create_texel_views(tyn_graph *g, phys *p, const char *name)
{
    const tyn_device *dev = g->dev;
    const uint32_t limit = dev->properties.limits.maxTexelBufferElements;
    for (int i = 0; i < NUM_TEXEL_FORMATS; i++) {
        if (!(p->texel_uses >> i & 1)) {
            continue;
        }
        const uint32_t size = graph_texel_size(graph_texel_formats[i]);
        if (p->bytes / size > limit) {
            return graph_fail(g, TYN_ERR_UNSUPPORTED,
                              "buffer '%s' of %llu bytes: the device reads at most %u texels of %u "
                              "bytes from one",
                              name, (unsigned long long)p->bytes, limit, size);
        }
        const VkResult made = TYN_VK_MADE(
            &p->texels[i],
            dev->vk.CreateBufferView(
                dev->device,
                &(VkBufferViewCreateInfo){.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO,
                                          .buffer = p->buffer,
                                          .format = graph_texel_formats[i],
                                          .range = p->bytes < size ? size : p->bytes / size * size},
                NULL, &p->texels[i]));
        TYN_TRY(tyn_vk_check(dev, made, name));
    }
    return TYN_OK;
}

// What nodes make, unless it is too small to be worth the barriers. Tests that fill it with NaN want it apart.
static bool may_share(const tyn_graph *g, const resource *r)
{
    return (r->kind == RESOURCE_OUT || r->kind == RESOURCE_SCRATCH) && !g->poison &&
           graph_resource_bytes(r) >= SHARED_LEAST;
}

static tyn_result make_object(tyn_graph *g, const resource *r, phys *p)
{
    const VkDeviceSize bytes = p->bytes < 16 ? 16 : p->bytes; // a texel at least
    return r->dim == TYN_BUFFER ? make_buffer(g, bytes, p->buffer_usage, r->name, &p->buffer)
                                : make_image(g, r, p);
}

// In a heap of its own, so that it outlives the others, in a shared block, or with the others of this compilation.
static tyn_heap *heap_of(tyn_graph *g, const resource *r, phys *p)
{
    return p->shared                     ? &graph_find_block(g, p->block)->heap
           : r->kind == RESOURCE_HISTORY ? &p->heap
                                         : &g->heap;
}

static tyn_result draft_resource(tyn_graph *g, const resource *r, phys *p, VkDeviceSize *expected)
{
    p->made = g->frame;
    p->identity = graph_identity(g, r);
    p->age = r->kind == RESOURCE_HISTORY ? 0 : g->age;
    TYN_TRY(make_object(g, r, p));
    if (p->shared) {
        return TYN_OK;
    }
    const VkMemoryRequirements need = graph_requirements(g, p);
    const VkDeviceSize likely = r->kind == RESOURCE_HISTORY ? 0 : *expected;
    *expected -= *expected > p->bytes ? p->bytes : *expected;
    return tyn_heap_place(g->dev, heap_of(g, r, p), &need, TYN_MEMORY_DEVICE, likely, &p->place);
}

tyn_result graph_draft_readbacks(tyn_graph *g)
{
    for (uint32_t i = 0; i < g->num_outputs; i++) {
        phys *p = &g->phys[g->outputs[i].ref.resource - 1];
        if (g->outputs[i].readback && !p->readback.buffer) {
            TYN_TRY(draft_host_buffer(g, &g->heap, p->bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                      TYN_MEMORY_READBACK, "readback", &p->readback));
        }
    }
    return TYN_OK;
}

// Which resources share memory; bytes that the others will ask for.
static VkDeviceSize expect_bytes(tyn_graph *g)
{
    VkDeviceSize expected = 0;
    for (uint32_t i = 0; i < g->num_resources; i++) {
        const resource *r = &g->resources[i];
        phys *p = &g->phys[i];
        p->bytes = graph_resource_bytes(r);
        p->borrowed = r->kind == RESOURCE_IMPORT;
        p->shared = p->kept ? p->shared : may_share(g, r);
        expected += p->borrowed || p->shared || p->kept ? 0 : p->bytes + (64u << 10);
    }
    return expected;
}

tyn_result graph_draft_resources(tyn_graph *g)
{
    VkDeviceSize expected = expect_bytes(g);
    g->persistent_bytes = g->transient_bytes = 0;
    for (uint32_t i = 0; i < g->num_resources; i++) {
        const resource *r = &g->resources[i];
        phys *p = &g->phys[i];
        if (p->borrowed) {
            p->image = r->image.image;
            continue;
        }
        if (r->kind != RESOURCE_SCRATCH) {
            g->persistent_bytes += p->bytes;
        } else if (!p->shared) {
            g->transient_bytes += p->bytes;
        }
        TYN_TRY(p->kept ? TYN_OK : draft_resource(g, r, p, &expected));
    }
    return TYN_OK;
}

// Of an object without memory.
static tyn_result bind_object(tyn_graph *g, const tyn_heap *heap, const resource *r, phys *p)
{
    TYN_TRY(p->image ? tyn_heap_bind_image(g->dev, heap, p->image, p->place)
                     : tyn_heap_bind_buffer(g->dev, heap, p->buffer, p->place, NULL));
    return p->image ? make_views(g, r, p) : create_texel_views(g, p, r->name);
}

tyn_result graph_bind_objects(tyn_graph *g)
{
    for (uint32_t i = 0; i < g->num_resources; i++) {
        const resource *r = &g->resources[i];
        phys *p = &g->phys[i];
        TYN_TRY(p->kept || p->borrowed ? TYN_OK : bind_object(g, heap_of(g, r, p), r, p));
        TYN_TRY(bind_host_buffer(g, &g->heap, &p->readback));
        TYN_TRY(bind_host_buffer(g, &g->staging_heap, &p->staging));
    }
    return TYN_OK;
}

static bool wants_staging(const resource *r, const phys *p)
{
    const bool big = r->kind == RESOURCE_UPLOAD && (r->fill || r->extent.x > INLINE_UPLOAD);
    return big && p->content != r->content;
}

bool graph_uploads_staged(const tyn_graph *g)
{
    for (uint32_t i = 0; i < g->num_resources; i++) {
        if (wants_staging(&g->resources[i], &g->phys[i]) &&
            g->phys[i].staged != g->resources[i].content) {
            return false;
        }
    }
    return true;
}

tyn_result graph_draft_staging(tyn_graph *g)
{
    for (uint32_t i = 0; i < g->num_resources; i++) {
        phys *p = &g->phys[i];
        if (wants_staging(&g->resources[i], p)) {
            TYN_TRY(draft_host_buffer(g, &g->staging_heap, p->bytes,
                                      VK_BUFFER_USAGE_TRANSFER_SRC_BIT, TYN_MEMORY_UPLOAD,
                                      "staging", &p->staging));
        }
    }
    return TYN_OK;
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
            r->fill(r->user, p->staging.mapped);
        } else {
            memcpy(p->staging.mapped, r->data, r->key);
        }
        p->staged = r->content;
    }
}

void graph_free_staging(tyn_graph *g)
{
    for (uint32_t i = 0; i < g->num_phys; i++) {
        graph_retire(g, VK_OBJECT_TYPE_BUFFER, (uint64_t)g->phys[i].staging.buffer,
                     g->staging_made);
        g->phys[i].staging = (host_buffer){0};
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
    graph_retire(g, VK_OBJECT_TYPE_BUFFER, (uint64_t)p->readback.buffer, p->made);
    graph_retire_heap(g, &p->heap, p->made);
    *p = (phys){0};
}
