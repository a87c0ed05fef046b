// kept.c -- what a compilation takes over from the one before: histories, uploads, what nodes made and where they worked.
#include "graph/internal.h"
#include <tyndall/extend/hash.h>
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

// Makes `p` the resource of the same name, shape and uses of the compilation before. False: there was none. `content`: what
// it must hold; 0: anything.
static bool inherit(heritage *from, bool only_histories, uint64_t identity, uint64_t content,
                    phys *p)
{
    for (uint32_t i = 0; identity && i < from->count; i++) {
        phys *old = &from->items[i];
        if (old->identity == identity && !(only_histories && old->age) &&
            (!content || old->content == content) && (p->image_usage & ~old->image_usage) == 0 &&
            (p->buffer_usage & ~old->buffer_usage) == 0 &&
            (p->texel_uses & ~old->texel_uses) == 0) {
            *p = *old;
            p->kept = true;
            *old = (phys){0};
            return true;
        }
    }
    return false;
}

// First those whose content is wanted again, so that no other takes their place.
void graph_inherit(tyn_graph *g, heritage *old, bool only_histories)
{
    for (int any = 0; any < 2; any++) {
        for (uint32_t i = 0; i < g->num_resources; i++) {
            const resource *r = &g->resources[i];
            phys *p = &g->phys[i];
            const uint64_t identity = graph_identity(g, r);
            if (!p->kept && (any || r->kind != RESOURCE_HISTORY)) {
                inherit(old, only_histories, identity, any ? 0 : r->content, p);
            }
        }
    }
}

bool graph_heap_used(const tyn_graph *g, uint64_t age)
{
    bool used = false;
    for (uint32_t i = 0; i < g->num_phys; i++) {
        used |= !g->phys[i].shared && g->phys[i].age == age;
    }
    return used;
}

void graph_retire_aged(tyn_graph *g, bool all)
{
    uint32_t left = 0;
    for (uint32_t a = 0; a < g->num_aged; a++) {
        if (!all && graph_heap_used(g, g->aged[a].age)) {
            g->aged[left++] = g->aged[a];
        } else {
            graph_retire_heap(g, &g->aged[a].heap, g->aged[a].made);
        }
    }
    g->num_aged = left;
    if (!left) {
        free(g->aged);
        g->aged = NULL;
    }
}

bool graph_is_wasteful(const tyn_graph *g)
{
    const VkDeviceSize need = g->persistent_bytes + g->transient_bytes;
    VkDeviceSize total = g->heap.total;
    for (uint32_t b = 0; b < g->num_blocks; b++) {
        total += g->blocks[b].size;
    }
    for (uint32_t a = 0; a < g->num_aged; a++) {
        total += g->aged[a].heap.total;
    }
    return total > need + need / 2 + HEAP_SLACK;
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
void graph_inherit_run(const tyn_graph *g, uint32_t index, node_run *run)
{
    run->hash = g->nodes[index].hash;
    for (uint32_t i = 0; i < g->num_runs; i++) {
        if (g->runs[i].hash == run->hash) {
            *run = g->runs[i];
            return;
        }
    }
}
