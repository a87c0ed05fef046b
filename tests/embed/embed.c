// embed.c -- Tyndall as a guest: a host with its own Vulkan device records frames into its own command
// buffers, over images in layouts of its choice, and finds them as promised.
//
// The host sees public headers only and enables the required features and no other. Validation and
// synchronization validation are on from its instance to its end; one message fails the test. A wrong
// layout, a missing barrier, or a barrier before the wrong stage shows there, because the host goes on
// from the state that was promised to it.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <tyndall/context.h>
#include <tyndall/extend/method.h>

#include "base/half.h"
#include "guest_host.h"
#include "numbers.h"
#include "skip.h"
#include "states.h"

static void images_in_any_layout(void **state)
{
    fixture *f = *state;
    const frame_states all[] = {
        {"attachment and read-only depth", drawn_to, drawn_to, depth_tested, depth_tested, false,
         VK_FORMAT_R32G32B32A32_SFLOAT},
        {"half floats", drawn_to, sampled, depth_tested, depth_tested, false,
         VK_FORMAT_R16G16B16A16_SFLOAT},
        {"general, then copied from", general, copy_source, depth_drawn, sampled, false,
         VK_FORMAT_R32G32B32A32_SFLOAT},
        {"copied from, then sampled", copy_source, sampled, general, general, false,
         VK_FORMAT_R32G32B32A32_SFLOAT},
        {"sampled, no depth", sampled, general, depth_drawn, depth_drawn, true,
         VK_FORMAT_R32G32B32A32_SFLOAT},
    };
    tyn_scene scene;
    make_smoke(&scene);
    const tyn_view view = make_view(0.2f, WIDTH, HEIGHT, TYN_OUTPUT_COMPOSITE);
    picture p = reference(f, "pop", &scene, view);
    float m[16];
    projection(&view, true, m);

    for (size_t i = 0; i < sizeof(all) / sizeof(all[0]); i++) {
        const frame_states *s = &all[i];
        print_message("  %s\n", s->name);
        tyn_context *ctx = new_context(f, f->guest, NULL);
        target t = new_target(&f->host, WIDTH, HEIGHT, s->color_format);
        paint_backdrop(&t, 0.0f);
        pack(&t);
        t.color.state = s->color_before;
        t.depth.state = s->depth_before;
        assert_int_equal(prepare_frame(ctx, &scene, &view, &t, s, m, NULL), TYN_OK);
        for (uint32_t repeat = 0; repeat < 3; repeat++) { // 2 and 3: nothing has changed
            const VkCommandBuffer cmd = host_begin(&f->host, repeat % HOST_SLOTS);
            begin_frame(f, cmd, &t, s);
            assert_int_equal(record_frame(ctx, cmd, &scene, &view, &t, s, m, NULL), TYN_OK);
            assert_int_equal(t.color.state.layout, s->color_after.layout);
            end_frame(f, cmd, &t);
            host_submit(&f->host, repeat % HOST_SLOTS);
            host_wait(&f->host, repeat % HOST_SLOTS);
            check_composite(&t, &p);
        }
        tyn_context_destroy(&ctx);
        free_target(&f->host, &t);
        expect_silence(f);
    }
    free_picture(&p);
    tyn_scene_finish(&scene);
}

// A card in front of an absorbing box, one inside it, one behind it: Beer and Lambert's law up to each.
static void surfaces_stop_the_light(void **state)
{
    fixture *f = *state;
    tyn_scene scene;
    make_ink(&scene);
    const tyn_view view = make_view(0, WIDTH, HEIGHT, TYN_OUTPUT_COMPOSITE);
    for (int reverse = 0; reverse < 2; reverse++) {
        float m[16];
        projection(&view, reverse, m);
        const float planes[3] = {3.5f, 5.25f, 8}; // the box is from 4 to 6
        const host_card cards[3] = {
            {26, 22, 10, 12, {0.5f, 0.5f, 0.5f, 1}, depth_of(m, planes[0])},
            {36, 22, 10, 12, {0.5f, 0.5f, 0.5f, 1}, depth_of(m, planes[1])},
            {46, 22, 10, 12, {0.5f, 0.5f, 0.5f, 1}, depth_of(m, planes[2])},
        };
        tyn_context *ctx = new_context(f, f->guest, "single");
        target t = painted_target(f, reverse ? 0.0f : 1.0f);
        host_paint(&t.color_up, &t.depth_up, WIDTH, HEIGHT, cards, 3);
        run_frame(f, ctx, &scene, &view, &t, m);

        for (int i = 0; i < 3; i++) {
            for (uint32_t y = cards[i].y + 1; y < cards[i].y + 11; y++) {
                for (uint32_t x = cards[i].x + 1; x < cards[i].x + 9; x++) {
                    // The ray through the middle of the pixel, z = -1 at unit distance.
                    const float tangent = tanf(0.5f * view.camera.yfov) / (0.5f * HEIGHT);
                    const float rx = ((float)x + 0.5f - 0.5f * WIDTH) * tangent;
                    const float ry = ((float)y + 0.5f - 0.5f * HEIGHT) * tangent;
                    const float inside = fminf(planes[i], 6) - fminf(planes[i], 4);
                    const float length = inside * sqrtf(1 + rx * rx + ry * ry);
                    for (int c = 0; c < 3; c++) {
                        const float right = 0.5f * expf(-scene.media[0].sigma_a[c] * length);
                        const float found = color_at(&t, x, y, c);
                        // Within 0.2 %: rays are jittered inside their pixel.
                        if (!(fabsf(found - right) <= 2e-3f * right)) {
                            fail_msg("card %d, pixel (%u, %u), channel %d: %g, not %g", i, x, y, c,
                                     (double)found, (double)right);
                        }
                    }
                }
            }
        }
        tyn_context_destroy(&ctx);
        free_target(&f->host, &t);
    }
    expect_silence(f);
    tyn_scene_finish(&scene);
}

// Two contexts on one device and one in between of another device object, frames in flight, a camera
// that moves, a resize in the middle, and everything destroyed in the order in which it was made.
static void contexts_share_a_device(void **state)
{
    fixture *f = *state;
    tyn_scene smoke, ink;
    make_smoke(&smoke);
    make_ink(&ink);
    ink.media[0].sigma_s[0] = ink.media[0].sigma_s[1] = ink.media[0].sigma_s[2] = 1;
    const frame_states s = usual_states();
    tyn_device *other = new_guest(f);
    tyn_context *first = new_context(f, f->guest, "pop");
    tyn_context *second = new_context(f, other, "single");

    tyn_view view = {0};
    target targets[HOST_SLOTS][2];
    for (int round = 0; round < 2; round++) {
        const uint32_t width = round ? 48 : WIDTH, height = round ? 64 : HEIGHT;
        for (uint32_t slot = 0; slot < HOST_SLOTS; slot++) {
            for (int k = 0; k < 2; k++) {
                target *t = &targets[slot][k];
                *t = new_target(&f->host, width, height, s.color_format);
                paint_backdrop(t, 0.0f);
                t->color.state = s.color_before;
                t->depth.state = s.depth_before;
            }
        }
        view = make_view(0, width, height, TYN_OUTPUT_COMPOSITE);
        float m[16];
        projection(&view, true, m);
        assert_int_equal(prepare_frame(first, &smoke, &view, &targets[0][0], &s, m, NULL), TYN_OK);
        assert_int_equal(prepare_frame(second, &ink, &view, &targets[0][1], &s, m, NULL), TYN_OK);
        enum { FRAMES = 7 };
        for (uint32_t frame = 0; frame < FRAMES; frame++) {
            const uint32_t slot = frame % HOST_SLOTS;
            target *a = &targets[slot][0], *b = &targets[slot][1];
            view = make_view(0.1f * (float)(frame / 2), width, height, TYN_OUTPUT_COMPOSITE);
            const VkCommandBuffer cmd = host_begin(&f->host, slot);
            begin_frame(f, cmd, a, &s);
            begin_frame(f, cmd, b, &s);
            assert_int_equal(record_frame(first, cmd, &smoke, &view, a, &s, m, NULL), TYN_OK);
            assert_int_equal(record_frame(second, cmd, &ink, &view, b, &s, m, NULL), TYN_OK);
            end_frame(f, cmd, a);
            end_frame(f, cmd, b);
            host_submit(&f->host, slot);
        }
        for (uint32_t slot = 0; slot < HOST_SLOTS; slot++) {
            host_wait(&f->host, slot);
        }
        // The last frames of both slots.
        for (uint32_t frame = FRAMES - HOST_SLOTS; frame < FRAMES; frame++) {
            view = make_view(0.1f * (float)(frame / 2), width, height, TYN_OUTPUT_COMPOSITE);
            picture p = reference(f, "pop", &smoke, view), q = reference(f, "single", &ink, view);
            check_composite(&targets[frame % HOST_SLOTS][0], &p);
            check_composite(&targets[frame % HOST_SLOTS][1], &q);
            free_picture(&p);
            free_picture(&q);
        }
        for (uint32_t slot = 0; slot < HOST_SLOTS; slot++) {
            free_target(&f->host, &targets[slot][0]);
            free_target(&f->host, &targets[slot][1]);
        }
    }
    tyn_context_destroy(&first);
    tyn_context *third = new_context(f, other, "pop"); // never used
    tyn_context_destroy(&second);
    tyn_context_destroy(&third);
    tyn_context_destroy(&third); // of NULL: nothing happens
    tyn_device_destroy(&other);
    expect_silence(f);
    tyn_scene_finish(&smoke);
    tyn_scene_finish(&ink);
}

// Settings that change between frames give the pictures of contexts that were made with them.
static void settings_change(void **state)
{
    fixture *f = *state;
    tyn_scene scene;
    make_smoke(&scene);
    const tyn_view view = make_view(0.2f, WIDTH, HEIGHT, TYN_OUTPUT_COMPOSITE);
    float m[16];
    projection(&view, true, m);
    tyn_context *ctx = new_context(f, f->guest, "pop");
    target t = painted_target(f, 0.0f);
    // The last two are what it began with, which other tests want.
    static const char *const changes[][2] = {{"lattice.cells", "9"},
                                             {"raymarch.step", "0.75"},
                                             {"raymarch.step", "1"},
                                             {"lattice.cells", "12"}};
    for (size_t k = 0; k < sizeof changes / sizeof changes[0]; k++) {
        double value;
        const tyn_log log = log_of(f);
        assert_int_equal(tyn_context_set(ctx, changes[k][0], changes[k][1]), TYN_OK);
        assert_int_equal(tyn_context_get(ctx, changes[k][0], &value), TYN_OK);
        assert_true(value == strtod(changes[k][1], NULL));
        assert_int_equal(tyn_settings_set(f->settings, changes[k][0], changes[k][1], &log), TYN_OK);
        picture p = reference(f, "pop", &scene, view);
        run_frame(f, ctx, &scene, &view, &t, m);
        check_composite(&t, &p);
        free_picture(&p);
    }
    tyn_context_destroy(&ctx);
    free_target(&f->host, &t);
    expect_silence(f);
    tyn_scene_finish(&scene);
}

static bool hook_is_on;

static uint32_t hook_reads(const tyn_job *job)
{
    (void)job;
    return hook_is_on ? TYN_OUTPUT_RADIANCE | TYN_OUTPUT_TRANSMITTANCE : 0;
}

static void hook_declare(tyn_graph *g, const tyn_job *job, tyn_picture *made)
{
    (void)g;
    (void)job;
    made->radiance = made->transmittance;
}

// What a hook hands on is laid over the host's picture.
static void hooks_come_before_the_composite(void **state)
{
    static const tyn_picture_hook hook = {"embed", hook_reads, hook_declare};
    fixture *f = *state;
    tyn_scene scene;
    make_smoke(&scene);
    const tyn_view view = make_view(0.2f, WIDTH, HEIGHT, TYN_OUTPUT_COMPOSITE);
    float m[16];
    projection(&view, true, m);
    tyn_context *ctx = new_context(f, f->guest, "pop");
    target t = painted_target(f, 0.0f);
    picture p = reference(f, "pop", &scene, view);
    assert_int_equal(tyn_picture_hook_register(&hook, NULL), TYN_OK);
    for (int on = 0; on < 2; on++) {
        hook_is_on = on;
        if (on) {
            memcpy(p.radiance, p.transmittance, sizeof(float[4]) * WIDTH * HEIGHT);
        }
        run_frame(f, ctx, &scene, &view, &t, m);
        check_composite(&t, &p);
    }
    hook_is_on = false;
    free_picture(&p);
    tyn_context_destroy(&ctx);
    free_target(&f->host, &t);
    expect_silence(f);
    tyn_scene_finish(&scene);
}

// The density is an image of the host's, in a layout of its choice, and changes without notice.
static void density_of_the_host(void **state)
{
    fixture *f = *state;
    tyn_scene scene;
    make_smoke(&scene);
    const tyn_view view = make_view(0.2f, WIDTH, HEIGHT, TYN_OUTPUT_COMPOSITE);
    picture p = reference(f, "pop", &scene, view);

    host *h = &f->host;
    host_image density =
        host_image_new(h, VK_FORMAT_R16_SFLOAT, (VkExtent3D){VOXELS, VOXELS, VOXELS},
                       VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT |
                           VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    const size_t voxels = (size_t)VOXELS * VOXELS * VOXELS;
    host_buffer up = host_buffer_new(h, voxels * 2);
    for (size_t i = 0; i < voxels; i++) {
        ((uint16_t *)up.data)[i] = tyn_half_from_float(scene.volumes[0].data[i]);
    }
    free(scene.volumes[0].data);
    scene.volumes[0].data = NULL;

    float m[16];
    projection(&view, true, m);
    const frame_states s = usual_states();
    tyn_context *ctx = new_context(f, f->guest, "pop");
    target t = painted_target(f, 0.0f);
    density.state = general;
    tyn_image lent = host_lend(&density, general);
    assert_int_equal(prepare_frame(ctx, &scene, &view, &t, &s, m, &lent), TYN_OK);
    for (uint32_t frame = 0; frame < 3; frame++) {
        const uint32_t slot = frame % HOST_SLOTS;
        const VkCommandBuffer cmd = host_begin(h, slot);
        density.state = frame ? density.state : nothing_yet;
        host_transition(h, cmd, &density, copy_target);
        host_upload(h, cmd, &up, &density);
        host_transition(h, cmd, &density, frame % 2 ? sampled : general);
        begin_frame(f, cmd, &t, &s);
        lent = host_lend(&density, frame % 2 ? general : sampled);
        assert_int_equal(record_frame(ctx, cmd, &scene, &view, &t, &s, m, &lent), TYN_OK);
        end_frame(f, cmd, &t);
        host_submit(h, slot);
        host_wait(h, slot); // the upload buffer and the target are used by every frame
        check_composite(&t, &p);
    }
    tyn_context_destroy(&ctx);
    free_target(h, &t);
    host_image_free(h, &density);
    host_buffer_free(h, &up);
    free_picture(&p);
    expect_silence(f);
    tyn_scene_finish(&scene);
}

// A record that cannot be done says so, appends nothing and leaves the images as they were.
static void failing_record_changes_nothing(void **state)
{
    fixture *f = *state;
    tyn_scene scene;
    make_smoke(&scene);
    const tyn_view view = make_view(0.2f, WIDTH, HEIGHT, TYN_OUTPUT_COMPOSITE);
    picture p = reference(f, "pop", &scene, view);
    float m[16];
    projection(&view, true, m);
    const frame_states s = usual_states();
    tyn_context *ctx = new_context(f, f->guest, "pop");
    target t = painted_target(f, 0.0f);
    target small = new_target(&f->host, WIDTH / 2, HEIGHT, s.color_format);

    f->quiet = true;
    VkCommandBuffer cmd = host_begin(&f->host, 0);
    begin_frame(f, cmd, &t, &s);
    // Never prepared.
    assert_int_not_equal(record_frame(ctx, cmd, &scene, &view, &t, &s, m, NULL), TYN_OK);
    assert_int_equal(prepare_frame(ctx, &scene, &view, &t, &s, m, NULL), TYN_OK);
    // Another size than was prepared.
    const tyn_view larger = make_view(0.2f, WIDTH * 2, HEIGHT, TYN_OUTPUT_COMPOSITE);
    assert_int_not_equal(record_frame(ctx, cmd, &scene, &larger, &t, &s, m, NULL), TYN_OK);
    // Other outputs than were prepared.
    const tyn_view other = make_view(0.2f, WIDTH, HEIGHT, TYN_OUTPUT_DEPTH | TYN_OUTPUT_COMPOSITE);
    assert_int_not_equal(record_frame(ctx, cmd, &scene, &other, &t, &s, m, NULL), TYN_OK);
    // An image of another size.
    small.color.state = s.color_before;
    small.depth.state = s.depth_before;
    assert_int_not_equal(record_frame(ctx, cmd, &scene, &view, &small, &s, m, NULL), TYN_OK);
    // A number that is none.
    tyn_scene broken = scene;
    broken.media[0].sigma_s[1] = NAN;
    assert_int_not_equal(record_frame(ctx, cmd, &broken, &view, &t, &s, m, NULL), TYN_OK);
    // A frame without what it requires.
    assert_int_not_equal(tyn_context_record(ctx, NULL), TYN_OK);
    assert_int_not_equal(tyn_context_record(ctx, tyn_frame(.cmd = cmd)), TYN_OK);
    assert_true(f->errors >= 5);
    f->quiet = false;
    f->errors = 0;

    // The command buffer is good, the images are as they were handed over.
    end_frame(f, cmd, &t);
    host_submit(&f->host, 0);
    host_wait(&f->host, 0);
    assert_memory_equal(t.color_down.data, t.color_up.data, t.color_up.size);
    assert_memory_equal(t.depth_down.data, t.depth_up.data, t.depth_up.size);

    // And the context still works.
    cmd = host_begin(&f->host, 1);
    begin_frame(f, cmd, &t, &s);
    assert_int_equal(record_frame(ctx, cmd, &scene, &view, &t, &s, m, NULL), TYN_OK);
    end_frame(f, cmd, &t);
    host_submit(&f->host, 1);
    host_wait(&f->host, 1);
    check_composite(&t, &p);

    tyn_context_destroy(&ctx);
    free_target(&f->host, &t);
    free_target(&f->host, &small);
    free_picture(&p);
    expect_silence(f);
    tyn_scene_finish(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(images_in_any_layout),
        cmocka_unit_test(surfaces_stop_the_light),
        cmocka_unit_test(contexts_share_a_device),
        cmocka_unit_test(density_of_the_host),
        cmocka_unit_test(settings_change),
        cmocka_unit_test(failing_record_changes_nothing),
        cmocka_unit_test(hooks_come_before_the_composite),
    };
    return cmocka_run_group_tests_name("embed", tests, set_up, tear_down);
}
