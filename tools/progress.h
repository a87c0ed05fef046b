// progress.h -- a bar on stderr for what takes over a second.
#pragma once
#include <stdbool.h>

typedef struct progress {
    const char *label;
    double start, last_drawn; // seconds
    bool enabled;             // stderr is a terminal and --quiet was not given
    bool drawn;
} progress;

void progress_start(progress *p, const char *label, bool quiet);
void progress_update(progress *p, double fraction); // 0..1; draws at most ten times a second
void progress_clear(progress *p);                   // takes the bar off the terminal
