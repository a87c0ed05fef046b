// retire.c -- what a compilation replaced, kept until the frames that were recorded with it are over.
//
// The host makes the call i + frames_in_flight after the GPU has finished call i: that is how it says which frames are over. What
// no frame has been recorded with since it was made goes at once.
#include "graph/internal.h"
#include "base/grow.h"
#include <stdlib.h>

typedef struct retired {
    VkObjectType type; // VK_OBJECT_TYPE_UNKNOWN: a heap
    uint64_t handle;
    tyn_heap heap;
    uint64_t frame; // so many had been recorded
} retired;

bool graph_retire_reserve(tyn_graph *g, uint32_t count)
{
    retire_list *list = &g->retired;
    return tyn_grow(&list->items, &list->cap, list->count + count, sizeof *list->items);
}

static void destroy(const tyn_graph *g, retired *r)
{
    tyn_device *dev = g->dev;
    const tyn_procs *vk = &dev->vk;
    switch ((int)r->type) {
#define DESTROY(TYPE, Type)                                                                        \
    case VK_OBJECT_TYPE_##TYPE:                                                                    \
        vk->Destroy##Type(dev->device, (Vk##Type)r->handle, NULL);                                 \
        break;
        DESTROY(IMAGE_VIEW, ImageView)
        DESTROY(IMAGE, Image)
        DESTROY(BUFFER_VIEW, BufferView)
        DESTROY(BUFFER, Buffer)
        DESTROY(DESCRIPTOR_POOL, DescriptorPool)
        DESTROY(QUERY_POOL, QueryPool)
    default:
        tyn_heap_finish(dev, &r->heap);
        break;
    }
}

// Is the GPU done with frames before `frame`, when the one with number g->frame is prepared or recorded?
static bool is_over(const tyn_graph *g, uint64_t frame)
{
    return g->mode.idle || !frame || frame + g->num_slots <= g->frame + 1;
}

bool graph_waits(const tyn_graph *g, uint64_t made)
{
    return made != g->frame && !is_over(g, g->frame);
}

static void retire(tyn_graph *g, retired r, uint64_t made)
{
    retire_list *list = &g->retired;
    if (graph_waits(g, made)) {
        r.frame = g->frame;
        list->items[list->count++] = r; // reserved
    } else {
        destroy(g, &r);
    }
}

void graph_retire(tyn_graph *g, VkObjectType type, uint64_t handle, uint64_t made)
{
    if (handle) {
        retire(g, (retired){.type = type, .handle = handle}, made);
    }
}

void graph_retire_heap(tyn_graph *g, tyn_heap *heap, uint64_t made)
{
    if (heap->num_blocks) {
        retire(g, (retired){.heap = *heap}, made);
        *heap = (tyn_heap){0};
    } else {
        tyn_heap_finish(g->dev, heap);
    }
}

// In the order in which they came: what lies in a heap goes before it.
void graph_retire_over(tyn_graph *g)
{
    retire_list *list = &g->retired;
    uint32_t over = 0;
    while (over < list->count && is_over(g, list->items[over].frame)) {
        destroy(g, &list->items[over++]);
    }
    for (uint32_t i = over; over && i < list->count; i++) {
        list->items[i - over] = list->items[i];
    }
    list->count -= over;
}

void graph_retire_finish(tyn_graph *g)
{
    for (uint32_t i = 0; i < g->retired.count; i++) {
        destroy(g, &g->retired.items[i]);
    }
    free(g->retired.items);
    g->retired = (retire_list){0};
}

VkDeviceSize graph_retired_bytes(const tyn_graph *g)
{
    VkDeviceSize bytes = 0;
    for (uint32_t i = 0; i < g->retired.count; i++) {
        bytes += g->retired.items[i].heap.total;
    }
    return bytes;
}
