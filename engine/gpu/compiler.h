// compiler.h -- compiles pipelines in the call, or beside it: on threads of its own, or in the host's jobs.
//
// One a device, and the device's lock: of the table of pipelines, of what is queued, of what was counted. No call of the
// host's (log, jobs) is made under it.
#pragma once
#include "gpu/device.h"
#include <pthread.h>

enum { TYN_MAX_COMPILE_THREADS = 16 };

typedef enum tyn_variant_state {
    TYN_VARIANT_NEW = 0, // nobody has asked for it, or who did has let go of it
    TYN_VARIANT_QUEUED,
    TYN_VARIANT_COMPILING,
    TYN_VARIANT_READY,
    TYN_VARIANT_FAILED, // beside a call: the next who asks is told
} tyn_variant_state;

// A kernel's pipeline for one set of specialisation constants. Lives as long as the device's table.
struct tyn_variant {
    tyn_pipeline *pipeline;
    uint32_t spec[TYN_MAX_SPEC];
    tyn_variant *next; // of the same kernel
    // Under the lock:
    tyn_variant_state state;
    VkPipeline handle; // READY
    VkResult result;   // FAILED
    uint32_t wanted;   // by so many graphs; at 0 it leaves the queue
    tyn_variant *next_queued;
};

// Outlives its device until the host's last job has run, which then finds nothing to do.
struct tyn_compiler {
    pthread_mutex_t lock;
    pthread_cond_t more, done; // in the queue; compiled
    tyn_device *dev;
    uint32_t refs; // the device, and the jobs that have not run
    bool closed;
    tyn_variant *first, **last; // the queue
    uint32_t running;           // under way
    pthread_t threads[TYN_MAX_COMPILE_THREADS];
    uint32_t num_threads, max_threads;
    tyn_jobs jobs;
    tyn_pipeline_stats stats;
};

// `threads` 0: as many as suit the machine. They are started when something is queued. NULL: out of memory.
tyn_compiler *tyn_compiler_create(tyn_device *dev, uint32_t threads, tyn_jobs jobs);
// Empties the queue and waits for what is under way.
void tyn_compiler_destroy(tyn_compiler **compiler);

// Compiles it here, unless it is there or under way elsewhere, which is waited for. What fails is logged.
tyn_result tyn_variant_make(tyn_variant *v);
// TYN_PENDING, TYN_OK, or what came of compiling it beside an earlier call, logged here. Only of what is wanted.
tyn_result tyn_variant_request(tyn_variant *v);
void tyn_variant_want(tyn_variant *v);
void tyn_variant_let_go(tyn_variant *v);
// How many of these are queued or under way.
uint32_t tyn_variants_pending(tyn_variant *const *variants, uint32_t count);
