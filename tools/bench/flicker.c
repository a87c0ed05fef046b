// flicker.c -- what changes from picture to picture of a camera path and is not smooth motion.
#include "flicker.h"
#include <math.h>
#include <stdlib.h>

bool flicker_open(flicker *f, uint32_t width, uint32_t height)
{
    *f = (flicker){.values = (size_t)3 * width * height};
    for (int i = 0; i < 3; i++) {
        f->last[i] = malloc(f->values * sizeof(float));
    }
    return f->last[0] && f->last[1] && f->last[2];
}

void flicker_close(flicker *f)
{
    for (int i = 0; i < 3; i++) {
        free(f->last[i]);
    }
}

void flicker_add(flicker *f, const float *color)
{
    float *now = f->last[f->frames % 3];
    for (size_t i = 0; color && i < f->values; i++) {
        now[i] = color[4 * (i / 3) + i % 3];
    }
    if (f->frames++ < 2 || !color) {
        return;
    }
    const float *a = f->last[f->frames % 3], *b = f->last[(f->frames + 1) % 3];
    for (size_t i = 0; i < f->values; i++) {
        const double x = b[i], d = (double)a[i] - 2 * x + (double)now[i];
        f->second += fabs(d);
        f->mean += fabs(x);
    }
}

double flicker_value(const flicker *f)
{
    return f->frames >= 3 && f->mean > 0 ? f->second / f->mean : NAN;
}
