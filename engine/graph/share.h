// share.h -- which resources lie in the same memory, and where. Pure functions over small structs, tested without a
// GPU.
//
// What a node keeps for itself while it runs may lie where others keep theirs, and where a later node puts what it
// makes, if that runs whenever the former does: it reads something of it, at first or second hand. What nodes
// make stays until the next frame, and never shares memory with what another makes.
#pragma once
#include <stdbool.h>
#include <stdint.h>

typedef struct tyn_share_item {
    uint64_t size, align;
    uint32_t type;   // of memory: only equal ones share blocks
    uint32_t node;   // that makes it
    bool kept;       // for other nodes; else it is scratch
    bool unused;     // by all of them
    uint32_t block;  // results
    uint64_t offset; // in the block
} tyn_share_item;

typedef struct tyn_share_block {
    uint64_t size; // what the items need
    uint32_t type;
} tyn_share_block;

// May both be in the same place? `follows`[a * num_nodes + b]: node a reads something of b, at first or second hand.
bool tyn_share_apart(const tyn_share_item *a, const tyn_share_item *b, const bool *follows,
                     uint32_t num_nodes);

// Places the items into as few bytes as it finds, in blocks of at most `most` bytes unless one item is larger. `blocks`
// has room for one per item; their number is returned. `order` is scratch: one per item.
uint32_t tyn_share_plan(tyn_share_item *items, uint32_t count, const bool *follows,
                        uint32_t num_nodes, uint64_t most, tyn_share_block *blocks,
                        uint32_t *order);
