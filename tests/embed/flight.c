// flight.c -- two frames in flight while what they were recorded with is replaced: nothing goes before its frame is over, and the
// pictures are those of contexts that know of no earlier frame. Validation tells what is destroyed or written too early.
#include "rig.h"
#include "skip.h"
#include "states.h"
#include "vulkan_tap.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

typedef struct flight {
    rig r;
    tyn_device *dev;
    tyn_context *ctx;
    host_image color[HOST_SLOTS];
    host_buffer black, picture[HOST_SLOTS];
} flight;

static VkDeviceSize bytes_of(const flight *f)
{
    return (VkDeviceSize)f->r.view.width * f->r.view.height * 16;
}

static void open_flight(flight *f)
{
    if (!rig_open(&f->r, true)) {
        skip_all("the host has no device");
    }
    for (int s = 0; s < HOST_SLOTS; s++) {
        f->color[s] = host_image_new(
            &f->r.host, VK_FORMAT_R32G32B32A32_SFLOAT, (VkExtent3D){RIG_WIDTH, RIG_HEIGHT, 1},
            VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
        f->picture[s] = host_buffer_new(&f->r.host, bytes_of(f));
    }
    f->black = host_buffer_new(&f->r.host, bytes_of(f));
    memset(f->black.data, 0, bytes_of(f));
    assert_int_equal(rig_device(&f->r, true, NULL, &f->dev), TYN_OK);
    assert_int_equal(rig_context(&f->r, f->dev, "pop", &f->ctx), TYN_OK);
}

static void close_flight(flight *f)
{
    for (uint32_t s = 0; s < HOST_SLOTS; s++) {
        host_wait(&f->r.host, s);
    }
    tyn_context_destroy(&f->ctx);
    tyn_device_destroy(&f->dev);
    for (int s = 0; s < HOST_SLOTS; s++) {
        host_image_free(&f->r.host, &f->color[s]);
        host_buffer_free(&f->r.host, &f->picture[s]);
    }
    host_buffer_free(&f->r.host, &f->black);
    rig_expect_silence(&f->r);
    rig_close(&f->r);
}

static tyn_frame frame_of(flight *f, uint32_t slot, tyn_image *lent)
{
    host_image copy = f->color[slot];
    *lent = host_lend(&copy, drawn_to);
    return (tyn_frame){
        .struct_size = sizeof(tyn_frame), .scene = &f->r.scene, .view = &f->r.view, .color = lent};
}

// Waits for the slot's frame before, prepares unless told not to, records and submits; the other frame is under way meanwhile.
static tyn_result fly(flight *f, uint32_t slot, bool prepares)
{
    host *h = &f->r.host;
    tyn_image lent;
    host_wait(h, slot);
    tyn_frame frame = frame_of(f, slot, &lent);
    if (prepares) {
        assert_int_equal(tyn_context_prepare(f->ctx, &frame), TYN_OK);
    }
    const VkCommandBuffer cmd = host_begin(h, slot);
    f->color[slot].state = nothing_yet;
    host_transition(h, cmd, &f->color[slot], copy_target);
    host_upload(h, cmd, &f->black, &f->color[slot]);
    host_transition(h, cmd, &f->color[slot], drawn_to);
    frame = frame_of(f, slot, &lent);
    frame.cmd = cmd;
    const tyn_result result = tyn_context_record(f->ctx, &frame);
    host_transition(h, cmd, &f->color[slot], copy_source);
    host_download(h, cmd, &f->color[slot], &f->picture[slot]);
    host_submit(h, slot);
    return result;
}

// ---- what happens between the frames ------------------------------------------------------------

static void set_lamp(flight *f, float strength)
{
    memcpy(f->r.scene.lights[1].color, (float[]){strength, 0.8f * strength, 0.6f * strength},
           sizeof(float[3]));
}

static void replace_grid(flight *f, float value)
{
    tyn_volume *v = &f->r.scene.volumes[0];
    v->data[v->size[0] * v->size[1] * v->size[2] / 2] = value;
    v->hash++;
}

static void happen(flight *f, int event)
{
    tyn_scene *s = &f->r.scene;
    switch (event) {
    case 1:
        set_lamp(f, 0);
        break;
    case 2:
        replace_grid(f, 0.25f);
        break;
    case 3: // the sun crosses a side
        memcpy(s->lights[0].direction, (float[]){-0.8f, -0.6f, 0}, sizeof(float[3]));
        break;
    case 4:
        set_lamp(f, 0.5f);
        break;
    case 5:
        assert_int_equal(tyn_context_set(f->ctx, "lattice.cells", "6"), TYN_OK);
        break;
    case 6:
        replace_grid(f, 0.5f);
        break;
    case 7:
        assert_int_equal(tyn_context_set(f->ctx, "lattice.cells", "8"), TYN_OK);
        break;
    default:
        break;
    }
}
enum { EVENTS = 8 };

// What a context that knows of no earlier frame makes of the scene is, bit by bit, in `slot`.
static void expect_as_alone(flight *f, uint32_t slot)
{
    const uint32_t other = (slot + 1) % HOST_SLOTS;
    tyn_context *ctx = f->ctx;
    char cells[8];
    double value;
    assert_int_equal(tyn_context_get(ctx, "lattice.cells", &value), TYN_OK);
    snprintf(cells, sizeof cells, "%d", (int)value);
    assert_int_equal(rig_context(&f->r, f->dev, "pop", &f->ctx), TYN_OK);
    assert_int_equal(tyn_context_set(f->ctx, "lattice.cells", cells), TYN_OK);
    assert_int_equal(fly(f, other, true), TYN_OK);
    host_wait(&f->r.host, other);
    host_wait(&f->r.host, slot);
    assert_memory_equal(f->picture[slot].data, f->picture[other].data, bytes_of(f));
    assert_memory_not_equal(f->picture[slot].data, f->black.data, bytes_of(f));
    tyn_context_destroy(&f->ctx);
    f->ctx = ctx;
}

// Frame i is prepared and recorded while frame i - 1 is under way.
static void replaced_under_way(flight *f)
{
    for (int i = 0; i < EVENTS; i++) {
        const uint32_t slot = (uint32_t)i % HOST_SLOTS;
        happen(f, i);
        assert_int_equal(fly(f, slot, true), TYN_OK);
        if (i == 3 || i == EVENTS - 1) {
            expect_as_alone(f, slot);
        }
    }
}

// A record whose values want something else than was prepared leaves the picture alone and says TYN_PENDING; the next prepare
// mends it.
static void values_yield(flight *f)
{
    happen(f, 4); // the lamp is on
    assert_int_equal(fly(f, 0, true), TYN_OK);
    happen(f, 1);
    assert_int_equal(fly(f, 1, false), TYN_PENDING);
    host_wait(&f->r.host, 1);
    assert_memory_equal(f->picture[1].data, f->black.data, bytes_of(f));
    assert_int_equal(fly(f, 0, true), TYN_OK);
    assert_int_equal(fly(f, 1, false), TYN_OK);
    host_wait(&f->r.host, 0);
    host_wait(&f->r.host, 1);
    assert_memory_not_equal(f->picture[0].data, f->black.data, bytes_of(f));
    assert_memory_equal(f->picture[0].data, f->picture[1].data, bytes_of(f));
}

// What was replaced goes with the frames that follow, and at once where the host says that the device is idle.
static void replaced_goes(flight *f)
{
    for (int idle = 0; idle < 2; idle++) {
        for (uint32_t i = 0; i < HOST_SLOTS + 1; i++) { // all before is over
            assert_int_equal(fly(f, i % HOST_SLOTS, true), TYN_OK);
        }
        host_wait(&f->r.host, 0);
        host_wait(&f->r.host, 1);
        assert_int_equal(tyn_context_set(f->ctx, "lattice.cells", idle ? "8" : "6"), TYN_OK);
        tyn_image lent;
        tyn_frame frame = frame_of(f, 1, &lent);
        frame.idle = idle;
        tap_clear();
        assert_int_equal(tyn_context_prepare(f->ctx, &frame), TYN_OK);
        const tap_counts prepared = tap_since();
        uint32_t frees[3];
        for (uint32_t i = 0; i < 3; i++) {
            tap_clear();
            assert_int_equal(fly(f, (i + 1) % HOST_SLOTS, false), TYN_OK);
            frees[i] = tap_since().frees;
        }
        print_message("%s: destroyed in prepare %u, in the frames after %u, %u, %u\n",
                      idle ? "idle" : "in flight", prepared.frees, frees[0], frees[1], frees[2]);
        assert_int_equal(prepared.waits, 0);
        assert_true(idle ? prepared.frees > 10 : prepared.frees == 0);
        assert_int_equal(frees[0], 0);
        assert_true(idle ? frees[1] == 0 : frees[1] > 10);
        assert_int_equal(frees[2], 0);
    }
}

// In the life of one context, so that kernels are compiled once.
static void frames_in_flight(void **state)
{
    (void)state;
    flight f = {0};
    open_flight(&f);
    replaced_under_way(&f);
    values_yield(&f);
    replaced_goes(&f);
    close_flight(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(frames_in_flight)};
    return cmocka_run_group_tests_name("embed_flight", tests, NULL, NULL);
}
