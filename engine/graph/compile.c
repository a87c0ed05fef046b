// compile.c -- cull, survey, allocate.
#include "graph/internal.h"
#include "base/hash.h"
#include <stdlib.h>
#include <string.h>

enum { SHARED_LEAST = 64 << 10, HEAP_SLACK = 32 << 20 }; // bytes

uint32_t graph_texel_size(VkFormat format)
{
    switch (format) {
    case VK_FORMAT_R8_UNORM:
        return 1;
    case VK_FORMAT_R16_SFLOAT:
        return 2;
    case VK_FORMAT_R32_SFLOAT:
    case VK_FORMAT_R32_UINT:
    case VK_FORMAT_R16G16_SFLOAT:
    case VK_FORMAT_R8G8B8A8_UNORM:
    case VK_FORMAT_D32_SFLOAT:
        return 4;
    case VK_FORMAT_R32G32_SFLOAT:
    case VK_FORMAT_R32G32_UINT:
    case VK_FORMAT_R16G16B16A16_SFLOAT:
        return 8;
    case VK_FORMAT_R32G32B32A32_SFLOAT:
    case VK_FORMAT_R32G32B32A32_UINT:
        return 16;
    default:
        return 16;
    }
}

VkImageAspectFlags graph_aspect(VkFormat format)
{
    switch (format) {
    case VK_FORMAT_D16_UNORM:
    case VK_FORMAT_D32_SFLOAT:
        return VK_IMAGE_ASPECT_DEPTH_BIT;
    default:
        return VK_IMAGE_ASPECT_COLOR_BIT;
    }
}

const VkFormat graph_texel_formats[NUM_TEXEL_FORMATS] = {
    VK_FORMAT_R32_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R32_UINT,
    VK_FORMAT_R32G32B32A32_UINT};

int graph_texel_index(tyn_use use)
{
    switch (use) {
    case TYN_USE_TEXELS_FLOAT:
        return 0;
    case TYN_USE_TEXELS_VEC4:
        return 1;
    case TYN_USE_TEXELS_UINT:
        return 2;
    case TYN_USE_TEXELS_UVEC4:
        return 3;
    default:
        return -1;
    }
}

static uint64_t resource_bytes(const resource *r)
{
    if (r->dim == TYN_BUFFER) {
        return r->extent.x;
    }
    uint64_t bytes = 0;
    for (uint32_t m = 0; m < r->mips; m++) {
        uint64_t x = r->extent.x >> m, y = r->extent.y >> m, z = r->extent.z >> m;
        bytes += (x ? x : 1) * (y ? y : 1) * (z ? z : 1) * graph_texel_size(r->format);
    }
    return bytes;
}

// ---- cull -------------------------------------------------------------------------------------

// A node is needed if an output or a needed node reads a version that it wrote, or a later version of
// a resource that it changed.
static void need_writers(tyn_graph *g, uint32_t resource_id, uint32_t version)
{
    if (!resource_id) {
        return;
    }
    const resource *r = &g->resources[resource_id - 1];
    for (uint32_t v = 0; v <= version; v++) {
        if (r->writers[v]) {
            g->nodes[r->writers[v] - 1].needed = true;
        }
    }
}

void graph_cull(tyn_graph *g)
{
    for (uint32_t i = 0; i < g->num_nodes; i++) {
        g->nodes[i].needed = false;
    }
    for (uint32_t i = 0; i < g->num_outputs; i++) {
        need_writers(g, g->outputs[i].ref.resource, g->outputs[i].ref.version);
    }
    for (uint32_t i = g->num_nodes; i-- > 0;) {
        const node *n = &g->nodes[i];
        for (uint32_t p = 0; n->needed && p < n->pass->num_ports; p++) {
            tyn_port_dir dir = n->pass->ports[p].dir;
            if (dir == TYN_IN || dir == TYN_INOUT) {
                need_writers(g, n->res[p], n->versions[p]);
            }
        }
    }
}

// ---- survey -----------------------------------------------------------------------------------

tyn_result graph_survey(tyn_graph *g, survey *s, phys *usage)
{
    *s = (survey){.hash = TYN_HASH_SEED};
    for (uint32_t i = 0; i < g->num_nodes; i++) {
        if (!g->nodes[i].needed) {
            continue;
        }
        tyn_recorder r = {.g = g, .node = i, .mode = RECORD_SURVEY, .survey = s, .usage = usage};
        g->nodes[i].pass->record(&r, g->nodes[i].params);
        if (r.result != TYN_OK) {
            return r.result;
        }
    }
    return TYN_OK;
}

uint64_t graph_structure(const tyn_graph *g, const survey *s)
{
    uint64_t h = s->hash;
    for (uint32_t i = 0; i < g->num_resources; i++) {
        const resource *r = &g->resources[i];
        h = tyn_hash_u64(h, (uint64_t)r->kind << 32 | (uint64_t)r->dim << 16 | r->mips);
        h = tyn_hash_u64(h, r->format);
        h = tyn_hash_bytes(h, &r->extent, sizeof r->extent);
    }
    for (uint32_t i = 0; i < g->num_nodes; i++) {
        const node *n = &g->nodes[i];
        h = tyn_hash_u64(h, (uint64_t)(uintptr_t)n->pass + n->needed);
        h = tyn_hash_bytes(h, n->res, n->pass->num_ports * sizeof n->res[0]);
    }
    for (uint32_t i = 0; i < g->num_outputs; i++) {
        h = tyn_hash_u64(h, (uint64_t)g->outputs[i].ref.resource << 1 | g->outputs[i].readback);
    }
    return h ? h : 1;
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

static bool same_structure(tyn_graph *g)
{
    survey s;
    graph_cull(g);
    return g->structure && graph_survey(g, &s, NULL) == TYN_OK &&
           graph_structure(g, &s) == g->structure;
}

bool tyn_graph_matches(const tyn_graph *graph)
{
    tyn_graph *g = (tyn_graph *)graph; // culling writes flags of the declaration only
    g->current = g->status == TYN_OK && same_structure(g) && graph_uploads_staged(g);
    return g->current;
}

// ---- allocate ---------------------------------------------------------------------------------

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

// What the last compilation leaves to this one: histories, uploads, what nodes made and where they worked.
typedef struct heritage {
    phys *items;
    uint32_t count;
} heritage;

static uint64_t identity_of(const tyn_graph *g, const resource *r)
{
    const bool kept = r->kind == RESOURCE_HISTORY || (!g->poison && r->kind != RESOURCE_IMPORT);
    if (!kept) {
        return 0;
    }
    uint64_t h = tyn_hash_string(TYN_HASH_SEED, r->name);
    h = tyn_hash_string(h, r->owner);
    h = tyn_hash_u64(h, (uint64_t)r->kind << 32 | (uint64_t)r->dim << 16 | r->mips);
    h = tyn_hash_u64(h, r->format);
    h = tyn_hash_bytes(h, &r->extent, sizeof r->extent);
    return h ? h : 1;
}

// True if `p`, of which only the uses are known, has become what had the same name, shape and use before. `content`: only
// if that is in it; 0 = whatever is in it.
static bool inherit(heritage *from, uint64_t identity, uint64_t content, phys *p)
{
    for (uint32_t i = 0; identity && i < from->count; i++) {
        phys *old = &from->items[i];
        if (old->identity == identity && (!content || old->content == content) &&
            (p->image_usage & ~old->image_usage) == 0 &&
            (p->buffer_usage & ~old->buffer_usage) == 0 &&
            (p->texel_uses & ~old->texel_uses) == 0) {
            *p = *old;
            *old = (phys){0};
            return true;
        }
    }
    return false;
}

// First those whose content is wanted again, so that no other takes their place.
static void inherit_all(tyn_graph *g, heritage *old)
{
    for (int any = 0; any < 2; any++) {
        for (uint32_t i = 0; i < g->num_resources; i++) {
            const resource *r = &g->resources[i];
            phys *p = &g->phys[i];
            const uint64_t identity = identity_of(g, r);
            if (!p->identity && (any || r->kind != RESOURCE_HISTORY)) {
                inherit(old, identity, any ? 0 : r->content, p);
            }
        }
    }
}

// What nodes make, unless it is too small to be worth the barriers. Tests that fill it with NaN want it apart.
static bool may_share(const tyn_graph *g, const resource *r)
{
    return (r->kind == RESOURCE_OUT || r->kind == RESOURCE_SCRATCH) && !g->poison &&
           resource_bytes(r) >= SHARED_LEAST;
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

static tyn_result create_resources(tyn_graph *g, heritage *old)
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
    inherit_all(g, old);
    if (graph_keep_places(g) != TYN_OK) {
        return graph_fail(g, TYN_ERR_MEMORY, "out of memory");
    }
    for (uint32_t i = 0; i < g->num_resources; i++) {
        const resource *r = &g->resources[i];
        const bool kept = g->phys[i].identity;
        g->phys[i].shared = kept ? g->phys[i].shared : may_share(g, r);
        expected += r->kind == RESOURCE_IMPORT || g->phys[i].shared || kept
                        ? 0
                        : resource_bytes(r) + (64u << 10);
    }
    g->persistent_bytes = g->transient_bytes = 0;
    tyn_result result = TYN_OK;
    for (uint32_t i = 0; result == TYN_OK && i < g->num_resources; i++) {
        const resource *r = &g->resources[i];
        phys *p = &g->phys[i];
        p->bytes = resource_bytes(r);
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
        p->identity = identity_of(g, r);
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
static tyn_result create_dummies(tyn_graph *g)
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

static tyn_result stage_uploads(tyn_graph *g)
{
    tyn_result result = TYN_OK;
    g->staging_made = g->frame;
    for (uint32_t i = 0; result == TYN_OK && i < g->num_resources; i++) {
        const resource *r = &g->resources[i];
        phys *p = &g->phys[i];
        bool big = r->kind == RESOURCE_UPLOAD && (r->fill || r->extent.x > INLINE_UPLOAD);
        if (!big || p->content == r->content) {
            continue;
        }
        result =
            create_buffer(g, &g->staging_heap, p->bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                          TYN_MEMORY_UPLOAD, p->bytes, "staging", &p->staging, &p->staging_ptr);
        if (result == TYN_OK) {
            if (r->fill) {
                r->fill(r->user, p->staging_ptr);
            } else {
                memcpy(p->staging_ptr, r->data, r->key);
            }
            p->staged = r->content;
        }
    }
    return result;
}

static void destroy_slot(tyn_graph *g, frame_slot *slot)
{
    graph_retire(g, VK_OBJECT_TYPE_DESCRIPTOR_POOL, (uint64_t)slot->pool, slot->made);
    graph_retire(g, VK_OBJECT_TYPE_QUERY_POOL, (uint64_t)slot->queries, slot->made);
    free(slot->timed);
    *slot = (frame_slot){0};
}

static tyn_result create_pools(tyn_graph *g, frame_slot *slot)
{
    const survey *room = &g->room;
    const VkDescriptorPoolSize sizes[] = {
        {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, room->uniform_buffers},
        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, room->storage_buffers},
        {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, room->texel_buffers},
        {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, room->storage_images},
        {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, room->sampled_images},
    };
    tyn_device *dev = g->dev;
    slot->made = g->frame;
    tyn_result result = tyn_vk_check(
        dev,
        TYN_VK_MADE(&slot->pool, dev->vk.CreateDescriptorPool(
                                     dev->device,
                                     &(VkDescriptorPoolCreateInfo){
                                         .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                         .maxSets = room->sets,
                                         .poolSizeCount = sizeof sizes / sizeof sizes[0],
                                         .pPoolSizes = sizes},
                                     NULL, &slot->pool)),
        "vkCreateDescriptorPool");
    if (result == TYN_OK && dev->timestamp_bits) {
        result = tyn_vk_check(
            dev,
            TYN_VK_MADE(&slot->queries, dev->vk.CreateQueryPool(
                                            dev->device,
                                            &(VkQueryPoolCreateInfo){
                                                .sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                                .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                                .queryCount = g->num_timed * 2},
                                            NULL, &slot->queries)),
            "vkCreateQueryPool");
    }
    return result;
}

static bool have_room(const tyn_graph *g, const survey *s)
{
    const survey *room = &g->room;
    // A former compilation may have failed between slots.
    for (uint32_t i = 0; i < g->num_slots; i++) {
        if (!g->slots[i].pool || (g->dev->timestamp_bits && !g->slots[i].queries)) {
            return false;
        }
    }
    return s->sets <= room->sets && s->uniform_buffers <= room->uniform_buffers &&
           s->storage_buffers <= room->storage_buffers && s->texel_buffers <= room->texel_buffers &&
           s->storage_images <= room->storage_images && s->sampled_images <= room->sampled_images &&
           g->num_nodes <= g->num_timed;
}

// A fourth more than is wanted, so that a compilation that wants a little more finds it.
static uint32_t roomy(uint32_t count)
{
    return count + count / 4 + 1;
}

// Pools of a compilation before serve again where they have room.
static tyn_result create_slots(tyn_graph *g, const survey *s)
{
    const bool keep = have_room(g, s);
    if (!keep) {
        g->room = (survey){.sets = roomy(s->sets),
                           .uniform_buffers = roomy(s->uniform_buffers),
                           .storage_buffers = roomy(s->storage_buffers),
                           .texel_buffers = roomy(s->texel_buffers),
                           .storage_images = roomy(s->storage_images),
                           .sampled_images = roomy(s->sampled_images)};
        g->num_timed = roomy(g->num_nodes);
    }
    tyn_result result = TYN_OK;
    for (uint32_t i = 0; result == TYN_OK && i < g->num_slots; i++) {
        frame_slot *slot = &g->slots[i];
        if (!keep) {
            destroy_slot(g, slot);
            result = create_pools(g, slot);
        }
        free(slot->timed);
        slot->timed = calloc(g->num_timed, 1);
        slot->pending = false;
        result = result == TYN_OK && !slot->timed ? TYN_ERR_MEMORY : result;
    }
    return result;
}

static tyn_result reserve_sets(tyn_graph *g, uint32_t count)
{
    if (count > g->sets.cap) {
        void *grown = realloc(g->sets.items, count * sizeof *g->sets.items);
        if (!grown) {
            return graph_fail(g, TYN_ERR_MEMORY, "out of memory");
        }
        g->sets.items = grown;
        g->sets.cap = count;
    }
    return TYN_OK;
}

// ---- release ----------------------------------------------------------------------------------

// At most so many things of a resource are retired.
enum { PHYS_PARTS = MAX_MIPS + NUM_TEXEL_FORMATS + 6 };

static bool reserve_all(tyn_graph *g)
{
    return graph_retire_reserve(g, (g->num_phys + g->num_resources + NUM_DUMMIES) * PHYS_PARTS +
                                       2 * MAX_SLOTS + g->num_aged + g->num_blocks + 4);
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

// Takes out what this compilation may use again, without what belongs to the last one alone; the heaps stay. Without
// memory for the list there is nothing: all starts anew.
static heritage take_heritage(tyn_graph *g, bool only_histories)
{
    heritage h = {.items = calloc(g->num_phys ? g->num_phys : 1, sizeof *h.items)};
    aged_heap *grown = only_histories ? NULL : realloc(g->aged, (g->num_aged + 1) * sizeof *grown);
    if (grown) {
        g->aged = grown;
    }
    for (uint32_t i = 0; h.items && i < g->num_phys; i++) {
        phys *p = &g->phys[i];
        if (p->identity && (!p->age || grown)) {
            graph_retire(g, VK_OBJECT_TYPE_BUFFER, (uint64_t)p->readback, p->made);
            p->readback = VK_NULL_HANDLE;
            p->readback_ptr = NULL;
            p->read = 0;
            h.items[h.count++] = *p;
            *p = (phys){0};
        }
    }
    if (grown && h.count) {
        g->aged[g->num_aged++] = (aged_heap){g->heap, g->age, g->heap_made};
        g->heap = (tyn_heap){0};
    }
    return h;
}

static void drop_heritage(tyn_graph *g, heritage *h)
{
    for (uint32_t i = 0; i < h->count; i++) {
        graph_destroy_phys(g, &h->items[i]);
    }
    free(h->items);
}

// Frees the heaps of earlier compilations that hold nothing any more; how many bytes of heaps are left.
static VkDeviceSize free_aged(tyn_graph *g)
{
    VkDeviceSize total = g->heap.total;
    for (uint32_t b = 0; b < g->num_blocks; b++) {
        total += g->blocks[b].size;
    }
    uint32_t left = 0;
    for (uint32_t a = 0; a < g->num_aged; a++) {
        bool used = false;
        for (uint32_t i = 0; i < g->num_phys; i++) {
            used |= !g->phys[i].shared && g->phys[i].age == g->aged[a].age;
        }
        if (used) {
            total += g->aged[a].heap.total;
            g->aged[left++] = g->aged[a];
        } else {
            graph_retire_heap(g, &g->aged[a].heap, g->aged[a].made);
        }
    }
    g->num_aged = left;
    return total;
}

// A node all of whose results were kept has nothing to do. One that changes something in place, or reads what it left
// in an earlier frame, runs.
static bool is_done(const tyn_graph *g, uint32_t index)
{
    const node *n = &g->nodes[index];
    bool done = false;
    for (uint32_t p = 0; p < n->pass->num_ports; p++) {
        const tyn_port_dir dir = n->pass->ports[p].dir;
        const resource *r = n->res[p] ? &g->resources[n->res[p] - 1] : NULL;
        if (!r) {
            continue;
        }
        if (dir == TYN_INOUT || r->kind == RESOURCE_HISTORY) {
            return false;
        }
        if (dir == TYN_OUT) {
            if (r->version || g->phys[n->res[p] - 1].content != r->content) {
                return false;
            }
            done = true;
        }
    }
    return done;
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

void tyn_graph_trim(tyn_graph *g)
{
    for (uint32_t i = 0; i < g->num_phys; i++) {
        if (g->phys[i].staged && g->phys[i].staged != g->phys[i].content) {
            return; // still to be copied
        }
    }
    if (g->staging_heap.num_blocks && reserve_all(g)) {
        graph_free_staging(g);
    }
    graph_retire_over(g);
}

void graph_release(tyn_graph *g)
{
    graph_free_staging(g);
    for (uint32_t i = 0; i < g->num_phys; i++) {
        graph_destroy_phys(g, &g->phys[i]);
    }
    graph_retire_heap(g, &g->heap, g->heap_made);
    free(g->phys);
    g->phys = NULL;
    g->num_phys = 0;
    free(g->runs);
    free(g->run_node);
    g->run_node = NULL;
    g->current = false;
    g->runs = NULL;
    g->num_runs = 0;
    g->structure = 0;
}

// ---- compile ----------------------------------------------------------------------------------

static void free_all_aged(tyn_graph *g)
{
    for (uint32_t a = 0; a < g->num_aged; a++) {
        graph_retire_heap(g, &g->aged[a].heap, g->aged[a].made);
    }
    free(g->aged);
    g->aged = NULL;
    g->num_aged = 0;
}

void graph_finish(tyn_graph *g)
{
    graph_release(g);
    free_all_aged(g);
    graph_retire_blocks(g, true);
    const uint64_t made = g->dummy[TYN_BUFFER].made;
    for (int d = 0; d < NUM_DUMMIES; d++) {
        graph_destroy_phys(g, &g->dummy[d]);
    }
    graph_retire_heap(g, &g->dummy_heap, made);
    for (uint32_t i = 0; i < g->num_slots; i++) {
        destroy_slot(g, &g->slots[i]);
    }
}

// A node whose results are kept reports its last run, and goes on settling where it was.
static void inherit_run(tyn_graph *g, uint32_t index, const node_run *before, uint32_t num_before)
{
    node_run *run = &g->runs[index];
    run->hash = g->nodes[index].hash;
    for (uint32_t i = 0; i < num_before; i++) {
        if (before[i].hash == run->hash) {
            *run = before[i];
            return;
        }
    }
}

static tyn_result compile_new(tyn_graph *g, bool only_histories)
{
    if (!reserve_all(g)) {
        return graph_fail(g, TYN_ERR_MEMORY, "out of memory");
    }
    graph_free_staging(g);
    heritage old = take_heritage(g, only_histories);
    node_run *before = g->runs;
    const uint32_t num_before = g->num_runs;
    g->runs = NULL;
    graph_release(g);
    if (only_histories) {
        free_all_aged(g);
        graph_retire_blocks(g, true);
    }
    g->age++;
    g->heap_made = g->frame;
    g->num_phys = g->num_resources;
    g->num_runs = g->num_nodes;
    g->phys = calloc(g->num_phys ? g->num_phys : 1, sizeof *g->phys);
    g->runs = calloc(g->num_runs ? g->num_runs : 1, sizeof *g->runs);
    g->run_node = calloc(g->num_runs ? g->num_runs : 1, sizeof *g->run_node);
    if (!g->phys || !g->runs || !g->run_node) {
        drop_heritage(g, &old);
        free(before);
        return graph_fail(g, TYN_ERR_MEMORY, "out of memory");
    }
    for (uint32_t i = 0; i < g->num_outputs; i++) {
        if (g->outputs[i].readback) {
            phys *p = &g->phys[g->outputs[i].ref.resource - 1];
            p->image_usage |= VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
            p->buffer_usage |= VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
        }
    }
    survey s;
    tyn_result result = graph_survey(g, &s, g->phys);
    result = result == TYN_OK ? create_resources(g, &old) : result;
    drop_heritage(g, &old);
    graph_retire_blocks(g, false);
    result = result == TYN_OK ? create_dummies(g) : result;
    result = result == TYN_OK ? create_slots(g, &s) : result;
    result = result == TYN_OK ? reserve_sets(g, s.sets) : result;
    result = result == TYN_OK ? stage_uploads(g) : result;
    for (uint32_t i = 0; result == TYN_OK && i < g->num_nodes; i++) {
        if (is_done(g, i)) {
            inherit_run(g, i, before, num_before);
        }
    }
    free(before);
    if (result != TYN_OK) {
        graph_finish(g);
        return result;
    }
    g->structure = graph_structure(g, &s);
    g->current = true;
    return TYN_OK;
}

// More memory than a fresh compilation would need by half, and not for the size of blocks alone.
static bool is_wasteful(tyn_graph *g)
{
    const VkDeviceSize need = g->persistent_bytes + g->transient_bytes;
    return free_aged(g) > need + need / 2 + HEAP_SLACK;
}

static tyn_result say_what_waits(const tyn_graph *g, tyn_result result)
{
    const VkDeviceSize bytes = result == TYN_ERR_MEMORY ? graph_retired_bytes(g) : 0;
    if (bytes) {
        tyn_log_print(
            &g->dev->log, TYN_LOG_ERROR,
            "%.1f MiB of what is replaced wait for frames that may be under way: prepare with "
            "tyn_frame.idle when the GPU is done with them",
            (double)bytes / (1 << 20));
    }
    return result;
}

void tyn_graph_forget(tyn_graph *g)
{
    g->idle = true; // nothing of what goes waits for frames
    graph_finish(g);
    graph_retire_over(g);
}

tyn_result tyn_graph_compile(tyn_graph *g)
{
    if (g->status != TYN_OK) {
        return g->status;
    }
    if (same_structure(g)) { // only new data
        if (!reserve_all(g)) {
            return graph_fail(g, TYN_ERR_MEMORY, "out of memory");
        }
        graph_free_staging(g);
        tyn_result staged = stage_uploads(g);
        g->current = staged == TYN_OK;
        return staged;
    }
    g->current = false;
    const tyn_result made = graph_make_pipelines(g);
    if (made != TYN_OK) {
        return made;
    }
    graph_retire_over(g);
    const bool first = !g->num_phys;
    const tyn_result result = compile_new(g, false);
    const bool again = result == TYN_OK ? is_wasteful(g) && g->num_aged
                                        : result == TYN_ERR_MEMORY && g->status == TYN_OK && !first;
    return say_what_waits(g, again ? compile_new(g, true) : result);
}
