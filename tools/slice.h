// slice.h -- a picture of the middle slice of what a pass made.
#pragma once
#include "app.h"
#include <tyndall/context.h>

// Writes a PNG: one channel grey, two red and green, three or four red, green and blue; black is 0 and
// full the 99th percentile, or, where there are negative values, black is the least and full the largest.
// Small slices are enlarged by a whole number. Gives the exit code.
int slice_write(app *a, const tyn_inspection *inspection, const char *path);
