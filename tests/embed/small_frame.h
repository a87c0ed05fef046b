// small_frame.h -- a host whose frames are cheap: one medium in a box over 32 x 32 pixels, on a driver in between
// (kernel_driver.h), with a job system that runs what it was given when it is told so.
#pragma once
#include "host.h"
#include "kernel_driver.h"
#include <pthread.h>
#include <tyndall/context.h>

enum { SIDE = 32, MAX_JOBS = 256 };

typedef struct job {
    void (*run)(void *job);
    void *job;
} job;

typedef struct fixture {
    host host;
    atomic_int errors, warnings; // lines of the log
    host_image color[HOST_SLOTS], depth;
    host_buffer up, down[HOST_SLOTS], depth_up;
    tyn_scene scene;
    tyn_view view;
    float *expected; // the picture of a frame whose kernels are compiled in the call
    // The host's job system: what was handed over and has not been run.
    job jobs[MAX_JOBS];
    uint32_t num_jobs;
    pthread_mutex_t lock;
    bool at_once; // run in submit
} fixture;

typedef struct device_choice {
    uint32_t threads;
    bool jobs;
    const void *blob;
    size_t blob_size;
} device_choice;

tyn_result try_device(fixture *f, device_choice c, tyn_device **dev);
tyn_device *new_device(fixture *f, device_choice c);
tyn_context *new_context(tyn_device *dev);
uint32_t compiled(tyn_device *dev); // kernels

// Runs jobs of the host's until there are none, or `most`; how many it were.
uint32_t run_jobs(fixture *f, uint32_t most);
void *run_all_jobs(void *f); // as a thread's

typedef struct lent_frame {
    tyn_image color, depth;
    tyn_frame frame;
} lent_frame;

// The images are in `before` as targets of copies; after the frame the colour is copied from, the depth read.
void lend(fixture *f, uint32_t slot, bool background, lent_frame *l);
tyn_result prepare(fixture *f, tyn_context *ctx, bool background);
// A command buffer in which the images are painted.
VkCommandBuffer begin(fixture *f, uint32_t slot);
tyn_result record_into(fixture *f, tyn_context *ctx, uint32_t slot, VkCommandBuffer cmd,
                       bool background);
// The host goes on from the states it was promised.
void finish(fixture *f, uint32_t slot, VkCommandBuffer cmd);
tyn_result record(fixture *f, tyn_context *ctx, bool background); // all three
void expect_untouched(const fixture *f);
void expect_picture(const fixture *f, uint32_t slot); // bit by bit
double now(void);                                     // seconds
void wait_for(tyn_context *ctx);                      // until nothing is pending

// Of a group of tests, and of each: no line of the log and no job may be left.
int frame_set_up(void **state);
int frame_tear_down(void **state);
int frame_reset(void **state);
int frame_silent(void **state);
#define TEST(name) cmocka_unit_test_setup_teardown(name, frame_reset, frame_silent)
