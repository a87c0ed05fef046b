// background.c -- kernels compiled beside the frames, by threads of the library's or by a host's jobs.
#include <math.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "small_frame.h"

// ---- who compiles -------------------------------------------------------------------------------

static void threads_compile_and_frames_leave_the_picture_alone(void **state)
{
    fixture *f = *state;
    for (uint32_t threads = 1; threads <= 3; threads += 2) {
        tyn_device *dev = new_device(f, (device_choice){.threads = threads});
        tyn_context *ctx = new_context(dev);
        driver.ms = 10;
        driver.most = 0;
        assert_int_equal(prepare(f, ctx, true), TYN_PENDING);
        const uint32_t all = tyn_context_pending(ctx);
        uint32_t last = all, frames = 0;
        while (prepare(f, ctx, true) == TYN_PENDING) {
            const uint32_t left = tyn_context_pending(ctx);
            assert_true(left <= last);
            last = left;
            assert_int_equal(record(f, ctx, true), TYN_PENDING);
            assert_null(tyn_context_graph(ctx, false)); // nothing is compiled yet
            expect_untouched(f);
            frames++;
            usleep(20000);
        }
        print_message("%u threads: %u kernels, %u frames meanwhile, %d at once\n", threads, all,
                      frames, driver.most);
        assert_true(all >= 5 && frames >= 2);
        assert_int_equal(driver.most, threads);
        assert_int_equal(compiled(dev), all);
        assert_int_equal(tyn_context_pending(ctx), 0);
        assert_int_equal(record(f, ctx, true), TYN_OK);
        expect_picture(f, 0);
        tyn_context_destroy(&ctx);
        tyn_device_destroy(&dev);
    }
}

static void jobs_of_the_host_compile(void **state)
{
    fixture *f = *state;
    tyn_device *dev = new_device(f, (device_choice){.jobs = true});
    tyn_context *ctx = new_context(dev);
    // A frame that was never prepared asks as well.
    assert_int_equal(record(f, ctx, true), TYN_PENDING);
    expect_untouched(f);
    const uint32_t all = tyn_context_pending(ctx);
    assert_int_equal(f->num_jobs, all);
    assert_int_equal(prepare(f, ctx, true), TYN_PENDING); // asks for none twice
    assert_int_equal(f->num_jobs, all);
    assert_int_equal(compiled(dev), 0);
    assert_int_equal(run_jobs(f, 1), 1);
    assert_int_equal(tyn_context_pending(ctx), all - 1);
    pthread_t thread;
    assert_int_equal(pthread_create(&thread, NULL, run_all_jobs, f), 0);
    run_all_jobs(f);
    pthread_join(thread, NULL);
    assert_int_equal(tyn_context_pending(ctx), 0);
    assert_int_equal(compiled(dev), all);
    // It is still to be prepared.
    assert_int_equal(record(f, ctx, true), TYN_PENDING);
    expect_untouched(f);
    assert_int_equal(prepare(f, ctx, true), TYN_OK);
    assert_int_equal(record(f, ctx, true), TYN_OK);
    expect_picture(f, 0);
    assert_int_equal(f->num_jobs, 0);
    tyn_context_destroy(&ctx);
    tyn_device_destroy(&dev);
    // A job system without threads: the call is as if there were no background.
    f->at_once = true;
    dev = new_device(f, (device_choice){.jobs = true});
    ctx = new_context(dev);
    assert_int_equal(prepare(f, ctx, true), TYN_OK);
    assert_int_equal(record(f, ctx, true), TYN_OK);
    expect_picture(f, 0);
    tyn_context_destroy(&ctx);
    tyn_device_destroy(&dev);
}

static void frames_like_before_go_on(void **state)
{
    fixture *f = *state;
    tyn_device *dev = new_device(f, (device_choice){.jobs = true});
    tyn_context *ctx = new_context(dev);
    assert_int_equal(prepare(f, ctx, false), TYN_OK);
    assert_int_equal(record(f, ctx, false), TYN_OK);
    f->view.outputs = TYN_OUTPUT_COMPOSITE | TYN_OUTPUT_DISPLAY; // another kernel
    assert_int_equal(prepare(f, ctx, true), TYN_PENDING);
    assert_true(tyn_context_pending(ctx) > 0);
    f->view.outputs = TYN_OUTPUT_COMPOSITE;
    assert_int_equal(record(f, ctx, true), TYN_OK);
    expect_picture(f, 0);
    // Without `background` the record of what is not prepared fails as it always did.
    f->view.outputs = TYN_OUTPUT_COMPOSITE | TYN_OUTPUT_DISPLAY;
    const VkCommandBuffer cmd = begin(f, 0);
    assert_int_equal(record_into(f, ctx, 0, cmd, false), TYN_ERR_PARAMS);
    assert_int_equal(f->errors, 1);
    f->errors = 0;
    host_submit(&f->host, 0);
    host_wait(&f->host, 0);
    run_all_jobs(f);
    assert_int_equal(prepare(f, ctx, true), TYN_OK);
    assert_int_equal(record(f, ctx, true), TYN_OK);
    expect_picture(f, 0);
    tyn_context_destroy(&ctx);
    tyn_device_destroy(&dev);
}

// Of a frame whose kernels are missing nothing is seen, not the picture before either; a host that does not want the medium to
// blink hands the change to prepare alone until that is done, and records what was.
static void a_change_is_held_back(void **state)
{
    static const float colors[2][3] = {{0, 0, 0}, {2, 1, 1}};
    fixture *f = *state;
    tyn_light *lamp = &f->scene.lights[1];
    *lamp = (tyn_light){.kind = TYN_LIGHT_POINT, .position = {0.2f, 0.3f, 0.1f}};
    f->scene.num_lights = 2; // dark: it is left out
    tyn_device *dev = new_device(f, (device_choice){.jobs = true});
    tyn_context *ctx = new_context(dev);
    assert_int_equal(prepare(f, ctx, false), TYN_OK);
    assert_int_equal(record(f, ctx, false), TYN_OK);
    expect_picture(f, 0);
    memcpy(lamp->color, colors[1], sizeof colors[1]);
    assert_int_equal(prepare(f, ctx, true), TYN_PENDING);
    assert_int_equal(record(f, ctx, true), TYN_PENDING);
    expect_untouched(f);
    uint32_t frames = 0;
    while (prepare(f, ctx, true) == TYN_PENDING) {
        memcpy(lamp->color, colors[0], sizeof colors[0]);
        assert_int_equal(record(f, ctx, true), TYN_OK);
        expect_picture(f, 0);
        memcpy(lamp->color, colors[1], sizeof colors[1]);
        run_jobs(f, 1);
        assert_true(++frames < 50);
    }
    print_message("%u frames as before\n", frames);
    assert_true(frames > 0);
    assert_int_equal(record(f, ctx, true), TYN_OK);
    assert_memory_not_equal(f->down[0].data, f->expected, f->up.size);
    f->scene.num_lights = 1;
    tyn_context_destroy(&ctx);
    tyn_device_destroy(&dev);
}

static void a_call_takes_what_is_queued(void **state)
{
    fixture *f = *state;
    tyn_device *dev = new_device(f, (device_choice){.jobs = true});
    tyn_context *waits = new_context(dev), *calls = new_context(dev);
    assert_int_equal(prepare(f, waits, true), TYN_PENDING);
    const uint32_t all = tyn_context_pending(waits);
    assert_int_equal(prepare(f, calls, false), TYN_OK);
    assert_int_equal(tyn_context_pending(waits), 0);
    assert_int_equal(run_jobs(f, UINT32_MAX), all); // which find nothing left
    assert_int_equal(compiled(dev), all);
    assert_int_equal(prepare(f, waits, true), TYN_OK);
    assert_int_equal(record(f, waits, true), TYN_OK);
    expect_picture(f, 0);
    tyn_context_destroy(&waits);
    tyn_context_destroy(&calls);
    tyn_device_destroy(&dev);
}

// ---- the end comes early ------------------------------------------------------------------------

static void destroyed_while_pending(void **state)
{
    fixture *f = *state;
    // The context: what nobody else wants is not compiled.
    tyn_device *dev = new_device(f, (device_choice){.jobs = true});
    tyn_context *ctx = new_context(dev), *other = new_context(dev);
    assert_int_equal(prepare(f, ctx, true), TYN_PENDING);
    tyn_context_destroy(&ctx);
    run_all_jobs(f);
    assert_int_equal(compiled(dev), 0);
    // What another wants is.
    ctx = new_context(dev);
    assert_int_equal(prepare(f, ctx, true), TYN_PENDING);
    assert_int_equal(prepare(f, other, true), TYN_PENDING);
    const uint32_t all = tyn_context_pending(other);
    tyn_context_destroy(&ctx);
    run_all_jobs(f);
    assert_int_equal(compiled(dev), all);
    assert_int_equal(prepare(f, other, true), TYN_OK);
    tyn_context_destroy(&other);
    tyn_device_destroy(&dev);
    // The device, before the host has run a job.
    dev = new_device(f, (device_choice){.jobs = true});
    ctx = new_context(dev);
    assert_int_equal(prepare(f, ctx, true), TYN_PENDING);
    tyn_context_destroy(&ctx);
    tyn_device_destroy(&dev);
    assert_true(f->num_jobs > 0);
    run_all_jobs(f);
    // The device, while threads of the library's, or jobs, compile.
    for (int jobs = 0; jobs < 2; jobs++) {
        driver.ms = 100;
        dev = new_device(f, (device_choice){.jobs = jobs, .threads = 2});
        ctx = new_context(dev);
        assert_int_equal(prepare(f, ctx, true), TYN_PENDING);
        pthread_t thread;
        if (jobs) {
            assert_int_equal(pthread_create(&thread, NULL, run_all_jobs, f), 0);
        }
        while (!driver.under_way) {
            usleep(500);
        }
        const double start = now();
        tyn_context_destroy(&ctx);
        tyn_device_destroy(&dev);
        assert_int_equal(driver.under_way, 0);
        print_message("%s: destroyed after %.2f s\n", jobs ? "jobs" : "threads", now() - start);
        if (jobs) {
            pthread_join(thread, NULL);
        }
    }
}

// ---- two threads --------------------------------------------------------------------------------

typedef struct user {
    pthread_t thread;
    fixture *f;
    tyn_context *ctx;
    VkCommandBuffer cmd;
    uint32_t slot;
    bool background;
    tyn_result result;
} user;

static void *use(void *arg)
{
    user *u = arg;
    lent_frame l;
    lend(u->f, u->slot, u->background, &l);
    l.frame.cmd = u->cmd;
    while ((u->result = tyn_context_prepare(u->ctx, &l.frame)) == TYN_PENDING) {
        usleep(1000);
    }
    if (u->result == TYN_OK) {
        u->result = tyn_context_record(u->ctx, &l.frame);
    }
    return NULL;
}

static void contexts_of_two_threads_share_pipelines(void **state)
{
    fixture *f = *state;
    for (int kind = 0; kind < 3; kind++) { // nobody, one, both in the background
        tyn_device *dev = new_device(f, (device_choice){.threads = 2});
        user users[HOST_SLOTS];
        driver.ms = 2;
        driver.compile_anew = kind == 1;
        for (int i = 0; i < HOST_SLOTS; i++) {
            users[i] = (user){.f = f,
                              .ctx = new_context(dev),
                              .cmd = begin(f, (uint32_t)i),
                              .slot = (uint32_t)i,
                              .background = i < kind};
        }
        for (int i = 0; i < HOST_SLOTS; i++) {
            assert_int_equal(pthread_create(&users[i].thread, NULL, use, &users[i]), 0);
        }
        for (int i = 0; i < HOST_SLOTS; i++) {
            pthread_join(users[i].thread, NULL);
        }
        for (uint32_t i = 0; i < HOST_SLOTS; i++) {
            assert_int_equal(users[i].result, TYN_OK);
            finish(f, i, users[i].cmd);
            expect_picture(f, i);
            tyn_context_destroy(&users[i].ctx);
        }
        print_message("%d in the background: %u kernels\n", kind, compiled(dev));
        tyn_device_destroy(&dev);
    }
}

// ---- failure ------------------------------------------------------------------------------------

static void what_fails_beside_is_said_by_the_next_call(void **state)
{
    fixture *f = *state;
    tyn_device *dev = new_device(f, (device_choice){.threads = 1});
    tyn_context *ctx = new_context(dev);
    driver.fail = 1;
    assert_int_equal(prepare(f, ctx, true), TYN_PENDING);
    wait_for(ctx);
    assert_int_equal(f->errors, 0); // not by another thread
    assert_int_equal(prepare(f, ctx, true), TYN_ERR_MEMORY);
    assert_int_equal(f->errors, 1);
    assert_int_equal(tyn_context_pending(ctx), 0);
    // The next call tries again.
    assert_int_equal(prepare(f, ctx, true), TYN_PENDING);
    wait_for(ctx);
    assert_int_equal(prepare(f, ctx, true), TYN_OK);
    assert_int_equal(record(f, ctx, true), TYN_OK);
    expect_picture(f, 0);
    // Likewise in the call.
    tyn_context_destroy(&ctx);
    tyn_device_destroy(&dev);
    dev = new_device(f, (device_choice){0});
    ctx = new_context(dev);
    driver.fail = 1;
    assert_int_equal(prepare(f, ctx, false), TYN_ERR_MEMORY);
    assert_int_equal(f->errors, 2);
    assert_int_equal(prepare(f, ctx, false), TYN_OK);
    tyn_context_destroy(&ctx);
    tyn_device_destroy(&dev);
    // Numbers of threads that there are not.
    assert_int_equal(try_device(f, (device_choice){.threads = 17}, &dev), TYN_ERR_PARAMS);
    assert_null(dev);
    assert_int_equal(f->errors, 3);
    f->errors = 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(threads_compile_and_frames_leave_the_picture_alone),
        TEST(jobs_of_the_host_compile),
        TEST(frames_like_before_go_on),
        TEST(a_change_is_held_back),
        TEST(a_call_takes_what_is_queued),
        TEST(destroyed_while_pending),
        TEST(contexts_of_two_threads_share_pipelines),
        TEST(what_fails_beside_is_said_by_the_next_call),
    };
    return cmocka_run_group_tests_name("background", tests, frame_set_up, frame_tear_down);
}
