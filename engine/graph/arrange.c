// arrange.c -- what a compilation will hold: drafted beside what is there and counted, then allocated, or undone.
#include "graph/internal.h"
#include "base/fault.h"
#include <stdlib.h>
#include <string.h>

// At most so many things of a resource are retired.
enum { PHYS_PARTS = MAX_MIPS + NUM_TEXEL_FORMATS + 6 };

// Room for what a commit retires and ages, so that it cannot fail half-way.
static bool reserve(tyn_graph *g)
{
    aged_heap *grown = realloc(g->aged, (g->num_aged + 1) * sizeof *grown);
    g->aged = grown ? grown : g->aged;
    return grown && graph_retire_reserve(g, (g->num_phys + g->num_resources) * PHYS_PARTS +
                                                2 * MAX_SLOTS + g->num_aged + g->num_blocks + 4);
}

static void *copy_array(const void *from, size_t count, size_t size)
{
    void *to = calloc(count ? count : 1, size);
    if (to && count) {
        memcpy(to, from, count * size);
    }
    return to;
}

// Lists of the draft's own.
static bool begin(tyn_graph *g, draft *d)
{
    const bool uploads = d->how == ARRANGE_UPLOADS;
    g->blocks = copy_array(g->blocks, g->num_blocks, sizeof *g->blocks);
    g->phys = uploads ? copy_array(g->phys, g->num_phys, sizeof *g->phys)
                      : calloc(g->num_resources ? g->num_resources : 1, sizeof *g->phys);
    // Twice: what is taken over may be given back.
    d->old.items = calloc(uploads ? 1 : 2 * (size_t)g->num_phys + 1, sizeof *d->old.items);
    if (!g->blocks || !g->phys || !d->old.items) {
        g->num_blocks = g->num_phys = 0;
        return false;
    }
    for (uint32_t i = 0; i < g->num_phys; i++) {
        phys *p = uploads ? &g->phys[i] : &d->old.items[d->old.count++];
        *p = d->before.phys[i];
        p->kept = true;
        p->staging = (host_buffer){0};
        p->staged = 0;
        if (!uploads) {
            p->readback = (host_buffer){0};
            p->read = 0;
        }
    }
    g->num_phys = uploads ? g->num_phys : g->num_resources;
    return true;
}

static void mark_uses(tyn_graph *g)
{
    for (uint32_t i = 0; i < NUM_ZEROS; i++) { // all that any kernel makes, so that they are kept
        g->phys[i].image_usage =
            i == ZERO_WORDS ? VK_IMAGE_USAGE_STORAGE_BIT : VK_IMAGE_USAGE_SAMPLED_BIT;
        g->phys[i].buffer_usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                  VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
                                  VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;
        g->phys[i].texel_uses = i == TYN_BUFFER ? (1u << NUM_TEXEL_FORMATS) - 1 : 0;
    }
    for (uint32_t i = 0; i < g->num_outputs; i++) {
        if (g->outputs[i].readback) {
            phys *p = &g->phys[g->outputs[i].ref.resource - 1];
            p->image_usage |= VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
            p->buffer_usage |= VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
        }
    }
    for (uint32_t i = 0; i < g->num_resources; i++) {
        const resource_kind kind = g->resources[i].kind;
        if (kind == RESOURCE_UPLOAD || kind == RESOURCE_HISTORY || g->poison) {
            g->phys[i].buffer_usage |= VK_BUFFER_USAGE_TRANSFER_DST_BIT;
            g->phys[i].image_usage |= VK_IMAGE_USAGE_TRANSFER_DST_BIT;
        }
    }
}

static tyn_result draft_all(tyn_graph *g, draft *d)
{
    const bool anew = d->how == ARRANGE_ANEW;
    mark_uses(g);
    TYN_TRY(graph_survey(g, &d->survey, g->phys));
    graph_inherit(g, &d->old, anew);
    TYN_TRY(graph_keep_places(g, &d->old));
    TYN_TRY(graph_draft_resources(g));
    TYN_TRY(graph_draft_shared(g, anew));
    return graph_draft_readbacks(g);
}

tyn_result graph_draft(tyn_graph *g, arrangement how, draft *d)
{
    if (!reserve(g)) {
        return graph_fail(g, TYN_ERR_MEMORY, "out of memory");
    }
    *d = (draft){.how = how, .before = *g};
    g->staging_heap = (tyn_heap){0};
    g->staging_made = g->frame;
    if (how != ARRANGE_UPLOADS) {
        g->heap = (tyn_heap){0};
        g->heap_made = g->frame;
        g->age++;
    }
    tyn_result result = begin(g, d) ? TYN_OK : graph_fail(g, TYN_ERR_MEMORY, "out of memory");
    if (result == TYN_OK && how != ARRANGE_UPLOADS) {
        result = draft_all(g, d);
    }
    result = result == TYN_OK ? graph_draft_staging(g) : result;
    if (result != TYN_OK) {
        graph_undo(g, d);
    }
    return result;
}

// No frame has used what the draft made: it goes at once.
static void destroy_draft(tyn_graph *g, const draft *d)
{
    const bool uploads = d->how == ARRANGE_UPLOADS;
    for (uint32_t i = 0; g->phys && i < g->num_phys; i++) {
        phys *p = &g->phys[i];
        graph_retire(g, VK_OBJECT_TYPE_BUFFER, (uint64_t)p->staging.buffer, g->frame);
        if (!uploads) {
            graph_retire(g, VK_OBJECT_TYPE_BUFFER, (uint64_t)p->readback.buffer, g->frame);
            p->readback = (host_buffer){0};
        }
        if (!p->kept) {
            graph_destroy_phys(g, p);
        }
    }
    for (uint32_t b = 0; g->blocks && b < g->num_blocks; b++) {
        const tyn_heap *heap = &g->blocks[b].heap;
        if (!heap->num_blocks || !heap->blocks[0].allocation.memory) {
            tyn_heap_finish(g->dev, &g->blocks[b].heap);
        }
    }
    if (!uploads) {
        tyn_heap_finish(g->dev, &g->heap);
    }
    tyn_heap_finish(g->dev, &g->staging_heap);
}

void graph_undo(tyn_graph *g, draft *d)
{
    destroy_draft(g, d);
    free(g->phys);
    free(g->blocks);
    free(d->old.items);
    const tyn_result status = g->status;
    *g = d->before;
    g->status = status;
}

VkDeviceSize graph_draft_bytes(const tyn_graph *g, const draft *d)
{
    const tyn_graph *before = &d->before;
    VkDeviceSize bytes = graph_retired_bytes(g) + g->heap.total + g->staging_heap.total;
    for (uint32_t i = 0; i < g->num_phys; i++) {
        bytes += g->phys[i].heap.total;
    }
    for (uint32_t i = 0; i < d->old.count; i++) {
        bytes += graph_waits(g, d->old.items[i].made) ? d->old.items[i].heap.total : 0;
    }
    for (uint32_t b = 0; b < g->num_blocks; b++) {
        const shared_block *block = &g->blocks[b];
        bytes += graph_block_used(g, block) || graph_waits(g, block->made) ? block->size : 0;
    }
    for (uint32_t a = 0; a < g->num_aged; a++) {
        const aged_heap *aged = &g->aged[a];
        bytes += graph_heap_used(g, aged->age) || graph_waits(g, aged->made) ? aged->heap.total : 0;
    }
    if (d->how != ARRANGE_UPLOADS &&
        (graph_heap_used(g, before->age) || graph_waits(g, before->heap_made))) {
        bytes += before->heap.total;
    }
    return bytes + (graph_waits(g, before->staging_made) ? before->staging_heap.total : 0);
}

// Things before the heaps in which they lie.
static void give_up(tyn_graph *g, draft *d)
{
    tyn_graph *before = &d->before;
    const bool uploads = d->how == ARRANGE_UPLOADS;
    for (uint32_t i = 0; i < before->num_phys; i++) {
        const phys *p = &before->phys[i];
        graph_retire(g, VK_OBJECT_TYPE_BUFFER, (uint64_t)p->staging.buffer, before->staging_made);
        if (!uploads) {
            graph_retire(g, VK_OBJECT_TYPE_BUFFER, (uint64_t)p->readback.buffer, p->made);
        }
    }
    for (uint32_t i = 0; i < d->old.count; i++) {
        graph_destroy_phys(g, &d->old.items[i]);
    }
    graph_retire_heap(g, &before->staging_heap, before->staging_made);
    if (!uploads && before->heap.num_blocks) {
        g->aged[g->num_aged++] = (aged_heap){before->heap, before->age, before->heap_made};
    }
    graph_retire_aged(g, false);
    graph_retire_blocks(g, false);
    free(before->phys);
    free(before->blocks);
    free(d->old.items);
}

tyn_result graph_commit(tyn_graph *g, draft *d)
{
    give_up(g, d);
    TYN_TRY(tyn_heap_allocate(g->dev, &g->heap));
    for (uint32_t i = 0; i < g->num_phys; i++) {
        TYN_TRY(tyn_heap_allocate(g->dev, &g->phys[i].heap));
    }
    for (uint32_t b = 0; b < g->num_blocks; b++) {
        TYN_TRY(tyn_heap_allocate(g->dev, &g->blocks[b].heap));
    }
    TYN_TRY(tyn_heap_allocate(g->dev, &g->staging_heap));
    return graph_bind_objects(g);
}
