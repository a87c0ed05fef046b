// share.c -- see share.h: first fit, the largest first.
#include "graph/share.h"

bool tyn_share_apart(const tyn_share_item *a, const tyn_share_item *b, const bool *follows,
                     uint32_t num_nodes)
{
    if (a->unused || b->unused) {
        return true;
    }
    if (a->kept == b->kept) {
        return !a->kept && a->node != b->node;
    }
    const tyn_share_item *kept = a->kept ? a : b, *scratch = a->kept ? b : a;
    return follows[kept->node * num_nodes + scratch->node];
}

static uint64_t align_up(uint64_t x, uint64_t align)
{
    return align > 1 ? (x + align - 1) / align * align : x;
}

// The lowest place in the block where the item meets none of the first `placed` that it may not.
static uint64_t lowest(const tyn_share_item *items, const uint32_t *order, uint32_t placed,
                       const tyn_share_item *item, uint32_t block, const bool *follows,
                       uint32_t num_nodes)
{
    uint64_t at = 0;
    for (uint32_t i = 0; i < placed; i++) { // after a move all are looked at again
        const tyn_share_item *other = &items[order[i]];
        if (other->block == block && at < other->offset + other->size &&
            other->offset < at + item->size && !tyn_share_apart(item, other, follows, num_nodes)) {
            at = align_up(other->offset + other->size, item->align);
            i = UINT32_MAX;
        }
    }
    return at;
}

// Those that are there, then the others by their size.
static void sort_by_size(const tyn_share_list *list)
{
    uint32_t *order = list->order;
    for (uint32_t i = 0; i < list->count; i++) {
        uint32_t at = i;
        for (; at > list->placed && list->items[order[at - 1]].size < list->items[i].size; at--) {
            order[at] = order[at - 1];
        }
        order[at] = i;
    }
}

void tyn_share_plan(tyn_share_list *list, const bool *follows, uint32_t num_nodes, uint64_t most)
{
    tyn_share_block *blocks = list->blocks;
    const uint32_t there = list->num_blocks;
    sort_by_size(list);
    for (uint32_t i = list->placed; i < list->count; i++) {
        tyn_share_item *item = &list->items[list->order[i]];
        uint32_t b = 0;
        uint64_t at = 0;
        for (; b < list->num_blocks; b++) {
            const uint64_t room = b < there || blocks[b].size > most ? blocks[b].size : most;
            if (blocks[b].type != item->type || (b < there && blocks[b].align < item->align)) {
                continue;
            }
            at = lowest(list->items, list->order, i, item, b, follows, num_nodes);
            if (at + item->size <= room) {
                break;
            }
        }
        if (b == list->num_blocks) {
            blocks[list->num_blocks++] = (tyn_share_block){.type = item->type};
            at = 0;
        }
        item->block = b;
        item->offset = at;
        if (blocks[b].size < at + item->size) {
            blocks[b].size = at + item->size;
        }
    }
}
