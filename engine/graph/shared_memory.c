// shared_memory.c -- memory of what nodes make, some of it in the same place.
#include "graph/internal.h"
#include "graph/share.h"
#include <stdlib.h>

static const VkDeviceSize MAX_BLOCK = 256u << 20;

bool graph_overlap(const phys *a, const phys *b)
{
    return a->shared && b->shared && a->block == b->block && a->offset < b->offset + b->size &&
           b->offset < a->offset + a->size;
}

// Which nodes read something of which, at first or second hand: [reader * num_nodes + read]. NULL: out of memory.
static bool *find_followers(const tyn_graph *g)
{
    const uint32_t n = g->num_nodes;
    bool *follows = calloc((size_t)n * n + 1, sizeof *follows);
    for (uint32_t i = 0; follows && i < n; i++) {
        const node *reader = &g->nodes[i];
        for (uint32_t p = 0; p < reader->pass->num_ports; p++) {
            const tyn_port_dir dir = reader->pass->ports[p].dir;
            const bool read = reader->res[p] && (dir == TYN_IN || dir == TYN_INOUT);
            const uint32_t writer =
                read ? g->resources[reader->res[p] - 1].writers[reader->versions[p]] : 0;
            if (writer) {
                follows[i * n + writer - 1] = true;
                for (uint32_t k = 0; k < writer - 1; k++) {
                    follows[i * n + k] |= follows[(writer - 1) * n + k];
                }
            }
        }
    }
    return follows;
}

static void describe(const tyn_graph *g, uint32_t index, uint32_t maker, tyn_share_item *item)
{
    const tyn_device *dev = g->dev;
    const resource *r = &g->resources[index];
    const VkDeviceSize page = dev->properties.limits.bufferImageGranularity;
    VkMemoryRequirements need;
    if (r->dim == TYN_BUFFER) {
        dev->vk.GetBufferMemoryRequirements(dev->device, g->phys[index].buffer, &need);
    } else {
        dev->vk.GetImageMemoryRequirements(dev->device, g->phys[index].image, &need);
    }
    // Buffers and images are neighbours: keep them a granularity page apart.
    const VkDeviceSize align = need.alignment > page ? need.alignment : page;
    *item = (tyn_share_item){
        .size = (need.size + align - 1) / align * align,
        .align = align,
        .type = (uint32_t)tyn_memory_type(dev, need.memoryTypeBits, TYN_MEMORY_DEVICE),
        .node = maker,
        .kept = r->kind == RESOURCE_OUT,
        .unused = !g->nodes[maker].needed,
    };
}

static tyn_result bind(tyn_graph *g, uint32_t index, const tyn_share_item *item,
                       const tyn_allocation *block)
{
    const tyn_device *dev = g->dev;
    phys *p = &g->phys[index];
    p->block = item->block;
    p->offset = item->offset;
    p->size = item->size;
    const bool buffer = g->resources[index].dim == TYN_BUFFER;
    const VkDeviceSize at = block->offset + item->offset;
    return tyn_vk_check(dev,
                        buffer ? dev->vk.BindBufferMemory(dev->device, p->buffer, block->memory, at)
                               : dev->vk.BindImageMemory(dev->device, p->image, block->memory, at),
                        g->resources[index].name);
}

typedef struct sharing {
    bool *follows;
    tyn_share_item *items;
    tyn_share_block *blocks;
    tyn_allocation *memory;    // of blocks
    uint32_t *order, *indices; // of items: scratch; resources
    uint32_t count;
} sharing;

static void list_items(const tyn_graph *g, sharing *s)
{
    for (uint32_t i = 0; i < g->num_nodes; i++) {
        for (uint32_t p = 0; p < g->nodes[i].pass->num_ports; p++) {
            const tyn_port_dir dir = g->nodes[i].pass->ports[p].dir;
            const uint32_t id = g->nodes[i].res[p];
            if (id && g->phys[id - 1].shared && (dir == TYN_OUT || dir == TYN_SCRATCH)) {
                s->indices[s->count] = id - 1;
                describe(g, id - 1, i, &s->items[s->count++]);
            }
        }
    }
}

static tyn_result place(tyn_graph *g, sharing *s, VkDeviceSize *passing)
{
    list_items(g, s);
    const uint32_t num_blocks = tyn_share_plan(s->items, s->count, s->follows, g->num_nodes,
                                               MAX_BLOCK, s->blocks, s->order);
    tyn_result result = TYN_OK;
    VkDeviceSize all = 0, kept = 0;
    for (uint32_t b = 0; result == TYN_OK && b < num_blocks; b++) {
        VkDeviceSize align = 1; // powers of two
        for (uint32_t i = 0; i < s->count; i++) {
            const tyn_share_item *item = &s->items[i];
            align = item->block == b && item->align > align ? item->align : align;
        }
        all += s->blocks[b].size;
        result = tyn_heap_add(g->dev, &g->heap, s->blocks[b].type, s->blocks[b].size, align,
                              &s->memory[b]);
    }
    for (uint32_t i = 0; result == TYN_OK && i < s->count; i++) {
        kept += s->items[i].kept && !s->items[i].unused ? s->items[i].size : 0;
        result = bind(g, s->indices[i], &s->items[i], &s->memory[s->items[i].block]);
    }
    *passing = all - kept;
    return result;
}

tyn_result graph_bind_shared(tyn_graph *g, VkDeviceSize *passing)
{
    const size_t n = g->num_resources + 1;
    sharing s = {.follows = find_followers(g),
                 .items = calloc(n, sizeof *s.items),
                 .blocks = calloc(n, sizeof *s.blocks),
                 .memory = calloc(n, sizeof *s.memory),
                 .order = calloc(n, sizeof *s.order),
                 .indices = calloc(n, sizeof *s.indices)};
    const bool room = s.follows && s.items && s.blocks && s.memory && s.order && s.indices;
    const tyn_result result = room ? place(g, &s, passing) : TYN_ERR_MEMORY;
    free(s.follows);
    free(s.items);
    free(s.blocks);
    free(s.memory);
    free(s.order);
    free(s.indices);
    return result;
}
