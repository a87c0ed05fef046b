// progress.c -- a bar on stderr for what takes over a second.
#include "app.h"
#include <stdio.h>
#include <unistd.h>

enum { BAR_WIDTH = 32 };

void progress_start(progress *p, const char *label, bool quiet)
{
    progress_clear(p);
    double now = app_seconds();
    *p = (progress){.label = label,
                    .start = now,
                    .last_drawn = now,
                    .enabled = !quiet && isatty(STDERR_FILENO)};
}

void progress_update(progress *p, double fraction)
{
    double now = app_seconds();
    if (!p->enabled || now - p->start < 1.0 || now - p->last_drawn < 0.1) {
        return;
    }
    char bar[BAR_WIDTH + 1];
    for (int i = 0; i < BAR_WIDTH; i++) {
        bar[i] = i < fraction * BAR_WIDTH ? '#' : '.';
    }
    bar[BAR_WIDTH] = '\0';
    double left = fraction > 0 ? (now - p->start) * (1 - fraction) / fraction : 0;
    fprintf(stderr, "\r%s [%s] %3.0f %%  %.0f s left \033[K", p->label, bar, 100 * fraction, left);
    fflush(stderr);
    p->last_drawn = now;
    p->drawn = true;
}

void progress_clear(progress *p)
{
    if (p->drawn) {
        fprintf(stderr, "\r\033[K");
        fflush(stderr);
        p->drawn = false;
    }
}
