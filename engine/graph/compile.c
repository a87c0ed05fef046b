// compile.c -- makes what was declared, and keeps of what was compiled before what is the same.
#include "graph/internal.h"
#include <stdlib.h>

bool tyn_graph_matches(const tyn_graph *graph)
{
    tyn_graph *g = (tyn_graph *)graph; // culling writes flags of the declaration only
    g->current = g->status == TYN_OK && graph_same_structure(g) && graph_uploads_staged(g);
    return g->current;
}

void tyn_graph_trim(tyn_graph *g)
{
    for (uint32_t i = 0; i < g->num_phys; i++) {
        if (g->phys[i].staged && g->phys[i].staged != g->phys[i].content) {
            return; // still to be copied
        }
    }
    if (g->staging_heap.num_blocks && graph_retire_reserve(g, g->num_phys + 1)) {
        graph_free_staging(g);
    }
    graph_retire_over(g);
}

void graph_finish(tyn_graph *g)
{
    graph_free_staging(g);
    for (uint32_t i = 0; i < g->num_phys; i++) {
        graph_destroy_phys(g, &g->phys[i]);
    }
    graph_retire_heap(g, &g->heap, g->heap_made);
    graph_retire_aged(g, true);
    graph_retire_blocks(g, true);
    for (uint32_t i = 0; i < g->num_slots; i++) {
        graph_destroy_slot(g, &g->slots[i]);
    }
    free(g->phys);
    free(g->runs);
    free(g->run_node);
    g->phys = NULL;
    g->num_phys = 0;
    g->runs = NULL;
    g->num_runs = 0;
    g->run_node = NULL;
    g->current = false;
    g->structure = 0;
}

// Runs of nodes whose results are kept go on.
static tyn_result renew_runs(tyn_graph *g)
{
    const size_t count = g->num_nodes ? g->num_nodes : 1;
    node_run *runs = calloc(count, sizeof *runs);
    bool *run_node = calloc(count, sizeof *run_node);
    if (!runs || !run_node) {
        free(runs);
        free(run_node);
        return graph_fail(g, TYN_ERR_MEMORY, "out of memory");
    }
    for (uint32_t i = 0; i < g->num_nodes; i++) {
        if (graph_is_done(g, i)) {
            graph_inherit_run(g, i, &runs[i]);
        }
    }
    free(g->runs);
    free(g->run_node);
    g->runs = runs;
    g->run_node = run_node;
    g->num_runs = g->num_nodes;
    return TYN_OK;
}

static tyn_result make(tyn_graph *g, draft *d)
{
    tyn_result result = graph_commit(g, d);
    if (d->how != ARRANGE_UPLOADS) {
        result = result == TYN_OK ? graph_create_slots(g, &d->survey) : result;
        result = result == TYN_OK ? graph_reserve_sets(g, d->survey.sets) : result;
        result = result == TYN_OK ? renew_runs(g) : result;
        g->structure = graph_structure(g, &d->survey);
    }
    if (result == TYN_OK) {
        graph_fill_staging(g);
    } else if (d->how == ARRANGE_UPLOADS) {
        graph_free_staging(g);
    } else {
        graph_finish(g);
    }
    g->current = result == TYN_OK;
    return result;
}

// All of it, in place of what failed or takes too much, if the budget allows.
static tyn_result make_anew(tyn_graph *g, tyn_result result)
{
    draft d;
    if (graph_draft(g, ARRANGE_ANEW, &d) != TYN_OK) {
        return result;
    }
    if (!graph_fits_budget(g, &d)) {
        graph_undo(g, &d);
        return result;
    }
    return make(g, &d);
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
    g->mode.idle = true; // nothing of what goes waits for frames
    graph_finish(g);
    graph_retire_over(g);
}

tyn_result tyn_graph_compile(tyn_graph *g)
{
    if (g->status != TYN_OK) {
        return g->status;
    }
    graph_retire_over(g);
    g->current = false;
    const bool same = graph_same_structure(g); // but for the content of uploads
    tyn_result result = same ? TYN_OK : graph_make_pipelines(g);
    draft d;
    result = result == TYN_OK
                 ? graph_draft_in_budget(g, same ? ARRANGE_UPLOADS : ARRANGE_KEEPING, &d)
                 : result;
    if (result != TYN_OK) {
        return result;
    }
    const bool first = !d.before.num_phys;
    result = make(g, &d);
    const bool again = result == TYN_OK ? graph_is_wasteful(g) && g->num_aged
                                        : result == TYN_ERR_MEMORY && g->status == TYN_OK && !first;
    return say_what_waits(g, again && !same ? make_anew(g, result) : result);
}
