// budget.c -- a compilation is refused, before it asks for memory, if that would pass the budget.
#include "graph/internal.h"
#include <stdio.h>

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

bool graph_fits_budget(const tyn_graph *g, const draft *d)
{
    return !g->budget || graph_draft_bytes(g, d) <= g->budget;
}

tyn_result graph_draft_in_budget(tyn_graph *g, arrangement how, draft *d)
{
    VkDeviceSize least = UINT64_MAX;
    for (;;) {
        const tyn_result result = graph_draft(g, how, d);
        if (result != TYN_OK || graph_fits_budget(g, d)) {
            return result;
        }
        const VkDeviceSize bytes = graph_draft_bytes(g, d);
        least = bytes < least ? bytes : least;
        graph_undo(g, d);
        if (how != ARRANGE_KEEPING || !g->num_phys) {
            return refuse(g, least);
        }
        how = ARRANGE_ANEW;
    }
}

void tyn_graph_budget(tyn_graph *g, uint64_t bytes)
{
    g->budget = bytes;
}
