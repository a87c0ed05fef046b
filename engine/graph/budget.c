// budget.c -- a compilation is tried out before it is made: would its memory keep to the budget?
//
// The trial is the compilation itself, on a copy of the graph and of the device, whose blocks of memory are numbers. Only
// what it makes anew are Vulkan objects, without memory, so that the driver says what they need; they go when it is over.
#include "graph/internal.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct meter { // bytes
    VkDeviceSize now, most;
} meter;

// A block's size takes the place of its memory.
static VkResult count_block(void *user, const tyn_memory_request *request, tyn_allocation *out)
{
    static char nothing;
    meter *m = user;
    const VkDeviceSize size = request->requirements.size;
    m->now += size;
    m->most = m->now > m->most ? m->now : m->most;
    *out = (tyn_allocation){.memory = (VkDeviceMemory)(uintptr_t)size,
                            .mapped = request->mapped ? &nothing : NULL};
    return VK_SUCCESS;
}

static void uncount_block(void *user, const tyn_allocation *block)
{
    ((meter *)user)->now -= (VkDeviceSize)(uintptr_t)block->memory;
}

static VkResult bind_no_buffer(VkDevice dev, VkBuffer buffer, VkDeviceMemory memory,
                               VkDeviceSize at)
{
    (void)dev, (void)buffer, (void)memory, (void)at;
    return VK_SUCCESS;
}

static VkResult bind_no_image(VkDevice dev, VkImage image, VkDeviceMemory memory, VkDeviceSize at)
{
    (void)dev, (void)image, (void)memory, (void)at;
    return VK_SUCCESS;
}

#define MAKES_NO_VIEW(Type)                                                                        \
    static VkResult make_no_##Type(VkDevice dev, const Vk##Type##CreateInfo *info,                 \
                                   const VkAllocationCallbacks *callbacks, Vk##Type *out)          \
    {                                                                                              \
        (void)dev, (void)info, (void)callbacks;                                                    \
        *out = VK_NULL_HANDLE;                                                                     \
        return VK_SUCCESS;                                                                         \
    }
#define DESTROYS_NO(Type)                                                                          \
    static void destroy_no_##Type(VkDevice dev, Vk##Type handle,                                   \
                                  const VkAllocationCallbacks *callbacks)                          \
    {                                                                                              \
        (void)dev, (void)handle, (void)callbacks;                                                  \
    }
MAKES_NO_VIEW(ImageView)
MAKES_NO_VIEW(BufferView)
DESTROYS_NO(ImageView)
DESTROYS_NO(BufferView)
DESTROYS_NO(Image)
DESTROYS_NO(Buffer)

// A device on which a compilation costs nothing but objects without memory, and destroys nothing.
static void make_shadow(const tyn_device *dev, meter *m, tyn_device *shadow)
{
    *shadow = *dev;
    shadow->allocator = (tyn_allocator){count_block, uncount_block, m};
    shadow->vk.BindBufferMemory = bind_no_buffer;
    shadow->vk.BindImageMemory = bind_no_image;
    shadow->vk.CreateImageView = make_no_ImageView;
    shadow->vk.CreateBufferView = make_no_BufferView;
    shadow->vk.DestroyImageView = destroy_no_ImageView;
    shadow->vk.DestroyBufferView = destroy_no_BufferView;
    shadow->vk.DestroyImage = destroy_no_Image;
    shadow->vk.DestroyBuffer = destroy_no_Buffer;
}

static void *copy_array(const void *from, size_t count, size_t size, bool *ok)
{
    void *to = count ? malloc(count * size) : NULL;
    if (to) {
        memcpy(to, from, count * size);
    }
    *ok = *ok && (to || !count);
    return to;
}

// Makes `heap`, a copy, one whose blocks are numbers.
static void copy_heap(tyn_heap *heap, meter *m, bool *ok)
{
    heap->blocks = copy_array(heap->blocks, heap->num_blocks, sizeof *heap->blocks, ok);
    heap->num_blocks = heap->blocks ? heap->num_blocks : 0;
    for (uint32_t b = 0; b < heap->num_blocks; b++) {
        tyn_allocation *a = &heap->blocks[b].allocation;
        a->memory = (VkDeviceMemory)(uintptr_t)heap->blocks[b].size;
        m->now += heap->blocks[b].size;
    }
}

// What a compilation changes; without pools, which hold no memory of resources. False: out of memory.
static bool copy_graph(const tyn_graph *g, tyn_device *shadow, meter *m, tyn_graph *t)
{
    bool ok = true;
    *t = *g;
    t->dev = shadow;
    t->runs = NULL;
    t->num_runs = 0;
    t->run_node = NULL;
    memset(t->slots, 0, sizeof t->slots);
    t->retired = (retire_list){0};
    t->phys = copy_array(g->phys, g->num_phys, sizeof *g->phys, &ok);
    t->num_phys = t->phys ? g->num_phys : 0;
    t->blocks = copy_array(g->blocks, g->num_blocks, sizeof *g->blocks, &ok);
    t->num_blocks = t->blocks ? g->num_blocks : 0;
    t->aged = copy_array(g->aged, g->num_aged, sizeof *g->aged, &ok);
    t->num_aged = t->aged ? g->num_aged : 0;
    m->now = graph_retired_bytes(g);
    for (uint32_t i = 0; i < t->num_phys; i++) {
        copy_heap(&t->phys[i].heap, m, &ok);
    }
    for (uint32_t i = 0; i < t->num_blocks; i++) {
        copy_heap(&t->blocks[i].heap, m, &ok);
    }
    for (uint32_t i = 0; i < t->num_aged; i++) {
        copy_heap(&t->aged[i].heap, m, &ok);
    }
    copy_heap(&t->heap, m, &ok);
    copy_heap(&t->staging_heap, m, &ok);
    copy_heap(&t->dummy_heap, m, &ok);
    m->most = m->now;
    return ok;
}

static bool is_old_buffer(const tyn_graph *g, VkBuffer buffer)
{
    for (uint32_t i = 0; i < g->num_phys; i++) {
        const phys *p = &g->phys[i];
        if (p->buffer == buffer || p->readback == buffer || p->staging == buffer) {
            return true;
        }
    }
    return g->dummy[TYN_BUFFER].buffer == buffer;
}

static bool is_old_image(const tyn_graph *g, VkImage image)
{
    for (uint32_t i = 0; i < g->num_phys + NUM_DUMMIES; i++) {
        const phys *p = i < NUM_DUMMIES ? &g->dummy[i] : &g->phys[i - NUM_DUMMIES];
        if (p->image == image) {
            return true;
        }
    }
    return false;
}

// What of it the graph did not have before the trial.
static void destroy_new(const tyn_graph *g, const phys *p)
{
    const tyn_device *dev = g->dev;
    const VkBuffer buffers[] = {p->buffer, p->readback, p->staging};
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; i++) {
        if (buffers[i] && !is_old_buffer(g, buffers[i])) {
            dev->vk.DestroyBuffer(dev->device, buffers[i], NULL);
        }
    }
    if (p->image && !p->borrowed && !is_old_image(g, p->image)) {
        dev->vk.DestroyImage(dev->device, p->image, NULL);
    }
}

static void finish_trial(const tyn_graph *g, tyn_graph *t)
{
    for (uint32_t i = 0; i < t->num_phys; i++) {
        destroy_new(g, &t->phys[i]);
    }
    for (int d = 0; d < NUM_DUMMIES; d++) {
        destroy_new(g, &t->dummy[d]);
    }
    t->idle = true; // all goes at once
    graph_finish(t);
    graph_retire_finish(t);
}

tyn_result graph_try(tyn_graph *g, arrangement how, VkDeviceSize *most)
{
    meter m = {0};
    tyn_device shadow;
    make_shadow(g->dev, &m, &shadow);
    tyn_graph t;
    survey s;
    tyn_result result = copy_graph(g, &shadow, &m, &t)
                            ? graph_arrange(&t, how, &s)
                            : graph_fail(g, TYN_ERR_MEMORY, "out of memory");
    finish_trial(g, &t);
    if (g->status == TYN_OK) {
        g->status = t.status;
    }
    *most = m.most;
    return result;
}

// The `count` largest resources, largest first; those that are missing are NULL.
static void find_largest(const tyn_graph *g, const resource **largest, uint32_t count)
{
    for (uint32_t k = 0; k < count; k++) {
        largest[k] = NULL;
        for (uint32_t i = 0; i < g->num_resources; i++) {
            const resource *r = &g->resources[i];
            bool taken = r->kind == RESOURCE_IMPORT;
            for (uint32_t j = 0; j < k; j++) {
                taken = taken || largest[j] == r;
            }
            if (!taken &&
                (!largest[k] || graph_resource_bytes(r) > graph_resource_bytes(largest[k]))) {
                largest[k] = r;
            }
        }
    }
}

static double mib(VkDeviceSize bytes)
{
    return (double)bytes / (1 << 20);
}

static tyn_result refuse(tyn_graph *g, VkDeviceSize needed)
{
    const resource *largest[3];
    find_largest(g, largest, 3);
    char list[320], waiting[96] = "";
    int used = 0;
    list[0] = 0;
    for (uint32_t k = 0; k < 3 && largest[k]; k++) {
        const resource *r = largest[k];
        used += snprintf(list + used, sizeof list - (size_t)used, "%s%.40s%s%.40s %.2f MiB",
                         k ? ", " : "", r->owner, r->owner[0] ? "." : "", r->name,
                         mib(graph_resource_bytes(r)));
    }
    if (graph_retired_bytes(g)) {
        snprintf(waiting, sizeof waiting, ", of which %.2f MiB wait for frames under way",
                 mib(graph_retired_bytes(g)));
    }
    return graph_fail(g, TYN_ERR_MEMORY,
                      "memory_budget is %.2f MiB, and %.2f MiB are needed%s; the largest: %s",
                      mib(g->budget), mib(needed), waiting, list);
}

tyn_result graph_keep_to_budget(tyn_graph *g, arrangement *how)
{
    VkDeviceSize least = UINT64_MAX;
    while (g->budget) {
        VkDeviceSize most = 0;
        const tyn_result result = graph_try(g, *how, &most);
        if (result != TYN_OK || most <= g->budget) {
            return result;
        }
        least = most < least ? most : least;
        if (*how != ARRANGE_KEEPING || !g->num_phys) {
            return refuse(g, least);
        }
        *how = ARRANGE_ANEW;
    }
    return TYN_OK;
}

bool graph_fits_budget(tyn_graph *g, arrangement how)
{
    VkDeviceSize most = 0;
    return !g->budget || (graph_try(g, how, &most) == TYN_OK && most <= g->budget);
}

void tyn_graph_budget(tyn_graph *g, uint64_t bytes)
{
    g->budget = bytes;
}
