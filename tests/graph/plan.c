// plan.c -- the barrier planner: expected barriers as text, and random accesses against a model of the
// Vulkan memory model that knows nothing of how the planner works.
#include "graph/plan.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#define COMPUTE VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT
#define TRANSFER VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT
#define INDIRECT VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT
#define SHADERS (VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT)
#define COLOR_OUTPUT VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT
#define DEPTH_TESTS                                                                                \
    (VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT)
#define COLOR_READ VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT
#define COLOR_WRITE VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT
#define DEPTH_READ VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT
#define DEPTH_WRITE VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT
#define COLOR_ATTACHMENT VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL
#define DEPTH_ATTACHMENT VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL
#define GENERAL VK_IMAGE_LAYOUT_GENERAL
#define READ_ONLY VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL
#define TRANSFER_SRC VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL
#define TRANSFER_DST VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL

typedef struct named_access {
    const char *name;
    tyn_access access;
} named_access;

// Accesses by one word each; those of images in capitals.
static const named_access accesses[] = {
    {"read", {COMPUTE, VK_ACCESS_2_SHADER_STORAGE_READ_BIT, true, false, 0}},
    {"write", {COMPUTE, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, false, true, 0}},
    {"modify",
     {COMPUTE, VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, true,
      true, 0}},
    {"uniform", {COMPUTE, VK_ACCESS_2_UNIFORM_READ_BIT, true, false, 0}},
    {"indirect", {INDIRECT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT, true, false, 0}},
    {"copy", {TRANSFER, VK_ACCESS_2_TRANSFER_READ_BIT, true, false, 0}},
    {"fill", {TRANSFER, VK_ACCESS_2_TRANSFER_WRITE_BIT, false, true, 0}},
    {"pull", {SHADERS, VK_ACCESS_2_SHADER_STORAGE_READ_BIT, true, false, 0}}, // vertices
    {"READ", {COMPUTE, VK_ACCESS_2_SHADER_STORAGE_READ_BIT, true, false, GENERAL}},
    {"WRITE", {COMPUTE, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, false, true, GENERAL}},
    {"MODIFY",
     {COMPUTE, VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, true,
      true, GENERAL}},
    {"SAMPLE", {COMPUTE, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, true, false, READ_ONLY}},
    {"SAMPLE_GENERAL", {COMPUTE, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, true, false, GENERAL}},
    {"COPY", {TRANSFER, VK_ACCESS_2_TRANSFER_READ_BIT, true, false, TRANSFER_SRC}},
    {"UPLOAD", {TRANSFER, VK_ACCESS_2_TRANSFER_WRITE_BIT, false, true, TRANSFER_DST}},
    {"CLEAR", {TRANSFER, VK_ACCESS_2_TRANSFER_WRITE_BIT, false, true, GENERAL}},
    {"SAMPLE_DRAWING", {SHADERS, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, true, false, READ_ONLY}},
    {"DRAW", {COLOR_OUTPUT, COLOR_WRITE, false, true, COLOR_ATTACHMENT}},
    {"DRAW_OVER", {COLOR_OUTPUT, COLOR_READ | COLOR_WRITE, true, true, COLOR_ATTACHMENT}},
    {"DEPTH", {DEPTH_TESTS, DEPTH_READ | DEPTH_WRITE, false, true, DEPTH_ATTACHMENT}},
    {"DEPTH_OVER", {DEPTH_TESTS, DEPTH_READ | DEPTH_WRITE, true, true, DEPTH_ATTACHMENT}},
};
enum { NUM_ACCESSES = sizeof accesses / sizeof *accesses, NUM_BUFFER_ACCESSES = 8 };

static const named_access *find(const char *name)
{
    for (int i = 0; i < NUM_ACCESSES; i++) {
        if (strcmp(accesses[i].name, name) == 0) {
            return &accesses[i];
        }
    }
    fail_msg("no access '%s'", name);
    return NULL;
}

static void print_barrier(char *text, size_t size, const tyn_barrier *b)
{
    char src[64], dst[64], src_access[128], dst_access[128];
    tyn_print_stages(src, sizeof src, b->src_stages);
    tyn_print_stages(dst, sizeof dst, b->dst_stages);
    tyn_print_access(src_access, sizeof src_access, b->src_access);
    tyn_print_access(dst_access, sizeof dst_access, b->dst_access);
    int n = snprintf(text, size, "%s %s > %s %s", src, src_access, dst, dst_access);
    if (b->old_layout != b->new_layout) {
        snprintf(text + n, size - (size_t)n, ", %s > %s", tyn_layout_name(b->old_layout),
                 tyn_layout_name(b->new_layout));
    }
}

// ---- expected barriers ------------------------------------------------------------------------

// A row is one access and the barrier in front of it; NULL: none. `access` NULL starts a new resource.
static const struct {
    const char *access, *barrier;
} expected[] = {
    // Buffers. Nothing to wait for at first use.
    {"write", NULL},
    {"read", "COMPUTE STORAGE_WRITE > COMPUTE STORAGE_READ"},
    {"read", NULL}, // reads after a read that waited: nothing
    {"uniform", "COMPUTE STORAGE_WRITE > COMPUTE UNIFORM_READ"}, // another kind of read: visibility
    {"uniform", NULL},
    {"read", NULL},
    {"indirect", "COMPUTE STORAGE_WRITE > INDIRECT INDIRECT_READ"},
    {"write", "COMPUTE|INDIRECT NONE > COMPUTE NONE"}, // write after read: execution only
    {"write", "COMPUTE STORAGE_WRITE > COMPUTE STORAGE_WRITE"},
    {"modify", "COMPUTE STORAGE_WRITE > COMPUTE STORAGE_READ|STORAGE_WRITE"},
    {"modify", "COMPUTE STORAGE_WRITE > COMPUTE STORAGE_READ|STORAGE_WRITE"},
    {"read", "COMPUTE STORAGE_WRITE > COMPUTE STORAGE_READ"},
    {"modify", "COMPUTE STORAGE_WRITE > COMPUTE STORAGE_READ|STORAGE_WRITE"}, // full, always
    {NULL, NULL},
    // Fill, count, use as dispatch size, fill again.
    {"fill", NULL},
    {"modify", "TRANSFER TRANSFER_WRITE > COMPUTE STORAGE_READ|STORAGE_WRITE"},
    {"indirect", "COMPUTE STORAGE_WRITE > INDIRECT INDIRECT_READ"},
    {"copy", "COMPUTE STORAGE_WRITE > TRANSFER TRANSFER_READ"},
    {"fill", "TRANSFER|INDIRECT NONE > TRANSFER NONE"},
    {"fill", "TRANSFER TRANSFER_WRITE > TRANSFER TRANSFER_WRITE"},
    {NULL, NULL},
    // Reading what nobody wrote, then writing it.
    {"read", NULL},
    {"write", "COMPUTE NONE > COMPUTE NONE"},
    {NULL, NULL},
    // Images. The first use is a transition with nothing to wait for.
    {"WRITE", "NONE NONE > COMPUTE STORAGE_WRITE, UNDEFINED > GENERAL"},
    {"SAMPLE", "COMPUTE STORAGE_WRITE > COMPUTE SAMPLED_READ, GENERAL > READ_ONLY"},
    {"SAMPLE", NULL},
    {"WRITE", "COMPUTE NONE > COMPUTE STORAGE_WRITE, READ_ONLY > GENERAL"},
    {"COPY", "COMPUTE STORAGE_WRITE > TRANSFER TRANSFER_READ, GENERAL > TRANSFER_SRC"},
    // The transition waits for the copy that reads the old layout, too.
    {"SAMPLE", "TRANSFER NONE > COMPUTE SAMPLED_READ, TRANSFER_SRC > READ_ONLY"},
    {NULL, NULL},
    // Ping-pong inside a node stays in GENERAL: no transition after the first.
    {"WRITE", "NONE NONE > COMPUTE STORAGE_WRITE, UNDEFINED > GENERAL"},
    {"SAMPLE_GENERAL", "COMPUTE STORAGE_WRITE > COMPUTE SAMPLED_READ"},
    {"WRITE", "COMPUTE NONE > COMPUTE NONE"},
    {"SAMPLE_GENERAL", "COMPUTE STORAGE_WRITE > COMPUTE SAMPLED_READ"},
    {"READ", "COMPUTE STORAGE_WRITE > COMPUTE STORAGE_READ"},
    {"MODIFY", "COMPUTE STORAGE_WRITE > COMPUTE STORAGE_READ|STORAGE_WRITE"},
    {NULL, NULL},
    // An upload that two nodes sample, then a new upload.
    {"UPLOAD", "NONE NONE > TRANSFER TRANSFER_WRITE, UNDEFINED > TRANSFER_DST"},
    {"SAMPLE", "TRANSFER TRANSFER_WRITE > COMPUTE SAMPLED_READ, TRANSFER_DST > READ_ONLY"},
    {"SAMPLE", NULL},
    {"UPLOAD", "COMPUTE NONE > TRANSFER TRANSFER_WRITE, READ_ONLY > TRANSFER_DST"},
    {NULL, NULL},
    // Vertices that a dispatch made.
    {"write", NULL},
    {"pull", "COMPUTE STORAGE_WRITE > VERTEX|FRAGMENT STORAGE_READ"},
    {"pull", NULL},
    {"read", "COMPUTE STORAGE_WRITE > COMPUTE STORAGE_READ"},
    {"write", "COMPUTE|VERTEX|FRAGMENT NONE > COMPUTE NONE"},
    {NULL, NULL},
    // A picture: drawn, drawn over, sampled by compute and by a draw, drawn anew.
    {"DRAW", "NONE NONE > COLOR_OUTPUT COLOR_WRITE, UNDEFINED > COLOR_ATTACHMENT"},
    {"DRAW_OVER", "COLOR_OUTPUT COLOR_WRITE > COLOR_OUTPUT COLOR_READ|COLOR_WRITE"},
    {"SAMPLE", "COLOR_OUTPUT COLOR_WRITE > COMPUTE SAMPLED_READ, COLOR_ATTACHMENT > READ_ONLY"},
    {"SAMPLE_DRAWING", "COMPUTE NONE > VERTEX|FRAGMENT SAMPLED_READ"},
    {"DRAW", "COMPUTE|VERTEX|FRAGMENT NONE > COLOR_OUTPUT COLOR_WRITE, READ_ONLY > "
             "COLOR_ATTACHMENT"},
    {NULL, NULL},
    // A shadow map: the same with both fragment tests.
    {"DEPTH", "NONE NONE > EARLY_TESTS|LATE_TESTS DEPTH_READ|DEPTH_WRITE, UNDEFINED > "
              "DEPTH_ATTACHMENT"},
    {"DEPTH_OVER", "EARLY_TESTS|LATE_TESTS DEPTH_WRITE > EARLY_TESTS|LATE_TESTS "
                   "DEPTH_READ|DEPTH_WRITE"},
    {"SAMPLE", "EARLY_TESTS|LATE_TESTS DEPTH_WRITE > COMPUTE SAMPLED_READ, DEPTH_ATTACHMENT > "
               "READ_ONLY"},
    {"COPY", "COMPUTE NONE > TRANSFER TRANSFER_READ, READ_ONLY > TRANSFER_SRC"},
    {"DEPTH", "TRANSFER NONE > EARLY_TESTS|LATE_TESTS DEPTH_READ|DEPTH_WRITE, TRANSFER_SRC > "
              "DEPTH_ATTACHMENT"},
};

static void expected_barriers(void **state)
{
    (void)state;
    tyn_track track = {0};
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        if (!expected[i].access) {
            track = (tyn_track){0};
            continue;
        }
        tyn_barrier barrier;
        char text[512] = "(none)";
        if (tyn_plan(&track, find(expected[i].access)->access, &barrier)) {
            print_barrier(text, sizeof text, &barrier);
        }
        const char *wanted = expected[i].barrier ? expected[i].barrier : "(none)";
        if (strcmp(text, wanted) != 0) {
            fail_msg("row %zu, %s: got '%s', expected '%s'", i, expected[i].access, text, wanted);
        }
    }
}

static void joined_accesses(void **state)
{
    (void)state;
    tyn_access a = tyn_access_join(find("SAMPLE")->access, find("READ")->access);
    assert_int_equal(a.layout, GENERAL); // one image in one dispatch has one layout
    assert_true(a.read && !a.write);
    a = tyn_access_join(find("uniform")->access, find("write")->access);
    assert_true(a.read && a.write && a.layout == VK_IMAGE_LAYOUT_UNDEFINED);
    assert_true(a.access == (VK_ACCESS_2_UNIFORM_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT));
}

// ---- a model of Vulkan's rules ------------------------------------------------------------------
//
// Every access so far is an operation per stage. A barrier orders those in its first scope, directly or
// through earlier barriers, before whatever comes in its second scope; a write becomes available when
// a barrier names its stage and access, and from then on visible to the second scopes of barriers that
// it is ordered before. A layout transition is a write inside the barrier.

enum { MAX_OPS = 192, NUM_STAGES = 8, NUM_READS = 7 };
static const VkPipelineStageFlags2 stage_bits[NUM_STAGES] = {
    COMPUTE,
    TRANSFER,
    INDIRECT,
    VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT,
    VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
    COLOR_OUTPUT,
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT,
    VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
};
static const VkAccessFlags2 read_bits[NUM_READS] = {VK_ACCESS_2_SHADER_STORAGE_READ_BIT,
                                                    VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                                                    VK_ACCESS_2_UNIFORM_READ_BIT,
                                                    VK_ACCESS_2_TRANSFER_READ_BIT,
                                                    VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT,
                                                    COLOR_READ,
                                                    DEPTH_READ};
static const VkAccessFlags2 write_bits = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT |
                                         VK_ACCESS_2_TRANSFER_WRITE_BIT | COLOR_WRITE | DEPTH_WRITE;

typedef struct operation {
    VkPipelineStageFlags2 stage; // 0: a layout transition
    VkAccessFlags2 writes;
    bool write, available;
    VkPipelineStageFlags2 before;       // later work of these stages is ordered behind it
    VkAccessFlags2 visible[NUM_STAGES]; // reads that see the write, by stage
} operation;

typedef struct model {
    operation ops[MAX_OPS];
    int num;
    VkImageLayout layout;
} model;

static void apply_barrier(model *m, const tyn_barrier *barrier)
{
    tyn_barrier all = *barrier, *b = &all;
    b->src_stages |= b->src_stages & VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT ? UINT64_MAX : 0;
    b->src_access |= b->src_access & VK_ACCESS_2_MEMORY_WRITE_BIT ? write_bits : 0;
    for (int i = 0; i < m->num; i++) {
        operation *op = &m->ops[i];
        if (!((op->stage | op->before) & b->src_stages)) {
            continue;
        }
        op->before |= b->dst_stages;
        if (op->write && (op->stage & b->src_stages) && !(op->writes & ~b->src_access)) {
            op->available = true;
        }
        for (int s = 0; op->available && s < NUM_STAGES; s++) {
            op->visible[s] |= b->dst_stages & stage_bits[s] ? b->dst_access : 0;
        }
    }
    if (b->old_layout != b->new_layout) {
        operation transition = {.write = true, .available = true, .before = b->dst_stages};
        for (int s = 0; s < NUM_STAGES; s++) {
            transition.visible[s] = b->dst_stages & stage_bits[s] ? b->dst_access : 0;
        }
        m->ops[m->num++] = transition;
        m->layout = b->new_layout;
    }
}

// What is wrong with the access now, or NULL. A transition in its barrier must have been safe as well.
static const char *hazard(const model *m, const tyn_access *a)
{
    int last_write = -1;
    for (int i = 0; i < m->num; i++) {
        last_write = m->ops[i].write ? i : last_write;
    }
    for (int s = 0; s < NUM_STAGES; s++) {
        if (!(a->stages & stage_bits[s])) {
            continue;
        }
        for (int i = 0; i < m->num; i++) {
            const operation *op = &m->ops[i];
            bool ordered = (op->before & stage_bits[s]) != 0;
            if (op->write && !ordered) {
                return a->write ? "write after write without order"
                                : "read after write without order";
            }
            if (a->write && !ordered) {
                return "write after read without order";
            }
            if (a->write && op->write && !op->available) {
                return "write after write that is not available";
            }
        }
        for (int r = 0; a->read && last_write >= 0 && r < NUM_READS; r++) {
            bool wanted = (a->access & read_bits[r]) != 0;
            if (wanted && !(m->ops[last_write].visible[s] & read_bits[r])) {
                return "read of a write that is not visible";
            }
        }
    }
    return a->layout == m->layout ? NULL : "wrong layout";
}

static void apply_access(model *m, const tyn_access *a)
{
    for (int s = 0; s < NUM_STAGES; s++) {
        if (a->stages & stage_bits[s]) {
            m->ops[m->num++] = (operation){
                .stage = stage_bits[s], .write = a->write, .writes = a->access & write_bits};
        }
    }
}

// A transition rewrites the image: it must wait for everything before it.
static const char *transition_hazard(const model *m, const tyn_barrier *b)
{
    for (int i = 0; i < m->num && b->old_layout != b->new_layout; i++) {
        const operation *op = &m->ops[i];
        if (!((op->stage | op->before) & b->src_stages)) {
            return "transition without order";
        }
        if (op->write && !op->available && (op->writes & ~b->src_access)) {
            return "transition of a write that is not available";
        }
        if (b->old_layout != m->layout) {
            return "transition from a layout it is not in";
        }
    }
    return NULL;
}

// A barrier for all memory that another resource needed, as it is recorded.
static void pass_any(model *m, tyn_track *track, char *story)
{
    const named_access *n = &accesses[rand() % NUM_ACCESSES], *w = &accesses[rand() % NUM_ACCESSES];
    tyn_barrier all = {0};
    const tyn_barrier own = {.src_stages = w->access.stages,
                             .src_access = w->access.access & write_bits,
                             .dst_stages = n->access.stages,
                             .dst_access = rand() % 3 ? n->access.access : 0};
    tyn_barrier_join(&all, &own);
    if (rand() % 8 == 0) { // where others lay before a resource
        all.src_stages |= VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        all.src_access |= rand() % 2 ? VK_ACCESS_2_MEMORY_WRITE_BIT : 0;
    }
    if (rand() % 4) {
        tyn_barrier_widen(&all);
    }
    strcat(strcat(strcat(strcat(story, " ("), w->name), ">"), n->name);
    strcat(story, ")");
    apply_barrier(m, &all);
    tyn_track_barrier(track, &all);
}

// Each needs a barrier of its own, if it needs any, and makes use of those of others.
static void random_accesses(void **state)
{
    (void)state;
    int saved = 0;
    srand(20);
    for (int run = 0; run < 40000; run++) {
        bool image = run & 1;
        int first = image ? NUM_BUFFER_ACCESSES : 0;
        int choices = image ? NUM_ACCESSES - NUM_BUFFER_ACCESSES : NUM_BUFFER_ACCESSES;
        model m = {.num = 0};
        tyn_track track = {0};
        char story[2048] = "";
        for (int step = 0; step < 16; step++) {
            tyn_track alone = track;
            if (rand() % 3 == 0) {
                pass_any(&m, &track, story);
            }
            const named_access *n = &accesses[first + rand() % choices];
            tyn_access access = n->access;
            strcat(strcat(story, " "), n->name);
            if (rand() % 4 == 0) { // two bindings of one dispatch
                const named_access *other = &accesses[first + rand() % choices];
                access = tyn_access_join(access, other->access);
                strcat(strcat(story, "+"), other->name);
            }
            tyn_barrier barrier;
            const char *wrong = NULL;
            const bool needed = tyn_plan(&alone, access, &barrier);
            saved += needed;
            if (tyn_plan(&track, access, &barrier)) {
                saved--;
                wrong = transition_hazard(&m, &barrier);
                apply_barrier(&m, &barrier);
            }
            wrong = wrong ? wrong : hazard(&m, &access);
            if (wrong) {
                fail_msg("%s after:%s", wrong, story);
            }
            apply_access(&m, &access);
        }
    }
    print_message("%d of 640000 accesses need none of their own\n", saved);
    assert_true(saved > 1000);
}

// The model must see the faults it is there for.
static void model_finds_faults(void **state)
{
    (void)state;
    model m = {.num = 0};
    apply_access(&m, &find("write")->access);
    assert_string_equal(hazard(&m, &find("read")->access), "read after write without order");
    // Execution only is not enough for a read after a write,
    apply_barrier(&m, &(tyn_barrier){.src_stages = COMPUTE, .dst_stages = COMPUTE});
    assert_string_equal(hazard(&m, &find("read")->access), "read of a write that is not visible");
    // nor for a write after a write,
    assert_string_equal(hazard(&m, &find("write")->access),
                        "write after write that is not available");
    // but for a write after a read.
    m = (model){.num = 0};
    apply_access(&m, &find("read")->access);
    assert_string_equal(hazard(&m, &find("fill")->access), "write after read without order");
    apply_barrier(&m, &(tyn_barrier){.src_stages = COMPUTE, .dst_stages = TRANSFER});
    assert_null(hazard(&m, &find("fill")->access));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(expected_barriers),
        cmocka_unit_test(joined_accesses),
        cmocka_unit_test(random_accesses),
        cmocka_unit_test(model_finds_faults),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
