// graph.c -- the render graph on a device: ping-pong, change tracking, culling, histories, refusal.
#include "gpu_test.h"
#include "graph_blur.comp.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { IN, BIAS, OUT, TMP };
enum { W = 37, H = 5 };

static const tyn_port ports[] = {
    {"in", TYN_IN, TYN_IMAGE_2D, 0, false, "what is blurred"},
    {"bias", TYN_IN, TYN_BUFFER, 0, true, "added each time"},
    {"out", TYN_OUT, TYN_IMAGE_2D, VK_FORMAT_R32_SFLOAT, false, "blurred"},
    {"tmp", TYN_SCRATCH, TYN_IMAGE_2D, VK_FORMAT_R32_SFLOAT, false, "ping-pong"},
};
static const tyn_binding bindings[] = {
    {IN, TYN_USE_SAMPLED}, {OUT, TYN_USE_STORAGE_WRITE}, {BIAS, TYN_USE_STORAGE_READ}};
static const tyn_kernel kernels[] = {
    {"blur", graph_blur_spirv, sizeof graph_blur_spirv, 8, {8, 4, 1}, bindings, 3, 1}};

typedef struct blur_params {
    int32_t times;
} blur_params;

static tyn_result declare(tyn_builder *b, const void *params)
{
    (void)params;
    tyn_build_image(b, OUT, tyn_build_extent(b, IN), 1);
    tyn_build_image(b, TMP, tyn_build_extent(b, IN), 1);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const blur_params *p = params;
    tyn_extent e = tyn_rec_extent(r, IN);
    uint32_t size[2] = {e.x, e.y};
    // in -> ... -> out, through tmp; the last step must land in out.
    for (int i = 0; i < p->times; i++) {
        uint8_t to = (p->times - 1 - i) % 2 ? TMP : OUT, from = i == 0 ? IN : to == OUT ? TMP : OUT;
        tyn_rec_dispatch(r, &(tyn_dispatch){.cells = e,
                                            .args = size,
                                            .ports = (const uint8_t[]){from, to, BIAS},
                                            .spec = (const uint32_t[]){0}});
    }
    tyn_rec_work(r, "cells", (double)e.x * e.y * p->times);
}

static const tyn_pass_desc blur = {.name = "blur",
                                   .summary = "a moving average",
                                   .ports = ports,
                                   .num_ports = 4,
                                   .kernels = kernels,
                                   .num_kernels = 1,
                                   .params_size = sizeof(blur_params),
                                   .declare = declare,
                                   .record = record,
                                   .debug_port = OUT};

static void reference(float *data, int times, float bias)
{
    for (int t = 0; t < times; t++) {
        float next[W * H];
        for (int y = 0; y < H; y++) {
            for (int x = 0; x < W; x++) {
                next[y * W + x] =
                    (data[y * W + (x + W - 1) % W] + data[y * W + (x + 1) % W]) * 0.5f + bias;
            }
        }
        memcpy(data, next, sizeof next);
    }
}

static void declare_chain(gpu_test *t, const float *input, int first, int second)
{
    tyn_graph_begin(t->graph);
    tyn_ref in = gpu_image(t, "input", TYN_IMAGE_2D, (tyn_extent){W, H, 1}, 1, input);
    tyn_ref a[4] = {in}, b[4] = {{0}}, unused[4] = {in};
    const float bias = 0.25f;
    assert_int_equal(tyn_graph_add(t->graph, &blur, &(blur_params){first}, a), TYN_OK);
    b[IN] = a[OUT];
    b[BIAS] = gpu_buffer(t, "bias", &bias, sizeof bias);
    assert_int_equal(tyn_graph_add(t->graph, &blur, &(blur_params){second}, b), TYN_OK);
    assert_int_equal(tyn_graph_add(t->graph, &blur, &(blur_params){3}, unused), TYN_OK);
    tyn_graph_output(t->graph, "result", b[OUT], true);
}

static tyn_node_state state_of(gpu_test *t, uint32_t node)
{
    const tyn_node_stats *stats;
    assert_true(tyn_graph_stats(t->graph, &stats) > node);
    return stats[node].state;
}

static void check(gpu_test *t, const float *input, int first, int second)
{
    float expected[W * H];
    memcpy(expected, input, sizeof expected);
    reference(expected, first, 0);
    reference(expected, second, 0.25f);
    const float *got = gpu_map(t, "result");
    for (int i = 0; i < W * H; i++) {
        assert_true(fabsf(got[i] - expected[i]) < 1e-5f);
    }
}

static void chain_and_changes(void **state)
{
    gpu_test *t = *state;
    float input[W * H];
    for (int i = 0; i < W * H; i++) {
        input[i] = (float)(i * 7919 % 101);
    }
    declare_chain(t, input, 4, 3);
    gpu_run(t);
    check(t, input, 4, 3);
    assert_int_equal(state_of(t, 0), TYN_NODE_RAN);
    assert_int_equal(state_of(t, 1), TYN_NODE_RAN);
    assert_int_equal(state_of(t, 2), TYN_NODE_CULLED);

    declare_chain(t, input, 4, 3); // nothing changed
    gpu_run(t);
    check(t, input, 4, 3);
    assert_int_equal(state_of(t, 0), TYN_NODE_UNCHANGED);
    assert_int_equal(state_of(t, 1), TYN_NODE_UNCHANGED);

    declare_chain(t, input, 4, 5); // the second node's params: another structure, all runs again
    gpu_run(t);
    check(t, input, 4, 5);

    input[3] = 1000; // new data, same structure
    declare_chain(t, input, 4, 5);
    assert_false(tyn_graph_matches(t->graph));
    assert_null(tyn_graph_map(t->graph, "result", NULL, NULL)); // not before it has run
    gpu_run(t);
    check(t, input, 4, 5);
    assert_int_equal(state_of(t, 0), TYN_NODE_RAN);
}

static void stale_handle(void **state)
{
    gpu_test *t = *state;
    t->quiet = true;
    tyn_graph_begin(t->graph);
    tyn_ref refs[4] = {{0}};
    assert_int_equal(tyn_graph_add(t->graph, &blur, &(blur_params){1}, refs), TYN_ERR_PARAMS);
    assert_non_null(strstr(t->last_error, "input 'in' (what is blurred) is not connected"));
    assert_int_equal(gpu_try(t), TYN_ERR_PARAMS);
    t->quiet = false;
}

static void dump(void **state)
{
    gpu_test *t = *state;
    float input[W * H] = {0};
    declare_chain(t, input, 2, 2);
    gpu_run(t);
    char *text = tyn_graph_dump(t->graph, false, NULL), *dot = tyn_graph_dump(t->graph, true, NULL);
    assert_non_null(
        strstr(text, "barrier memory: COMPUTE STORAGE_WRITE -> COMPUTE|TRANSFER SAMPLED_READ"));
    assert_non_null(strstr(text, "culled: no output needs it"));
    assert_non_null(strstr(dot, "digraph"));
    free(text);
    free(dot);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(chain_and_changes),
        cmocka_unit_test(stale_handle),
        cmocka_unit_test(dump),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
