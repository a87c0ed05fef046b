// shared_memory.c -- memory of what nodes make, some of it in the same place.
#include "graph/internal.h"
#include "base/fault.h"
#include "graph/share.h"
#include <stdlib.h>

static const VkDeviceSize MAX_BLOCK = 256u << 20;
static const uint32_t NO_TYPE = UINT32_MAX; // of memory: nothing is placed there

bool graph_overlap(const phys *a, const phys *b)
{
    return a->shared && b->shared && a->block && a->block == b->block &&
           a->place.offset < b->place.offset + b->size &&
           b->place.offset < a->place.offset + a->size;
}

// Which nodes read something of which, at first or second hand: [reader * num_nodes + read]. NULL: out of memory.
static bool *find_followers(const tyn_graph *g)
{
    const uint32_t n = g->num_nodes;
    bool *follows = calloc((size_t)n * n + 1, sizeof *follows);
    for (uint32_t i = 0; follows && i < n; i++) {
        const node *reader = &g->nodes[i];
        for (uint32_t p = 0; p < reader->pass->num_ports; p++) {
            const uint32_t id = graph_port(reader, p, DIR_READ);
            const uint32_t writer = id ? g->resources[id - 1].writers[reader->versions[p]] : 0;
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

shared_block *graph_find_block(const tyn_graph *g, uint32_t id)
{
    for (uint32_t b = 0; b < g->num_blocks; b++) {
        if (g->blocks[b].id == id) {
            return &g->blocks[b];
        }
    }
    return NULL;
}

static bool is_placed(const phys *p)
{
    return p->shared && p->block;
}

static void describe(const tyn_graph *g, uint32_t index, uint32_t maker, tyn_share_item *item)
{
    const tyn_device *dev = g->dev;
    const resource *r = &g->resources[index];
    const phys *p = &g->phys[index];
    const VkDeviceSize page = dev->properties.limits.bufferImageGranularity;
    const VkMemoryRequirements need = graph_requirements(g, p);
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
    if (is_placed(p)) {
        item->block = (uint32_t)(graph_find_block(g, p->block) - g->blocks);
        item->offset = p->place.offset;
    }
}

static void settle(tyn_graph *g, uint32_t index, const tyn_share_item *item)
{
    const shared_block *block = &g->blocks[item->block];
    phys *p = &g->phys[index];
    p->block = block->id;
    p->place = (tyn_place){.offset = item->offset};
    p->size = item->size;
    if (block->made != g->frame) { // its first layout waits for what used the place before
        p->track = (tyn_track){.write_stages = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                               .write_access = VK_ACCESS_2_MEMORY_WRITE_BIT};
    }
}

// Does a needed node make it?
static bool is_needed(const tyn_graph *g, uint32_t index)
{
    for (uint32_t i = 0; i < g->num_nodes; i++) {
        const node *n = &g->nodes[i];
        for (uint32_t p = 0; n->needed && p < n->pass->num_ports; p++) {
            if (graph_port(n, p, DIR_MADE) == index + 1) {
                return true;
            }
        }
    }
    return false;
}

// How much of what a resource takes lies where others that needed nodes make lie, too.
static VkDeviceSize shared_bytes(const tyn_graph *g, uint32_t index)
{
    const phys *p = &g->phys[index];
    const VkDeviceSize end = p->place.offset + p->size;
    VkDeviceSize at = p->place.offset, shared = 0;
    while (at < end) { // from `at` on: to where those that lie there reach, or on to the next
        VkDeviceSize reach = at, next = end;
        for (uint32_t i = 0; i < g->num_phys; i++) {
            const phys *q = &g->phys[i];
            if (i == index || !graph_overlap(p, q) || q->place.offset + q->size <= at ||
                !is_needed(g, i)) {
                continue;
            }
            if (q->place.offset > at) {
                next = q->place.offset < next ? q->place.offset : next;
            } else {
                reach = q->place.offset + q->size > reach ? q->place.offset + q->size : reach;
            }
        }
        reach = reach < end ? reach : end;
        shared += reach - at;
        at = reach > at ? reach : next;
    }
    return shared < p->bytes ? shared : p->bytes; // the place is rounded up
}

void graph_node_bytes(const tyn_graph *g, uint32_t index, uint64_t *bytes, uint64_t *shared)
{
    const node *n = &g->nodes[index];
    *bytes = *shared = 0;
    for (uint32_t p = 0; p < n->pass->num_ports; p++) {
        const uint32_t id = graph_port(n, p, DIR_MADE);
        if (id) {
            *bytes += g->phys[id - 1].bytes;
            *shared += shared_bytes(g, id - 1);
        }
    }
}

typedef struct sharing {
    bool *follows;
    tyn_share_list list;
    uint32_t *indices; // resources of its items
    tyn_share_item *anew;
    tyn_share_block *anew_blocks;
} sharing;

// `placed`: those that have a place, else those that have none.
static void list_items(const tyn_graph *g, bool placed, sharing *s)
{
    for (uint32_t i = 0; i < g->num_nodes; i++) {
        for (uint32_t p = 0; p < g->nodes[i].pass->num_ports; p++) {
            const uint32_t id = graph_port(&g->nodes[i], p, DIR_MADE);
            if (id && g->phys[id - 1].shared && is_placed(&g->phys[id - 1]) == placed) {
                s->indices[s->list.count] = id - 1;
                describe(g, id - 1, i, &s->list.items[s->list.count++]);
            }
        }
    }
}

static bool open_sharing(const tyn_graph *g, sharing *s)
{
    const size_t n = g->num_resources + 1, b = n + g->num_blocks;
    *s = (sharing){.follows = find_followers(g),
                   .list = {.items = calloc(n, sizeof *s->list.items),
                            .blocks = calloc(b, sizeof *s->list.blocks),
                            .order = calloc(n, sizeof *s->list.order)},
                   .indices = calloc(n, sizeof *s->indices),
                   .anew = calloc(n, sizeof *s->anew),
                   .anew_blocks = calloc(n, sizeof *s->anew_blocks)};
    return s->follows && s->list.items && s->list.blocks && s->list.order && s->indices &&
           s->anew && s->anew_blocks;
}

static void close_sharing(sharing *s)
{
    free(s->follows);
    free(s->list.items);
    free(s->list.blocks);
    free(s->list.order);
    free(s->indices);
    free(s->anew);
    free(s->anew_blocks);
}

// Bytes of all blocks if all items were placed anew.
static VkDeviceSize bytes_anew(const tyn_graph *g, const sharing *s)
{
    tyn_share_list list = {
        .items = s->anew, .count = s->list.count, .blocks = s->anew_blocks, .order = s->list.order};
    for (uint32_t i = 0; i < list.count; i++) {
        list.items[i] = s->list.items[i];
    }
    tyn_share_plan(&list, s->follows, g->num_nodes, MAX_BLOCK);
    VkDeviceSize all = 0;
    for (uint32_t b = 0; b < list.num_blocks; b++) {
        all += list.blocks[b].size;
    }
    return all;
}

static tyn_result add_block(tyn_graph *g, const sharing *s, uint32_t index)
{
    shared_block *grown = realloc(g->blocks, (g->num_blocks + 1) * sizeof *grown);
    if (!grown) {
        return TYN_ERR_MEMORY;
    }
    g->blocks = grown;
    shared_block *block = &grown[g->num_blocks];
    const tyn_share_block *plan = &s->list.blocks[index];
    *block = (shared_block){.size = plan->size,
                            .align = 1, // powers of two
                            .id = ++g->block_ids,
                            .type = plan->type,
                            .made = g->frame};
    for (uint32_t i = 0; i < s->list.count; i++) {
        const tyn_share_item *item = &s->list.items[i];
        if (item->block == index && item->align > block->align) {
            block->align = item->align;
        }
    }
    g->num_blocks++;
    return tyn_heap_add(&block->heap, &(tyn_block){.type = block->type,
                                                   .align = block->align,
                                                   .size = block->size,
                                                   .used = block->size});
}

static tyn_result place(tyn_graph *g, sharing *s, bool anew)
{
    list_items(g, true, s);
    s->list.placed = s->list.count;
    list_items(g, false, s);
    for (uint32_t b = 0; b < g->num_blocks; b++) {
        const shared_block *block = &g->blocks[b];
        s->list.blocks[s->list.num_blocks++] = (tyn_share_block){
            .size = block->size, .align = block->align, .type = anew ? NO_TYPE : block->type};
    }
    tyn_share_plan(&s->list, s->follows, g->num_nodes, MAX_BLOCK);
    g->reused = !anew && g->num_blocks > 0; // whoever used that memory last may be gone
    for (uint32_t b = g->num_blocks; b < s->list.num_blocks; b++) {
        TYN_TRY(add_block(g, s, b));
    }
    VkDeviceSize kept = 0;
    for (uint32_t i = 0; i < s->list.count; i++) {
        const tyn_share_item *item = &s->list.items[i];
        kept += item->kept && !item->unused ? item->size : 0;
        if (i >= s->list.placed) {
            settle(g, s->indices[i], item);
        }
    }
    g->transient_bytes += bytes_anew(g, s) - kept;
    return TYN_OK;
}

tyn_result graph_draft_shared(tyn_graph *g, bool anew)
{
    sharing s;
    const tyn_result result =
        open_sharing(g, &s) ? place(g, &s, anew) : graph_fail(g, TYN_ERR_MEMORY, "out of memory");
    close_sharing(&s);
    return result;
}

// Which of two that may not lie in one place goes: scratch, or what holds nothing that is wanted.
static uint32_t worse(const tyn_graph *g, uint32_t a, uint32_t b)
{
    const bool scratch = g->resources[a].kind == RESOURCE_SCRATCH;
    return scratch || g->phys[a].content != g->resources[a].content ? a : b;
}

static void give_up(tyn_graph *g, uint32_t index, heritage *old)
{
    phys *p = &g->phys[index];
    const phys uses = {.image_usage = p->image_usage,
                       .buffer_usage = p->buffer_usage,
                       .texel_uses = p->texel_uses};
    old->items[old->count++] = *p;
    *p = uses;
}

tyn_result graph_keep_places(tyn_graph *g, heritage *old)
{
    sharing s;
    const tyn_result result =
        open_sharing(g, &s) ? TYN_OK : graph_fail(g, TYN_ERR_MEMORY, "out of memory");
    if (result == TYN_OK) {
        list_items(g, true, &s);
    }
    for (uint32_t i = 0; i < s.list.count; i++) {
        for (uint32_t k = 0; k < i; k++) {
            const uint32_t a = s.indices[i], b = s.indices[k];
            if (graph_overlap(&g->phys[a], &g->phys[b]) &&
                !tyn_share_apart(&s.list.items[i], &s.list.items[k], s.follows, g->num_nodes)) {
                give_up(g, worse(g, a, b), old);
            }
        }
    }
    close_sharing(&s);
    return result;
}

bool graph_block_used(const tyn_graph *g, const shared_block *block)
{
    bool used = false;
    for (uint32_t i = 0; i < g->num_phys; i++) {
        used |= is_placed(&g->phys[i]) && g->phys[i].block == block->id;
    }
    return used;
}

void graph_retire_blocks(tyn_graph *g, bool all)
{
    uint32_t left = 0;
    for (uint32_t b = 0; b < g->num_blocks; b++) {
        if (!all && graph_block_used(g, &g->blocks[b])) {
            g->blocks[left++] = g->blocks[b];
        } else {
            graph_retire_heap(g, &g->blocks[b].heap, g->blocks[b].made);
        }
    }
    g->num_blocks = left;
    if (!left) {
        free(g->blocks);
        g->blocks = NULL;
    }
}
