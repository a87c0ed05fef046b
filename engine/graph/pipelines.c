// pipelines.c -- pipelines of a declaration: made at once, or beside the frames, which leave the host's images alone meanwhile.
#include "graph/internal.h"
#include "base/grow.h"
#include <stdlib.h>

tyn_result graph_want_pipeline(tyn_graph *g, tyn_variant *v)
{
    pipeline_list *list = &g->wanted;
    for (uint32_t i = 0; i < list->count; i++) {
        if (list->items[i] == v) {
            return TYN_OK;
        }
    }
    if (!tyn_grow(&list->items, &list->cap, list->count + 1, sizeof *list->items)) {
        return TYN_ERR_MEMORY;
    }
    tyn_variant_want(v);
    list->items[list->count++] = v;
    return TYN_OK;
}

static void let_go(pipeline_list *list)
{
    for (uint32_t i = 0; i < list->count; i++) {
        tyn_variant_let_go(list->items[i]);
    }
    free(list->items);
    *list = (pipeline_list){0};
}

void graph_forget_pipelines(tyn_graph *g)
{
    let_go(&g->wanted);
}

tyn_result graph_make_pipelines(tyn_graph *g)
{
    pipeline_list before = g->wanted; // let go of after those that are still wanted
    g->wanted = (pipeline_list){0};
    tyn_result result = recorder_run_all(&(tyn_recorder){.g = g, .mode = RECORD_PIPELINES}, NULL);
    let_go(&before);
    for (uint32_t i = 0; result == TYN_OK && i < g->wanted.count; i++) {
        tyn_variant *v = g->wanted.items[i];
        const tyn_result made = g->mode.background ? tyn_variant_request(v) : tyn_variant_make(v);
        result = made == TYN_PENDING ? TYN_OK : made;
    }
    if (result == TYN_OK && tyn_graph_pending(g)) {
        return TYN_PENDING;
    }
    graph_forget_pipelines(g);
    return result;
}

uint32_t tyn_graph_pending(const tyn_graph *g)
{
    return tyn_variants_pending(g->wanted.items, g->wanted.count);
}

tyn_result graph_postpone(tyn_graph *g, VkCommandBuffer cmd)
{
    tyn_result result = g->mode.background ? graph_make_pipelines(g) : TYN_OK;
    if (result < 0) {
        return result;
    }
    for (uint32_t i = 0; i < g->num_resources; i++) {
        const resource *r = &g->resources[i];
        const tyn_image *image = &r->image;
        if (r->kind != RESOURCE_IMPORT) {
            continue;
        }
        const VkImageMemoryBarrier2 barrier = graph_image_barrier(
            r, image->image,
            &(tyn_barrier){image->before.stages, image->after.stages, image->before.access,
                           image->after.access, image->before.layout, image->after.layout});
        g->dev->vk.CmdPipelineBarrier2(
            cmd, &(VkDependencyInfo){.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                     .imageMemoryBarrierCount = 1,
                                     .pImageMemoryBarriers = &barrier});
    }
    return TYN_PENDING;
}
