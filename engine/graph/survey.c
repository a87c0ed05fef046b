// survey.c -- which nodes are needed, and what the structure of a declaration is: a dry run of its dispatches.
#include "graph/internal.h"
#include <tyndall/extend/hash.h>

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
            need_writers(g, graph_port(n, p, DIR_READ), n->versions[p]);
        }
    }
}

tyn_result graph_survey(tyn_graph *g, survey *s, phys *usage)
{
    *s = (survey){.hash = TYN_HASH_SEED};
    return recorder_run_all(
        &(tyn_recorder){.g = g, .mode = RECORD_SURVEY, .survey = s, .usage = usage}, NULL);
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

bool graph_same_structure(tyn_graph *g)
{
    survey s;
    graph_cull(g);
    return g->structure && graph_survey(g, &s, NULL) == TYN_OK &&
           graph_structure(g, &s) == g->structure;
}
