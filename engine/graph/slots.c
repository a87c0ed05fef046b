// slots.c -- pools of descriptor sets and timestamps, one set of them per frame in flight.
#include "graph/internal.h"
#include <stdlib.h>

void graph_destroy_slot(tyn_graph *g, frame_slot *slot)
{
    graph_retire(g, VK_OBJECT_TYPE_DESCRIPTOR_POOL, (uint64_t)slot->pool, slot->made);
    graph_retire(g, VK_OBJECT_TYPE_QUERY_POOL, (uint64_t)slot->queries, slot->made);
    free(slot->timed);
    *slot = (frame_slot){0};
}

static tyn_result create_pools(tyn_graph *g, frame_slot *slot)
{
    const survey *room = &g->room;
    const VkDescriptorPoolSize sizes[] = {
        {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, room->uniform_buffers},
        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, room->storage_buffers},
        {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, room->texel_buffers},
        {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, room->storage_images},
        {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, room->sampled_images},
    };
    tyn_device *dev = g->dev;
    slot->made = g->frame;
    tyn_result result = tyn_vk_check(
        dev,
        TYN_VK_MADE(&slot->pool, dev->vk.CreateDescriptorPool(
                                     dev->device,
                                     &(VkDescriptorPoolCreateInfo){
                                         .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                         .maxSets = room->sets,
                                         .poolSizeCount = sizeof sizes / sizeof sizes[0],
                                         .pPoolSizes = sizes},
                                     NULL, &slot->pool)),
        "vkCreateDescriptorPool");
    if (result == TYN_OK && dev->timestamp_bits) {
        result = tyn_vk_check(
            dev,
            TYN_VK_MADE(&slot->queries, dev->vk.CreateQueryPool(
                                            dev->device,
                                            &(VkQueryPoolCreateInfo){
                                                .sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                                .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                                .queryCount = g->num_timed * 2},
                                            NULL, &slot->queries)),
            "vkCreateQueryPool");
    }
    return result;
}

static bool have_room(const tyn_graph *g, const survey *s)
{
    const survey *room = &g->room;
    // A former compilation may have failed between slots.
    for (uint32_t i = 0; i < g->num_slots; i++) {
        if (!g->slots[i].pool || (g->dev->timestamp_bits && !g->slots[i].queries)) {
            return false;
        }
    }
    return s->sets <= room->sets && s->uniform_buffers <= room->uniform_buffers &&
           s->storage_buffers <= room->storage_buffers && s->texel_buffers <= room->texel_buffers &&
           s->storage_images <= room->storage_images && s->sampled_images <= room->sampled_images &&
           g->num_nodes <= g->num_timed;
}

// A fourth more than is wanted, so that a compilation that wants a little more finds it.
static uint32_t roomy(uint32_t count)
{
    return count + count / 4 + 1;
}

// Pools of a compilation before serve again where they have room.
tyn_result graph_create_slots(tyn_graph *g, const survey *s)
{
    const bool keep = have_room(g, s);
    if (!keep) {
        g->room = (survey){.sets = roomy(s->sets),
                           .uniform_buffers = roomy(s->uniform_buffers),
                           .storage_buffers = roomy(s->storage_buffers),
                           .texel_buffers = roomy(s->texel_buffers),
                           .storage_images = roomy(s->storage_images),
                           .sampled_images = roomy(s->sampled_images)};
        g->num_timed = roomy(g->num_nodes);
    }
    tyn_result result = TYN_OK;
    for (uint32_t i = 0; result == TYN_OK && i < g->num_slots; i++) {
        frame_slot *slot = &g->slots[i];
        if (!keep) {
            graph_destroy_slot(g, slot);
            result = create_pools(g, slot);
        }
        free(slot->timed);
        slot->timed = calloc(g->num_timed, 1);
        slot->pending = false;
        result = result == TYN_OK && !slot->timed ? TYN_ERR_MEMORY : result;
    }
    return result;
}

tyn_result graph_reserve_sets(tyn_graph *g, uint32_t count)
{
    if (count > g->sets.cap) {
        void *grown = realloc(g->sets.items, count * sizeof *g->sets.items);
        if (!grown) {
            return graph_fail(g, TYN_ERR_MEMORY, "out of memory");
        }
        g->sets.items = grown;
        g->sets.cap = count;
    }
    return TYN_OK;
}
