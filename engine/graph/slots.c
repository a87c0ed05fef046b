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
    VkDescriptorPoolSize sizes[NUM_DESCRIPTORS];
    for (uint32_t i = 0; i < NUM_DESCRIPTORS; i++) { // there is room for one of each at least
        sizes[i] = (VkDescriptorPoolSize){(VkDescriptorType)i, room->descriptors[i]};
    }
    tyn_device *dev = g->dev;
    slot->made = g->frame;
    tyn_result result = tyn_vk_check(
        dev,
        TYN_VK_MADE(&slot->pool, dev->vk.CreateDescriptorPool(
                                     dev->device,
                                     &(VkDescriptorPoolCreateInfo){
                                         .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                         .maxSets = room->sets,
                                         .poolSizeCount = NUM_DESCRIPTORS,
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
    bool room_for_all = s->sets <= room->sets && g->num_nodes <= g->num_timed;
    for (uint32_t i = 0; i < NUM_DESCRIPTORS; i++) {
        room_for_all = room_for_all && s->descriptors[i] <= room->descriptors[i];
    }
    return room_for_all;
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
        g->room.sets = roomy(s->sets);
        for (uint32_t i = 0; i < NUM_DESCRIPTORS; i++) {
            g->room.descriptors[i] = roomy(s->descriptors[i]);
        }
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
        slot->frame_ms = 0;
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
