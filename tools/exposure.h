// exposure.h -- which exposure shows a picture, and how much of it one cuts.
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// Stops by which all but the brightest hundredth of the lit pixels are below 1 in all channels; 0 where none is lit.
// `rgba`: scene-linear, 4 floats a pixel.
float exposure_find(const float *rgba, size_t pixels);

// Part of the pixels of which a channel is at its largest value. `rgba`: 4 bytes a pixel.
double exposure_clipped(const uint8_t *rgba, size_t pixels);

// "EV" or "auto" (then *automatic). False: neither.
bool exposure_parse(const char *text, float *ev, bool *automatic);
