// exposure.c -- which exposure shows a picture, and how much of it one cuts.
#include "exposure.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { STOPS = 64, BINS_A_STOP = 16, NUM_BINS = 2 * STOPS * BINS_A_STOP };
static const double brightest = 0.01; // part of the lit pixels that may be beyond 1

float exposure_find(const float *rgba, size_t pixels)
{
    size_t *bins = calloc(NUM_BINS, sizeof *bins), lit = 0, above = 0;
    int bin = NUM_BINS;
    for (size_t i = 0; bins && i < pixels; i++) {
        const float most = fmaxf(fmaxf(rgba[4 * i], rgba[4 * i + 1]), rgba[4 * i + 2]);
        if (isfinite(most) && most > 0) {
            const float at = (log2f(most) + STOPS) * BINS_A_STOP;
            bins[at <= 0 ? 0 : at >= NUM_BINS ? NUM_BINS - 1 : (int)at]++;
            lit++;
        }
    }
    while (bins && lit && bin > 0 && (double)(above += bins[bin - 1]) <= brightest * (double)lit) {
        bin--;
    }
    free(bins);
    return lit ? STOPS - (float)bin / BINS_A_STOP : 0;
}

double exposure_clipped(const uint8_t *rgba, size_t pixels)
{
    size_t clipped = 0;
    for (size_t i = 0; i < pixels; i++) {
        clipped += rgba[4 * i] == 255 || rgba[4 * i + 1] == 255 || rgba[4 * i + 2] == 255;
    }
    return pixels ? (double)clipped / (double)pixels : 0;
}

bool exposure_parse(const char *text, float *ev, bool *automatic)
{
    char *end;
    *automatic = text && strcmp(text, "auto") == 0;
    *ev = text && !*automatic ? strtof(text, &end) : 0;
    return !text || *automatic || (end != text && *end == '\0' && fabsf(*ev) <= STOPS);
}
