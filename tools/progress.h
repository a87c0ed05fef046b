// progress.h -- a bar on stderr for what takes over a second.
//
// A thread of its own draws it, so that also a call that says nothing until it is done is seen to run.
// Without a terminal it is a line every ten seconds; with --quiet there is nothing, and no thread.
#pragma once
#include <pthread.h>
#include <stdbool.h>

typedef struct progress {
    pthread_t thread;
    pthread_mutex_t lock; // of all below
    pthread_cond_t stopped;
    const char *label;
    double start;    // seconds
    double fraction; // 0: not known
    double next;     // when the next line is due without a terminal, seconds after the start
    bool running, drawn, lines;
} progress;

void progress_init(progress *p); // once, before all others
// From here to progress_stop the bar is there, with the label (which must live as long).
void progress_start(progress *p, const char *label, bool quiet);
void progress_update(progress *p, double fraction); // 0..1
// Between these two the bar is off the terminal, for a message.
void progress_hold(progress *p);
void progress_release(progress *p);
void progress_stop(progress *p); // may be called without a start
