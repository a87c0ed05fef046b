// pace.c -- samples of a record from the times of the records before, on a device whose clock says what the test wants.
#include "fake_vulkan.h"
#include <tyndall/context.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

enum { NEVER = -1 };

// Functions of Vulkan get handles only.
static double node_ms; // of the nodes that are asked for; NEVER: they are not done

static void reset(VkCommandBuffer cmd, VkQueryPool pool, uint32_t first, uint32_t count)
{
    (void)cmd, (void)pool, (void)first, (void)count;
}

static void stamp(VkCommandBuffer cmd, VkPipelineStageFlags2 stage, VkQueryPool pool,
                  uint32_t query)
{
    (void)cmd, (void)stage, (void)pool, (void)query;
}

static VkResult times(VkDevice dev, VkQueryPool pool, uint32_t first, uint32_t count, size_t size,
                      void *data, VkDeviceSize stride, VkQueryResultFlags flags)
{
    (void)dev, (void)pool, (void)first, (void)size, (void)stride, (void)flags;
    assert_int_equal(count, 2);
    ((uint64_t *)data)[0] = 1000;
    ((uint64_t *)data)[1] = 1000 + (uint64_t)(1e6 * node_ms);
    return node_ms == NEVER ? VK_NOT_READY : VK_SUCCESS;
}

typedef struct stage {
    fake_vulkan *fake;
    tyn_context *ctx;
    tyn_scene scene;
    tyn_view view;
} stage;

// A homogeneous cube: of the path tracer's nodes none but `path` and those of the medium run.
static void open_stage(stage *st, tyn_capacity capacity, uint32_t in_flight)
{
    *st = (stage){.fake = fake_create()};
    tyn_device *dev = &st->fake->dev;
    dev->capacity = capacity;
    dev->timestamp_bits = 64;
    dev->properties.limits.timestampPeriod = 1;
    dev->vk.CmdResetQueryPool = reset;
    dev->vk.CmdWriteTimestamp2 = stamp;
    dev->vk.GetQueryPoolResults = times;
    node_ms = NEVER;
    assert_int_equal(
        tyn_context_create(dev, tyn_context_params(.method = "path", .frames_in_flight = in_flight),
                           &st->ctx),
        TYN_OK);
    tyn_scene_init(&st->scene);
    st->scene.media[st->scene.num_media++] = (tyn_medium){.sigma_s = {4, 4, 4},
                                                          .phase = {{.g = 0}, {.g = 0}, {.g = 0}},
                                                          .density_scale = 1,
                                                          .volume = -1};
    tyn_shape *shape = &st->scene.shapes[st->scene.num_shapes++];
    *shape = (tyn_shape){.kind = TYN_SHAPE_BOX};
    for (int i = 0; i < 4; i++) {
        shape->to_world[5 * i] = 1;
    }
    st->scene.lights[st->scene.num_lights++] =
        (tyn_light){.kind = TYN_LIGHT_DIRECTIONAL, .color = {1, 1, 1}, .direction = {0, 0, -1}};
    st->view = (tyn_view){.width = 512, .height = 512};
    st->view.camera.yfov = 0.7f;
    assert_int_equal(tyn_camera_look_at(&st->view.camera, (float[]){1, 2, 4}, (float[]){0, 0, 0}),
                     TYN_OK);
}

static void close_stage(stage *st)
{
    tyn_context_destroy(&st->ctx);
    tyn_scene_finish(&st->scene);
    fake_destroy(&st->fake);
}

// How many samples the next record may have.
static uint32_t ask(stage *st)
{
    const tyn_frame *frame = tyn_frame(.scene = &st->scene, .view = &st->view);
    assert_int_equal(tyn_context_prepare(st->ctx, frame), TYN_OK);
    return tyn_context_batch(st->ctx, frame);
}

// Records so many, which take `ms` once they are asked for.
static void add(stage *st, uint32_t samples, double ms)
{
    st->view.num_samples = samples;
    const tyn_frame *frame =
        tyn_frame(.cmd = (VkCommandBuffer)(uintptr_t)1, .scene = &st->scene, .view = &st->view);
    assert_int_equal(tyn_context_prepare(st->ctx, frame), TYN_OK);
    assert_int_equal(tyn_context_record(st->ctx, frame), TYN_OK);
    st->view.first_sample += samples;
    node_ms = ms;
}

static const tyn_capacity card = {.threads = 65536};

static void on_a_card(void **state)
{
    (void)state;
    stage st;
    open_stage(&st, card, 1);
    const uint32_t foretold = ask(&st);
    assert_true(foretold > 1);
    add(&st, foretold, NEVER); // nothing is known of it
    assert_int_equal(ask(&st), foretold);
    // Two dispatches of 131072 pixels each: 50 ms for one of them are 100 ms, below the record's 250.
    add(&st, 16, 32);
    assert_int_equal(ask(&st), 50);
    add(&st, 50, 400);
    assert_int_equal(ask(&st), 12);
    add(&st, 12, 4000); // never less than one
    assert_int_equal(ask(&st), 1);
    add(&st, 1, 0.001); // eight times as many at most
    assert_int_equal(ask(&st), 8);
    add(&st, 8, 0.001);
    assert_int_equal(ask(&st), 64);
    // More pixels, and so more dispatches: the record's time is what counts.
    st.view = (tyn_view){.width = 1024, .height = 1024, .camera = st.view.camera};
    add(&st, 1, 1);
    add(&st, 64, 160);
    assert_int_equal(ask(&st), 100);
    // Another picture: what was measured is of the one before.
    st.view.first_sample = 0;
    st.view.width = st.view.height = 512;
    assert_int_equal(ask(&st), foretold);
    close_stage(&st);
}

static void of_a_record_that_is_over(void **state)
{
    (void)state;
    stage st;
    open_stage(&st, card, 2);
    const uint32_t foretold = ask(&st);
    add(&st, 4, 1);
    assert_int_equal(ask(&st), foretold); // it may be under way
    add(&st, 10, 8);
    assert_int_equal(ask(&st), 32); // of 4 samples, not of 10
    st.view.first_sample = 0;       // neither is of this picture
    add(&st, 4, 1);
    assert_int_equal(ask(&st), foretold);
    close_stage(&st);
}

// The same samples give the same bits there, however long they take.
static void on_a_processor(void **state)
{
    (void)state;
    stage st;
    open_stage(&st, (tyn_capacity){.software = true}, 1);
    const uint32_t foretold = ask(&st);
    add(&st, foretold, 1);
    assert_int_equal(ask(&st), foretold);
    add(&st, foretold, 1e5);
    assert_int_equal(ask(&st), foretold);
    close_stage(&st);
}

// Dispatches of a record of balances of `samples`.
static uint32_t balances(stage *st, uint32_t samples)
{
    st->view.width = st->view.height = 1;
    st->view.outputs = TYN_OUTPUT_BALANCE;
    fake_clear(st->fake);
    add(st, samples, NEVER);
    return st->fake->dispatches;
}

// A host that does not ask how many samples there may be: no dispatch has more paths than numbers of 32 bits tell apart.
static void records_of_many_paths(void **state)
{
    (void)state;
    enum {
        MANY = 1 << 18
    }; // of 16384 paths each, together 2^32: four dispatches of 2^30 - 2, and the rest
    stage st;
    open_stage(&st, card, 1);
    balances(&st, 1);                      // the medium as well
    assert_int_equal(balances(&st, 1), 2); // paths, and their sum
    assert_int_equal(balances(&st, MANY), 2 * 5);
    close_stage(&st);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(on_a_card), cmocka_unit_test(of_a_record_that_is_over),
        cmocka_unit_test(on_a_processor), cmocka_unit_test(records_of_many_paths)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
