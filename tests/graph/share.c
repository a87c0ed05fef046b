// share.c -- memory that resources share: nothing is where something else still is, and little is wasted.
#include "graph/share.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

enum { MOST_ITEMS = 40, MOST_NODES = 8 };

typedef struct plan {
    tyn_share_item items[MOST_ITEMS];
    tyn_share_block blocks[2 * MOST_ITEMS];
    bool follows[MOST_NODES * MOST_NODES];
    uint32_t order[MOST_ITEMS], count, num_nodes, num_blocks;
} plan;

// The first `placed` items stay where they are.
static uint64_t make_more(plan *p, uint32_t placed, uint64_t most)
{
    uint64_t bytes = 0;
    tyn_share_list list = {.items = p->items,
                           .count = p->count,
                           .placed = placed,
                           .blocks = p->blocks,
                           .num_blocks = placed ? p->num_blocks : 0,
                           .order = p->order};
    tyn_share_plan(&list, p->follows, p->num_nodes, most);
    p->num_blocks = list.num_blocks;
    for (uint32_t b = 0; b < p->num_blocks; b++) {
        bytes += p->blocks[b].size;
    }
    return bytes;
}

static uint64_t make(plan *p, uint64_t most)
{
    return make_more(p, 0, most);
}

// A chain of three nodes, each with scratch, that make something: scratch of all in one place, and under what comes
// later.
static void chain(void **state)
{
    (void)state;
    plan p = {.num_nodes = 3, .count = 6};
    for (uint32_t i = 0; i < 3; i++) {
        p.items[2 * i] = (tyn_share_item){.size = 100, .align = 1, .node = i, .kept = true};
        p.items[2 * i + 1] = (tyn_share_item){.size = 90, .align = 1, .node = i};
    }
    p.follows[1 * 3 + 0] = p.follows[2 * 3 + 1] = p.follows[2 * 3 + 0] = true;
    // The last one's scratch has a place of its own, which the others may use.
    assert_int_equal(make(&p, 1000), 390);
    assert_int_equal(p.num_blocks, 1);
    // Without anything that follows, scratch lies beside all that is kept.
    memset(p.follows, 0, sizeof p.follows);
    assert_int_equal(make(&p, 1000), 390);
    for (uint32_t i = 0; i < 3; i++) {
        assert_int_equal(p.items[2 * i + 1].offset, 300);
    }
    // With larger scratch it pays.
    p.follows[1 * 3 + 0] = p.follows[2 * 3 + 0] = true;
    p.items[1].size = 190;
    assert_int_equal(make(&p, 1000), 390);
    memset(p.follows, 0, sizeof p.follows);
    assert_int_equal(make(&p, 1000), 490);
    // What nobody needs takes nothing.
    p.items[1].unused = true;
    assert_int_equal(make(&p, 1000), 390);
}

static uint64_t below(uint64_t n)
{
    return (uint64_t)rand() % n;
}

// Nothing is where something else still is.
static void expect_apart(const plan *p, uint64_t most)
{
    for (uint32_t i = 0; i < p->count; i++) {
        const tyn_share_item *a = &p->items[i];
        assert_true(a->block < p->num_blocks && a->offset % a->align == 0);
        assert_int_equal(p->blocks[a->block].type, a->type);
        assert_true(a->offset + a->size <= p->blocks[a->block].size);
        assert_true(p->blocks[a->block].size <= most || p->blocks[a->block].size <= 5000);
        for (uint32_t j = 0; j < i; j++) {
            const tyn_share_item *b = &p->items[j];
            const bool meet = a->block == b->block && a->offset < b->offset + b->size &&
                              b->offset < a->offset + a->size;
            const bool may =
                a->unused || b->unused || (!a->kept && !b->kept && a->node != b->node) ||
                (a->kept && !b->kept && p->follows[a->node * p->num_nodes + b->node]) ||
                (b->kept && !a->kept && p->follows[b->node * p->num_nodes + a->node]);
            assert_true(!meet || may);
        }
    }
}

// Some are replaced by others, in the places that they left if there is room; those that stay do not move.
static void replace_some(plan *p, uint64_t most)
{
    uint32_t placed = 0;
    for (uint32_t i = 0; i < p->count; i++) {
        if (below(3)) {
            const tyn_share_item stays = p->items[i];
            p->items[i] = p->items[placed];
            p->items[placed++] = stays;
        }
    }
    for (uint32_t i = placed; i < p->count; i++) {
        p->items[i].size = 1 + below(5000);
        p->items[i].kept = below(2);
        p->items[i].node = (uint32_t)below(p->num_nodes);
    }
    const uint32_t there = p->num_blocks;
    tyn_share_block blocks[MOST_ITEMS];
    tyn_share_item items[MOST_ITEMS];
    for (uint32_t b = 0; b < there; b++) {
        p->blocks[b].align = 1u << 8;
    }
    memcpy(blocks, p->blocks, there * sizeof *blocks);
    memcpy(items, p->items, placed * sizeof *items);
    make_more(p, placed, most);
    if (placed) {
        assert_memory_equal(blocks, p->blocks, there * sizeof *blocks);
        assert_memory_equal(items, p->items, placed * sizeof *items);
    }
}

static void random_items(void **state)
{
    (void)state;
    uint64_t apart = 0, all = 0;
    for (int seed = 0; seed < 2000; seed++) {
        srand((unsigned)seed);
        plan p = {.num_nodes = 1 + (uint32_t)below(MOST_NODES),
                  .count = 1 + (uint32_t)below(MOST_ITEMS - 1)};
        for (uint32_t i = 0; i < p.count; i++) {
            p.items[i] = (tyn_share_item){.size = 1 + below(5000),
                                          .align = 1u << below(8),
                                          .type = below(6) == 0,
                                          .node = (uint32_t)below(p.num_nodes),
                                          .kept = below(2),
                                          .unused = below(10) == 0};
            apart += p.items[i].size;
        }
        for (uint32_t a = 0; a < p.num_nodes; a++) {
            for (uint32_t b = 0; b < a; b++) {
                p.follows[a * p.num_nodes + b] = below(2);
            }
        }
        const uint64_t most = 1000 + below(20000);
        all += make(&p, most);
        expect_apart(&p, most);
        replace_some(&p, most);
        expect_apart(&p, most);
    }
    print_message("%.3f of the memory that all would have apart\n", (double)all / (double)apart);
    assert_true(all < apart * 7 / 10);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(chain), cmocka_unit_test(random_items)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
