// bands.h -- figures that must stay within recorded bounds: what continuous integration asks a report.
#pragma once
#include "app.h"
#include <cjson/cJSON.h>

// Reads the file (docs/bench.md, "Bands"), so that its faults are known before anything is measured. A file that
// is wrong: one line, EXIT_WRONG. The tree is the caller's to delete in any case.
int bands_load(app *a, const char *path, cJSON **bands);

// Compares a finished report with them, and puts the result into its "bands". One line on stderr for every
// figure that is outside or not there; then EXIT_FAILED.
int bands_apply(app *a, const char *path, const cJSON *bands, cJSON *report);
