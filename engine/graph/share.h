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
    uint64_t size;  // what the items need; of a block that is there, what it has
    uint64_t align; // that one that is there begins at
    uint32_t type;
} tyn_share_block;

// May both be in the same place? `follows`[a * num_nodes + b]: node a reads something of b, at first or second hand.
bool tyn_share_apart(const tyn_share_item *a, const tyn_share_item *b, const bool *follows,
                     uint32_t num_nodes);

// Items and blocks of which the first are there already, and stay as they are.
typedef struct tyn_share_list {
    tyn_share_item *items;
    uint32_t count, placed;
    tyn_share_block *blocks; // room for one more per item that is to be placed
    uint32_t num_blocks;
    uint32_t *order; // scratch: one per item
} tyn_share_list;

// Places the items into as few bytes as it finds: where there is room in blocks that are there, else in new ones of at most
// `most` bytes unless one item is larger.
void tyn_share_plan(tyn_share_list *list, const bool *follows, uint32_t num_nodes, uint64_t most);
