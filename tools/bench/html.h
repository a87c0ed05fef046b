// html.h -- report.json as one self-contained page: plots, tables and pictures, no network, no library.
#pragma once
#include "app.h"
#include <cjson/cJSON.h>

// Writes the page of `report` (docs/report-schema.md) to `path`. Pictures are read from below `dir`, where the
// report names them, and go into the page as linear half floats: at most HTML_PICTURES a scene beside its
// reference, what is on a front first. One that is missing or broken is left out with a warning. Gives the
// exit code.
enum { HTML_PICTURES = 12 };
int html_write(app *a, const cJSON *report, const char *dir, const char *path);
