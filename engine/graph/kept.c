// kept.c -- what a compilation leaves to the next: histories, uploads, what nodes made and where they worked.
#include "graph/internal.h"
#include "base/hash.h"
#include <stdlib.h>

enum { HEAP_SLACK = 32 << 20 }; // bytes

uint64_t graph_identity(const tyn_graph *g, const resource *r)
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
void graph_inherit(tyn_graph *g, heritage *old)
{
    for (int any = 0; any < 2; any++) {
        for (uint32_t i = 0; i < g->num_resources; i++) {
            const resource *r = &g->resources[i];
            phys *p = &g->phys[i];
            const uint64_t identity = graph_identity(g, r);
            if (!p->identity && (any || r->kind != RESOURCE_HISTORY)) {
                inherit(old, identity, any ? 0 : r->content, p);
            }
        }
    }
}

// Takes out what this compilation may use again, without what belongs to the last one alone; the heaps stay. Without
// memory for the list there is nothing: all starts anew.
heritage graph_take_heritage(tyn_graph *g, bool only_histories)
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

void graph_drop_heritage(tyn_graph *g, heritage *h)
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

void graph_free_all_aged(tyn_graph *g)
{
    for (uint32_t a = 0; a < g->num_aged; a++) {
        graph_retire_heap(g, &g->aged[a].heap, g->aged[a].made);
    }
    free(g->aged);
    g->aged = NULL;
    g->num_aged = 0;
}

// More memory than a fresh compilation would need by half, and not for the size of blocks alone.
bool graph_is_wasteful(tyn_graph *g)
{
    const VkDeviceSize need = g->persistent_bytes + g->transient_bytes;
    return free_aged(g) > need + need / 2 + HEAP_SLACK;
}

// A node all of whose results were kept has nothing to do. One that changes something in place, or reads what it left
// in an earlier frame, runs.
bool graph_is_done(const tyn_graph *g, uint32_t index)
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

// A node whose results are kept reports its last run, and goes on settling where it was.
void graph_inherit_run(tyn_graph *g, uint32_t index, const node_run *before, uint32_t num_before)
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
