// budget.c -- a graph keeps to its budget of device memory, or is refused as it is: counted by the device that only writes
// down what it is told.
#include "fake_vulkan.h"
#include "graph/graph.h"
#include "toy_passes.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

enum { FLIGHT = 3 }; // frames: what one compilation replaces waits while the next is made

typedef struct fixture {
    fake_vulkan *fake;
    tyn_graph *g;
} fixture;

static int setup(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    f->fake = fake_create();
    *state = f;
    return tyn_graph_create(&f->fake->dev, FLIGHT, &f->g);
}

static int teardown(void **state)
{
    fixture *f = *state;
    tyn_graph_destroy(&f->g);
    fake_destroy(&f->fake); // fails if anything is left, of a trial for instance
    free(f);
    return 0;
}

static void fill_zero(void *user, void *staging)
{
    const uint32_t *size = user;
    memset(staging, 0, (size_t)*size * *size * 4);
}

// input -> blur -> blur -> result, which is read back, and a history: of size x size pixels.
static void declare(tyn_graph *g, const uint32_t *size, uint64_t content)
{
    tyn_graph_begin(g);
    tyn_ref in =
        tyn_graph_upload_image(g, "input", TYN_IMAGE_2D, VK_FORMAT_R32_SFLOAT,
                               (tyn_extent){*size, *size, 1}, fill_zero, (void *)size, content);
    for (int i = 0; i < 2; i++) {
        tyn_ref refs[BLUR_NUM] = {in};
        tyn_graph_add(g, &toy_blur, &(node_params){3, i, 0}, refs);
        in = refs[BLUR_OUT];
    }
    tyn_ref sum[ADD_NUM] = {tyn_graph_history_buffer(g, "sum", *size * 16, 1), in};
    tyn_graph_add(g, &toy_add, &(node_params){0}, sum);
    tyn_graph_output(g, "sum", sum[ADD_SUM], false);
    tyn_graph_output(g, "result", in, true);
}

static tyn_result frame(fixture *f, const uint32_t *size, uint64_t content)
{
    fake_clear(f->fake);
    declare(f->g, size, content);
    const tyn_result result = tyn_graph_matches(f->g) ? TYN_OK : tyn_graph_compile(f->g);
    return result == TYN_OK ? tyn_graph_record(f->g, VK_NULL_HANDLE) : result;
}

static void restart(fixture *f, uint64_t budget)
{
    tyn_graph_destroy(&f->g);
    assert_int_equal(f->fake->bytes, 0);
    f->fake->most_bytes = 0;
    assert_int_equal(tyn_graph_create(&f->fake->dev, FLIGHT, &f->g), TYN_OK);
    tyn_graph_budget(f->g, budget);
}

// Sizes that one graph takes one after the other, without waiting: kept, replaced, grown, shrunk.
static const uint32_t sizes[] = {512, 512, 768, 256, 1024, 512, 1024};
enum { NUM_SIZES = sizeof sizes / sizeof sizes[0] };

// All frames; the most memory there ever was, or 0 if one was refused.
static VkDeviceSize run(fixture *f, uint64_t budget)
{
    restart(f, budget);
    for (uint64_t i = 0; i < NUM_SIZES; i++) {
        const tyn_result result = frame(f, &sizes[i], i);
        if (result != TYN_OK) {
            assert_int_equal(result, TYN_ERR_MEMORY);
            return 0;
        }
    }
    return f->fake->most_bytes;
}

// What the trial counts is what is allocated: to the byte.
static void exactly_what_is_needed(void **state)
{
    fixture *f = *state;
    for (uint32_t i = 0; i < NUM_SIZES; i++) {
        restart(f, 0);
        assert_int_equal(frame(f, &sizes[i], 1), TYN_OK);
        const VkDeviceSize needed = f->fake->most_bytes;
        const uint32_t objects = f->fake->live;
        restart(f, needed);
        assert_int_equal(frame(f, &sizes[i], 1), TYN_OK);
        assert_int_equal(f->fake->most_bytes, needed);
        assert_int_equal(f->fake->live, objects);
        restart(f, needed - 1);
        assert_int_equal(frame(f, &sizes[i], 1), TYN_ERR_MEMORY);
        assert_int_equal(f->fake->most_bytes, 0);
    }
}

// Of frames in flight too: with the most there ever was as the budget nothing is refused, and never is it passed.
static void budget_is_kept(void **state)
{
    fixture *f = *state;
    const VkDeviceSize most = run(f, 0);
    assert_true(most > 12u << 20);
    assert_int_equal(run(f, most), most);
    uint32_t refused = 0;
    for (VkDeviceSize budget = most - 1; budget > 1u << 20; budget -= budget / 8) {
        refused += !run(f, budget);
        assert_true(f->fake->most_bytes <= budget);
    }
    assert_true(refused > 4);
}

static void refusal_leaves_all(void **state)
{
    fixture *f = *state;
    const uint32_t small = 512, large = 1024;
    restart(f, 0);
    assert_int_equal(frame(f, &large, 1), TYN_OK);
    const VkDeviceSize needed = f->fake->most_bytes;
    restart(f, needed - (1u << 20));
    for (uint64_t i = 0; i < 3; i++) {
        assert_int_equal(frame(f, &small, 1), TYN_OK);
    }
    const uint32_t live = f->fake->live;
    const VkDeviceSize bytes = f->fake->bytes;
    char *before = strdup(f->fake->text);
    f->fake->most_bytes = 0;
    assert_int_equal(frame(f, &large, 1), TYN_ERR_MEMORY);
    char start[96];
    snprintf(start, sizeof start, "memory_budget is %.2f MiB, and ",
             (double)needed / (1 << 20) - 1);
    assert_memory_equal(f->fake->log, start, strlen(start));
    assert_non_null(strstr(f->fake->log, "the largest: input 4.00 MiB, blur.out 4.00 MiB, blur.tmp "
                                         "4.00 MiB\n"));
    assert_ptr_equal(strchr(f->fake->log, '\n') + 1, strchr(f->fake->log, 0)); // one line
    assert_int_equal(f->fake->live, live);
    assert_int_equal(f->fake->bytes, bytes);
    assert_int_equal(f->fake->most_bytes, 0); // nothing was allocated
    f->fake->created = 0;
    assert_int_equal(frame(f, &small, 1), TYN_OK);
    assert_int_equal(f->fake->created, 0);
    assert_string_equal(f->fake->text, before);
    free(before);
}

// Staging of new content counts: it is refused where there is no room for it, and the frame before is still there.
static void uploads_count(void **state)
{
    fixture *f = *state;
    const uint32_t size = 1024;
    restart(f, 0);
    assert_int_equal(frame(f, &size, 1), TYN_OK);
    const VkDeviceSize needed = f->fake->most_bytes;
    for (int enough = 0; enough < 2; enough++) {
        restart(f, needed);
        for (int i = 0; i < 2 * FLIGHT; i++) {
            assert_int_equal(frame(f, &size, 1), TYN_OK);
            tyn_graph_trim(f->g); // the staging goes when its frame is over
        }
        tyn_graph_budget(f->g, needed - (enough ? 0 : 1));
        assert_int_equal(frame(f, &size, 2), enough ? TYN_OK : TYN_ERR_MEMORY);
        assert_int_equal(frame(f, &size, enough ? 2 : 1), TYN_OK);
    }
}

// Whichever object of a trial cannot be made: an error, nothing is left of it, and the frame before is still there.
static void trials_fail(void **state)
{
    fixture *f = *state;
    const uint32_t small = 256, large = 512;
    uint32_t failures = 0;
    for (uint32_t at = 1;; at++) {
        restart(f, 64u << 20);
        assert_int_equal(frame(f, &small, 1), TYN_OK);
        const uint32_t live = f->fake->live;
        f->fake->created = 0;
        f->fake->fail_at = at;
        const VkDeviceSize bytes = f->fake->bytes;
        const tyn_result result = frame(f, &large, 1);
        f->fake->fail_at = 0;
        if (result == TYN_OK || f->fake->bytes != bytes) {
            break; // the trial is over, and the compilation itself began
        }
        assert_int_equal(result, TYN_ERR_MEMORY);
        assert_int_equal(f->fake->live, live);
        assert_int_equal(frame(f, &small, 1), TYN_OK);
        assert_int_equal(f->fake->live, live);
        failures++;
    }
    assert_true(failures > 4);
}

// Two blurs work in the same scratch, one after the other; what they make they have for themselves.
static void memory_of_nodes(void **state)
{
    fixture *f = *state;
    const uint32_t size = 512;
    restart(f, 0);
    assert_int_equal(frame(f, &size, 1), TYN_OK);
    const tyn_node_stats *stats;
    assert_int_equal(tyn_graph_stats(f->g, &stats), 3);
    const uint64_t image = 4 * size * size;
    for (int i = 0; i < 2; i++) {
        assert_int_equal(stats[i].bytes, 2 * image);
        assert_int_equal(stats[i].shared_bytes, image);
    }
    assert_int_equal(stats[2].bytes, 0);
    assert_int_equal(stats[2].shared_bytes, 0);
    char *dump = tyn_graph_dump(f->g, false, NULL);
    assert_non_null(strstr(dump, "memory  2.00 MiB, 1.00 MiB of it shared with other nodes"));
    // What the second one makes lies where the first one's scratch was: its first access waits by a barrier for all memory,
    // beside the image's own.
    const char *second = strstr(dump, "node 1 ");
    assert_non_null(second);
    assert_non_null(strstr(second, "barrier memory: ALL MEMORY_WRITE -> COMPUTE|TRANSFER "));
    assert_non_null(strstr(second, "barrier out: ALL MEMORY_WRITE -> COMPUTE STORAGE_WRITE, "
                                   "UNDEFINED -> GENERAL"));
    free(dump);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, setup, teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(exactly_what_is_needed), TEST(budget_is_kept), TEST(refusal_leaves_all),
        TEST(uploads_count),          TEST(trials_fail),    TEST(memory_of_nodes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
