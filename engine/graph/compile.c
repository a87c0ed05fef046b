// compile.c -- makes what was declared, and keeps of what was compiled before what is the same.
#include "graph/internal.h"
#include <stdlib.h>

// At most so many things of a resource are retired.
enum { PHYS_PARTS = MAX_MIPS + NUM_TEXEL_FORMATS + 6 };

static bool reserve_all(tyn_graph *g)
{
    return graph_retire_reserve(g, (g->num_phys + g->num_resources + NUM_DUMMIES) * PHYS_PARTS +
                                       2 * MAX_SLOTS + g->num_aged + g->num_blocks + 4);
}

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

void graph_finish(tyn_graph *g)
{
    graph_release(g);
    graph_free_all_aged(g);
    graph_retire_blocks(g, true);
    const uint64_t made = g->dummy[TYN_BUFFER].made;
    for (int d = 0; d < NUM_DUMMIES; d++) {
        graph_destroy_phys(g, &g->dummy[d]);
    }
    graph_retire_heap(g, &g->dummy_heap, made);
    for (uint32_t i = 0; i < g->num_slots; i++) {
        graph_destroy_slot(g, &g->slots[i]);
    }
}

// Gives up what the new arrangement has no use for, before it allocates.
static tyn_result give_up(tyn_graph *g, bool only_histories, heritage *old)
{
    *old = graph_take_heritage(g, only_histories);
    graph_release(g);
    if (only_histories) {
        graph_free_all_aged(g);
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
        g->num_phys = g->phys ? g->num_phys : 0;
        return graph_fail(g, TYN_ERR_MEMORY, "out of memory");
    }
    return TYN_OK;
}

static tyn_result make_anew(tyn_graph *g, heritage *old, survey *s)
{
    for (uint32_t i = 0; i < g->num_outputs; i++) {
        if (g->outputs[i].readback) {
            phys *p = &g->phys[g->outputs[i].ref.resource - 1];
            p->image_usage |= VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
            p->buffer_usage |= VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
        }
    }
    const tyn_result result = graph_survey(g, s, g->phys);
    return result == TYN_OK ? graph_create_resources(g, old) : result;
}

tyn_result graph_arrange(tyn_graph *g, arrangement how, survey *s)
{
    if (!reserve_all(g)) {
        return graph_fail(g, TYN_ERR_MEMORY, "out of memory");
    }
    graph_free_staging(g);
    if (how == ARRANGE_UPLOADS) {
        return graph_create_staging(g);
    }
    heritage old;
    tyn_result result = give_up(g, how == ARRANGE_ANEW, &old);
    result = result == TYN_OK ? make_anew(g, &old, s) : result;
    graph_drop_heritage(g, &old);
    graph_retire_blocks(g, false);
    result = result == TYN_OK ? graph_create_dummies(g) : result;
    return result == TYN_OK ? graph_create_staging(g) : result;
}

static tyn_result compile_new(tyn_graph *g, arrangement how)
{
    survey s;
    node_run *before = g->runs;
    const uint32_t num_before = g->num_runs;
    g->runs = NULL;
    tyn_result result = graph_arrange(g, how, &s);
    result = result == TYN_OK ? graph_create_slots(g, &s) : result;
    result = result == TYN_OK ? graph_reserve_sets(g, s.sets) : result;
    for (uint32_t i = 0; result == TYN_OK && i < g->num_nodes; i++) {
        if (graph_is_done(g, i)) {
            graph_inherit_run(g, i, before, num_before);
        }
    }
    free(before);
    if (result != TYN_OK) {
        graph_finish(g);
        return result;
    }
    graph_fill_staging(g);
    g->structure = graph_structure(g, &s);
    g->current = true;
    return TYN_OK;
}

// Nothing but the content of uploads has changed.
static tyn_result stage_uploads(tyn_graph *g)
{
    survey s;
    arrangement how = ARRANGE_UPLOADS;
    tyn_result result = graph_keep_to_budget(g, &how);
    result = result == TYN_OK ? graph_arrange(g, how, &s) : result;
    if (result == TYN_OK) {
        graph_fill_staging(g);
    }
    g->current = result == TYN_OK;
    return result;
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
    graph_retire_over(g);
    if (graph_same_structure(g)) {
        return stage_uploads(g);
    }
    g->current = false;
    tyn_result result = graph_make_pipelines(g);
    if (result != TYN_OK) {
        return result;
    }
    arrangement how = ARRANGE_KEEPING;
    result = graph_keep_to_budget(g, &how);
    if (result != TYN_OK) {
        return result;
    }
    const bool first = !g->num_phys;
    result = compile_new(g, how);
    const bool again = result == TYN_OK ? graph_is_wasteful(g) && g->num_aged
                                        : result == TYN_ERR_MEMORY && g->status == TYN_OK && !first;
    if (again && graph_fits_budget(g, ARRANGE_ANEW)) {
        result = compile_new(g, ARRANGE_ANEW);
    }
    return say_what_waits(g, result);
}
