// progress.c -- a bar on stderr for what takes over a second.
#include "app.h"
#include <stdio.h>
#include <time.h>
#include <unistd.h>

enum { BAR_WIDTH = 32, LINE_SECONDS = 10 };

void progress_init(progress *p)
{
    *p = (progress){.running = false};
    pthread_mutex_init(&p->lock, NULL);
    pthread_cond_init(&p->stopped, NULL);
}

// With the lock held: what a log keeps.
static void print_line(progress *p, double elapsed)
{
    if (elapsed < p->next) {
        return;
    }
    p->next += LINE_SECONDS;
    fprintf(stderr, "%s: %.0f s", p->label, elapsed);
    if (p->fraction > 0) {
        fprintf(stderr, ", %.0f %%, %.0f s left", 100 * p->fraction,
                elapsed * (1 - p->fraction) / p->fraction);
    }
    fprintf(stderr, "\n");
}

// With the lock held.
static void draw(progress *p)
{
    const double elapsed = app_seconds() - p->start;
    if (p->lines) {
        print_line(p, elapsed);
        return;
    }
    if (elapsed < 1.0) {
        return;
    }
    if (p->fraction > 0) {
        char bar[BAR_WIDTH + 1];
        for (int i = 0; i < BAR_WIDTH; i++) {
            bar[i] = i < p->fraction * BAR_WIDTH ? '#' : '.';
        }
        bar[BAR_WIDTH] = '\0';
        fprintf(stderr, "\r%s [%s] %3.0f %%  %.0f s left\033[K", p->label, bar, 100 * p->fraction,
                elapsed * (1 - p->fraction) / p->fraction);
    } else {
        fprintf(stderr, "\r%s  %.0f s\033[K", p->label, elapsed);
    }
    fflush(stderr);
    p->drawn = true;
}

// With the lock held.
static void clear(progress *p)
{
    if (p->drawn) {
        fprintf(stderr, "\r\033[K");
        fflush(stderr);
        p->drawn = false;
    }
}

static void *draw_until_stopped(void *argument)
{
    progress *p = argument;
    pthread_mutex_lock(&p->lock);
    while (p->running) {
        draw(p);
        struct timespec next;
        clock_gettime(CLOCK_REALTIME, &next);
        next.tv_nsec += 200000000;
        next.tv_sec += next.tv_nsec / 1000000000;
        next.tv_nsec %= 1000000000;
        pthread_cond_timedwait(&p->stopped, &p->lock, &next);
    }
    clear(p);
    pthread_mutex_unlock(&p->lock);
    return NULL;
}

void progress_start(progress *p, const char *label, bool quiet)
{
    progress_stop(p);
    if (quiet) {
        return;
    }
    p->lines = !isatty(STDERR_FILENO);
    p->next = LINE_SECONDS;
    p->label = label;
    p->start = app_seconds();
    p->fraction = 0;
    p->running = true;
    if (pthread_create(&p->thread, NULL, draw_until_stopped, p) != 0) {
        p->running = false;
    }
}

void progress_update(progress *p, double fraction)
{
    pthread_mutex_lock(&p->lock);
    p->fraction = fraction;
    pthread_mutex_unlock(&p->lock);
}

void progress_hold(progress *p)
{
    pthread_mutex_lock(&p->lock);
    clear(p);
}

void progress_release(progress *p)
{
    pthread_mutex_unlock(&p->lock);
}

void progress_stop(progress *p)
{
    if (!p->running) { // only this thread changes it
        return;
    }
    pthread_mutex_lock(&p->lock);
    p->running = false;
    pthread_cond_signal(&p->stopped);
    pthread_mutex_unlock(&p->lock);
    pthread_join(p->thread, NULL);
}
