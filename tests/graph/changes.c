// changes.c -- change tracking of random graphs: after every frame the outputs must be what a graph that
// runs everything would have made, however little was run.
//
// A resource's content is a number here. A node that runs mixes its value and the numbers of its
// inputs into its outputs, so a node that was left out wrongly, or that saw the wrong version of a
// resource that is changed in place, shows in the outputs. So does one whose memory another node has used: most
// nodes have scratch, and what lies in the place of what a node writes is lost.
#include "fake_vulkan.h"
#include "graph/internal.h"
#include <tyndall/extend/hash.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <cmocka.h>

enum { MAX_NODES = 10, MAX_RESOURCES = 32, NUM_UPLOADS = 3 };

static uint64_t content[MAX_RESOURCES]; // by resource, as the device has it
static uint32_t runs, overlaps;

static uint64_t mix(uint64_t value, uint64_t a, uint64_t b)
{
    return tyn_hash_u64(tyn_hash_u64(tyn_hash_u64(TYN_HASH_SEED, value), a), b);
}

// ---- passes -----------------------------------------------------------------------------------

typedef struct node_params {
    uint32_t value, made, scratch; // bytes
} node_params;

enum { MAKE_A, MAKE_B, MAKE_OUT, MAKE_SCRATCH };
static const tyn_port make_ports[] = {{"a", TYN_IN, TYN_BUFFER, 0, false, "read"},
                                      {"b", TYN_IN, TYN_BUFFER, 0, true, "read"},
                                      {"out", TYN_OUT, TYN_BUFFER, 0, false, "made"},
                                      {"scratch", TYN_SCRATCH, TYN_BUFFER, 0, false, "private"}};
enum { CHANGE_IT, CHANGE_A };
static const tyn_port change_ports[] = {{"it", TYN_INOUT, TYN_BUFFER, 0, false, "changed in place"},
                                        {"a", TYN_IN, TYN_BUFFER, 0, false, "read"}};

static tyn_result make_declare(tyn_builder *b, const void *params)
{
    const node_params *p = params;
    tyn_build_buffer(b, MAKE_OUT, p->made);
    if (p->scratch) {
        tyn_build_buffer(b, MAKE_SCRATCH, p->scratch);
    }
    return TYN_OK;
}

static tyn_result change_declare(tyn_builder *b, const void *params)
{
    (void)b, (void)params;
    return TYN_OK;
}

static uint64_t read_content(const tyn_recorder *r, uint8_t port)
{
    uint32_t res = r->g->nodes[r->node].res[port];
    return res ? content[res - 1] : 0;
}

// Others in the same place are lost.
static void use(const tyn_recorder *r, uint8_t port)
{
    const uint32_t res = r->g->nodes[r->node].res[port];
    for (uint32_t i = 0; res && i < r->g->num_resources; i++) {
        if (i != res - 1 && graph_overlap(&r->g->phys[i], &r->g->phys[res - 1])) {
            content[i] = 0xdead;
            overlaps++;
        }
    }
}

static void make_record(tyn_recorder *r, const void *params)
{
    if (r->mode == RECORD_LIVE) {
        use(r, MAKE_OUT);
        use(r, MAKE_SCRATCH);
        const node_params *p = params;
        content[r->g->nodes[r->node].res[MAKE_OUT] - 1] =
            mix(p->value, read_content(r, MAKE_A), read_content(r, MAKE_B));
        runs++;
    }
}

static void change_record(tyn_recorder *r, const void *params)
{
    if (r->mode == RECORD_LIVE) {
        const node_params *p = params;
        content[r->g->nodes[r->node].res[CHANGE_IT] - 1] =
            mix(p->value, read_content(r, CHANGE_IT), read_content(r, CHANGE_A));
        runs++;
    }
}

static const tyn_pass_desc make = {.name = "make",
                                   .summary = "makes",
                                   .ports = make_ports,
                                   .num_ports = 4,
                                   .params_size = sizeof(node_params),
                                   .declare = make_declare,
                                   .record = make_record};
static const tyn_pass_desc change = {.name = "change",
                                     .summary = "changes",
                                     .ports = change_ports,
                                     .num_ports = 2,
                                     .params_size = sizeof(node_params),
                                     .declare = change_declare,
                                     .record = change_record};

// ---- random graphs ----------------------------------------------------------------------------

typedef struct plan_node {
    bool changes;
    uint32_t inputs[2]; // slots
    uint32_t value, made, scratch;
} plan_node;

// Slots hold the newest handle of a buffer: uploads first, then one per making node. A changing node
// changes the slot inputs[0], which is never an upload.
typedef struct plan_graph {
    plan_node nodes[MAX_NODES];
    uint32_t num_nodes;
    uint64_t uploads[NUM_UPLOADS];
    bool wanted[MAX_NODES + NUM_UPLOADS]; // by slot
} plan_graph;

static uint32_t below(uint32_t n)
{
    return (uint32_t)rand() % n;
}

static plan_graph random_graph(void)
{
    plan_graph p = {.num_nodes = 3 + below(MAX_NODES - 3)};
    uint32_t slots = NUM_UPLOADS;
    for (uint32_t i = 0; i < p.num_nodes; i++) {
        plan_node *n = &p.nodes[i];
        n->value = below(1000);
        n->made = below(3) ? 4 + below(400 << 10) : 64; // small ones have memory of their own
        n->scratch = below(4) ? below(400 << 10) : 0;
        n->changes = slots > NUM_UPLOADS && below(3) == 0;
        n->inputs[0] = n->changes ? NUM_UPLOADS + below(slots - NUM_UPLOADS) : below(slots);
        do {
            n->inputs[1] = below(slots);
        } while (n->changes && n->inputs[1] == n->inputs[0]);
        if (!n->changes) {
            p.wanted[slots++] = below(3) == 0;
        }
    }
    p.wanted[slots - 1] = true;
    for (int i = 0; i < NUM_UPLOADS; i++) {
        p.uploads[i] = 1 + below(1000);
    }
    return p;
}

// Declares it; `expected` by slot: what running everything would give.
static void declare_graph(tyn_graph *g, const plan_graph *p, tyn_ref *slots, uint64_t *expected)
{
    static const uint8_t bytes[16];
    uint32_t num = NUM_UPLOADS;
    tyn_graph_begin(g);
    for (uint32_t i = 0; i < NUM_UPLOADS; i++) {
        slots[i] = tyn_graph_upload_buffer(g, "upload", bytes, sizeof bytes, p->uploads[i]);
        expected[i] = content[slots[i].resource - 1] = p->uploads[i];
    }
    for (uint32_t i = 0; i < p->num_nodes; i++) {
        const plan_node *n = &p->nodes[i];
        node_params params = {n->value, n->made, n->scratch};
        tyn_ref refs[4] = {slots[n->inputs[0]], slots[n->inputs[1]]};
        uint64_t made = mix(n->value, expected[n->inputs[0]], expected[n->inputs[1]]);
        assert_int_equal(tyn_graph_add(g, n->changes ? &change : &make, &params, refs), TYN_OK);
        if (n->changes) {
            slots[n->inputs[0]] = refs[CHANGE_IT];
            expected[n->inputs[0]] = made;
        } else {
            slots[num] = refs[MAKE_OUT];
            expected[num++] = made;
        }
    }
    for (uint32_t i = NUM_UPLOADS; i < num; i++) {
        if (p->wanted[i]) {
            tyn_graph_output(g, "out", slots[i], false);
        }
    }
}

static void frame(tyn_graph *g, const plan_graph *p, int seed, int number)
{
    tyn_ref slots[MAX_NODES + NUM_UPLOADS];
    uint64_t expected[MAX_NODES + NUM_UPLOADS];
    declare_graph(g, p, slots, expected);
    if (!tyn_graph_matches(g)) {
        assert_int_equal(tyn_graph_compile(g), TYN_OK);
    }
    runs = 0;
    assert_int_equal(tyn_graph_record(g, VK_NULL_HANDLE), TYN_OK);
    for (uint32_t i = NUM_UPLOADS; i < MAX_NODES + NUM_UPLOADS; i++) {
        if (p->wanted[i] && content[slots[i].resource - 1] != expected[i]) {
            char *dump = tyn_graph_dump(g, false, NULL);
            print_message("%s", dump);
            free(dump);
            fail_msg("graph %d, frame %d: output of slot %u is not what it should be", seed, number,
                     i);
        }
    }
}

static void random_changes(void **state)
{
    (void)state;
    uint32_t all = 0, ran = 0;
    for (int seed = 0; seed < 3000; seed++) {
        srand((unsigned)seed);
        fake_vulkan *fake = fake_create();
        tyn_graph *g;
        assert_int_equal(tyn_graph_create(&fake->dev, 2, &g), TYN_OK);
        plan_graph p = random_graph();
        for (int number = 0; number < 12; number++) {
            frame(g, &p, seed, number);
            all += p.num_nodes;
            ran += runs;
            if (below(4)) { // else nothing changes
                if (below(3)) {
                    p.nodes[below(p.num_nodes)].value = below(1000);
                } else {
                    p.uploads[below(NUM_UPLOADS)] = 1 + below(1000);
                }
            }
            if (below(8) == 0) { // another node is wanted: another structure
                p.wanted[NUM_UPLOADS] = !p.wanted[NUM_UPLOADS];
            }
        }
        tyn_graph_destroy(&g);
        fake_destroy(&fake);
    }
    print_message("%u of %u nodes ran, %u times in the place of others\n", ran, all, overlaps);
    assert_true(overlaps > all / 20);
    assert_true(ran < all * 6 / 10); // it must still be worth something
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(random_changes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
