// pass_time.c -- one pass alone, timed: more work takes longer, and what cannot run says so.
#include "gpu_test.h"
#include "graph_blur.comp.h"
#include <tyndall/offline.h>
#include <math.h>

enum { IN, BIAS, OUT, TMP, NUM_PORTS };
enum { W = 512, H = 512 };

static const tyn_port ports[NUM_PORTS] = {
    {"in", TYN_IN, TYN_IMAGE_2D, 0, true, "what is blurred"},
    {"bias", TYN_IN, TYN_BUFFER, 0, true, "added each time"},
    {"out", TYN_OUT, TYN_IMAGE_2D, VK_FORMAT_R32_SFLOAT, false, "blurred"},
    {"tmp", TYN_SCRATCH, TYN_IMAGE_2D, VK_FORMAT_R32_SFLOAT, false, "ping-pong"},
};
static const tyn_binding bindings[] = {{IN, TYN_USE_SAMPLED, false},
                                       {OUT, TYN_USE_STORAGE_WRITE, false},
                                       {BIAS, TYN_USE_STORAGE_READ, false}};
static const tyn_kernel kernels[] = {
    {"blur", graph_blur_spirv, sizeof graph_blur_spirv, 8, {8, 4, 1}, bindings, 3, 1, NULL}};

typedef struct blur_params {
    int32_t times;
} blur_params;

static tyn_result declare(tyn_builder *b, const void *params)
{
    (void)params;
    tyn_build_image(b, OUT, (tyn_extent){W, H, 1}, 1);
    tyn_build_image(b, TMP, (tyn_extent){W, H, 1}, 1);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const blur_params *p = params;
    const uint32_t size[2] = {W, H};
    for (int i = 0; i < p->times; i++) {
        uint8_t to = (p->times - 1 - i) % 2 ? TMP : OUT, from = i == 0 ? IN : to == OUT ? TMP : OUT;
        tyn_rec_dispatch(r, &(tyn_dispatch){.cells = {W, H, 1},
                                            .args = size,
                                            .ports = (const uint8_t[]){from, to, BIAS},
                                            .spec = (const uint32_t[]){0}});
    }
}

static const tyn_pass_desc blur = {.name = "blur alone",
                                   .summary = "a moving average",
                                   .ports = ports,
                                   .num_ports = NUM_PORTS,
                                   .kernels = kernels,
                                   .num_kernels = 1,
                                   .params_size = sizeof(blur_params),
                                   .declare = declare,
                                   .record = record,
                                   .debug_port = OUT};

static void more_takes_longer(void **state)
{
    gpu_test *t = *state;
    double once = NAN, often = NAN;
    assert_int_equal(tyn_offline_time_pass(t->dev, &blur, &(blur_params){1}, 5, &once), TYN_OK);
    assert_int_equal(tyn_offline_time_pass(t->dev, &blur, &(blur_params){20}, 5, &often), TYN_OK);
    assert_true(once > 0);
    assert_true(often > 4 * once);
    assert_int_equal(tyn_device_validation_messages(t->dev), 0);
}

static void refusals(void **state)
{
    gpu_test *t = *state;
    double ms = 1;
    t->quiet = true;
    assert_int_equal(tyn_offline_time_pass(t->dev, &blur, &(blur_params){1}, 0, &ms),
                     TYN_ERR_PARAMS);
    assert_true(isnan(ms));
    assert_int_equal(tyn_offline_time_pass(NULL, &blur, &(blur_params){1}, 1, &ms), TYN_ERR_PARAMS);
    // an input that must be there cannot
    tyn_port needs[NUM_PORTS];
    for (int i = 0; i < NUM_PORTS; i++) {
        needs[i] = ports[i];
    }
    needs[IN].optional = false;
    tyn_pass_desc pass = blur;
    pass.ports = needs;
    assert_int_not_equal(tyn_offline_time_pass(t->dev, &pass, &(blur_params){1}, 1, &ms), TYN_OK);
    assert_true(isnan(ms));
    assert_true(t->errors >= 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(more_takes_longer, gpu_setup, gpu_teardown),
        cmocka_unit_test_setup_teardown(refusals, gpu_setup, gpu_teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
