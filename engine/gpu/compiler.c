// compiler.c -- see compiler.h: the queue of pipelines, the threads that work it off, and the host's jobs.
#include "gpu/compiler.h"
#include "base/clock.h"
#include <signal.h>
#include <stdlib.h>
#include <unistd.h>

// ---- the queue: under the lock ------------------------------------------------------------------

static void push(tyn_compiler *c, tyn_variant *v)
{
    v->state = TYN_VARIANT_QUEUED;
    v->next_queued = NULL;
    *c->last = v;
    c->last = &v->next_queued;
}

static void take(tyn_compiler *c, tyn_variant *v)
{
    tyn_variant **at = &c->first;
    while (*at != v) {
        at = &(*at)->next_queued;
    }
    *at = v->next_queued;
    if (c->last == &v->next_queued) {
        c->last = at;
    }
    v->next_queued = NULL;
    v->state = TYN_VARIANT_NEW;
}

// Lets go of the lock meanwhile.
static void compile(tyn_compiler *c, tyn_variant *v)
{
    v->state = TYN_VARIANT_COMPILING;
    c->running++;
    pthread_mutex_unlock(&c->lock);
    VkPipeline made = VK_NULL_HANDLE;
    bool cached = false;
    const double start = tyn_now_ms();
    const VkResult result = tyn_pipeline_compile(c->dev, v->pipeline, v->spec, &made, &cached);
    const double seconds = 1e-3 * (tyn_now_ms() - start);
    pthread_mutex_lock(&c->lock);
    v->handle = made;
    v->result = result;
    v->state = result == VK_SUCCESS ? TYN_VARIANT_READY : TYN_VARIANT_FAILED;
    c->stats.compiled += result == VK_SUCCESS;
    c->stats.from_cache += result == VK_SUCCESS && cached;
    c->stats.seconds += seconds;
    c->running--;
    pthread_cond_broadcast(&c->done);
}

static void *work(void *compiler)
{
    tyn_compiler *c = compiler;
    pthread_mutex_lock(&c->lock);
    while (!c->closed) {
        tyn_variant *v = c->first;
        if (v) {
            take(c, v);
            compile(c, v);
        } else {
            pthread_cond_wait(&c->more, &c->lock);
        }
    }
    pthread_mutex_unlock(&c->lock);
    return NULL;
}

// One more thread, if there may be one. The host's signals are for the host's threads.
static void start_thread(tyn_compiler *c)
{
    if (c->num_threads == c->max_threads) {
        return;
    }
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    if (pthread_create(&c->threads[c->num_threads], NULL, work, c) == 0) {
        c->num_threads++;
    }
    pthread_sigmask(SIG_SETMASK, &before, NULL);
}

// Gives up the lock and a reference.
static void release(tyn_compiler *c)
{
    const bool last = --c->refs == 0;
    pthread_mutex_unlock(&c->lock);
    if (last) {
        pthread_cond_destroy(&c->more);
        pthread_cond_destroy(&c->done);
        pthread_mutex_destroy(&c->lock);
        free(c);
    }
}

// A job of the host's: the first that is queued by then. There are at least as many jobs as there is queued.
static void run_job(void *compiler)
{
    tyn_compiler *c = compiler;
    pthread_mutex_lock(&c->lock);
    tyn_variant *v = c->first;
    if (v) {
        take(c, v);
        compile(c, v);
    }
    release(c);
}

// ---- life ---------------------------------------------------------------------------------------

tyn_compiler *tyn_compiler_create(tyn_device *dev, uint32_t threads, tyn_jobs jobs)
{
    tyn_compiler *c = calloc(1, sizeof *c);
    if (!c) {
        return NULL;
    }
    const long processors = sysconf(_SC_NPROCESSORS_ONLN);
    const uint32_t fitting = processors > 4 ? 4 : processors > 1 ? (uint32_t)processors - 1 : 1;
    c->dev = dev;
    c->refs = 1;
    c->last = &c->first;
    c->jobs = jobs;
    c->max_threads = threads ? threads : fitting;
    pthread_mutex_init(&c->lock, NULL);
    pthread_cond_init(&c->more, NULL);
    pthread_cond_init(&c->done, NULL);
    return c;
}

void tyn_compiler_destroy(tyn_compiler **compiler)
{
    tyn_compiler *c = *compiler;
    if (!c) {
        return;
    }
    *compiler = NULL;
    pthread_mutex_lock(&c->lock);
    c->closed = true;
    while (c->first) {
        take(c, c->first);
    }
    pthread_cond_broadcast(&c->more);
    while (c->running) {
        pthread_cond_wait(&c->done, &c->lock);
    }
    pthread_mutex_unlock(&c->lock);
    for (uint32_t i = 0; i < c->num_threads; i++) {
        pthread_join(c->threads[i], NULL);
    }
    pthread_mutex_lock(&c->lock);
    release(c);
}

// ---- asking -------------------------------------------------------------------------------------

static tyn_result outcome(const tyn_variant *v, VkResult result)
{
    return tyn_vk_check(v->pipeline->compiler->dev, result, v->pipeline->kernel->name);
}

tyn_result tyn_variant_make(tyn_variant *v)
{
    tyn_compiler *c = v->pipeline->compiler;
    pthread_mutex_lock(&c->lock);
    while (v->state == TYN_VARIANT_COMPILING) {
        pthread_cond_wait(&c->done, &c->lock);
    }
    if (v->state == TYN_VARIANT_QUEUED) {
        take(c, v);
    }
    if (v->state != TYN_VARIANT_READY) {
        compile(c, v);
    }
    const VkResult result = v->result;
    v->state = v->state == TYN_VARIANT_FAILED ? TYN_VARIANT_NEW : v->state;
    pthread_mutex_unlock(&c->lock);
    return outcome(v, result);
}

tyn_result tyn_variant_request(tyn_variant *v)
{
    tyn_compiler *c = v->pipeline->compiler;
    pthread_mutex_lock(&c->lock);
    const tyn_variant_state state = v->state;
    const VkResult result = v->result;
    bool stuck = false;
    if (state == TYN_VARIANT_FAILED) {
        v->state = TYN_VARIANT_NEW;
    } else if (state == TYN_VARIANT_NEW) {
        push(c, v);
        if (c->jobs.submit) {
            c->refs++;
        } else {
            start_thread(c);
            stuck = c->num_threads == 0;
            pthread_cond_signal(&c->more);
        }
    }
    pthread_mutex_unlock(&c->lock);
    if (state == TYN_VARIANT_NEW && c->jobs.submit) {
        c->jobs.submit(c->jobs.user, run_job, c);
    }
    return stuck                         ? tyn_variant_make(v)
           : state == TYN_VARIANT_READY  ? TYN_OK
           : state == TYN_VARIANT_FAILED ? outcome(v, result)
                                         : TYN_PENDING;
}

void tyn_variant_want(tyn_variant *v)
{
    pthread_mutex_lock(&v->pipeline->compiler->lock);
    v->wanted++;
    pthread_mutex_unlock(&v->pipeline->compiler->lock);
}

void tyn_variant_let_go(tyn_variant *v)
{
    tyn_compiler *c = v->pipeline->compiler;
    pthread_mutex_lock(&c->lock);
    v->wanted--;
    if (!v->wanted && v->state == TYN_VARIANT_QUEUED) {
        take(c, v);
    }
    pthread_mutex_unlock(&c->lock);
}

uint32_t tyn_variants_pending(tyn_variant *const *variants, uint32_t count)
{
    uint32_t pending = 0;
    for (uint32_t i = 0; i < count; i++) {
        tyn_compiler *c = variants[i]->pipeline->compiler;
        pthread_mutex_lock(&c->lock);
        pending +=
            variants[i]->state == TYN_VARIANT_QUEUED || variants[i]->state == TYN_VARIANT_COMPILING;
        pthread_mutex_unlock(&c->lock);
    }
    return pending;
}

void tyn_device_pipelines(tyn_device *dev, tyn_pipeline_stats *stats)
{
    if (stats) {
        *stats = (tyn_pipeline_stats){0};
    }
    if (dev && stats) {
        pthread_mutex_lock(&dev->compiler->lock);
        *stats = dev->compiler->stats;
        pthread_mutex_unlock(&dev->compiler->lock);
    }
}
