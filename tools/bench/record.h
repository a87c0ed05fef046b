// record.h -- a run's record as JSON, kept as a file: what makes a suite resumable and a figure citable.
#pragma once
#include "app.h"
#include <cjson/cJSON.h>

enum { BENCH_RECORD_VERSION = 1 };

// A figure of a tree by its path, "errors.0.bias"; NAN where there is none or it is no number.
double json_figure(const cJSON *tree, const char *path);
// A string of an object; "" where there is none.
const char *json_text(const cJSON *object, const char *key);
void json_add_hash(cJSON *object, const char *key, uint64_t hash);
void json_add_date(cJSON *object); // "date": now, UTC

// DIR/records/KEY.json, or NULL where there is none that is whole.
cJSON *record_load(const char *folder, const char *key);
// Writes it there (`folder` NULL: nowhere) and replaces it by what a reader of the file sees. Gives the
// exit code.
int record_store(app *a, const char *folder, const char *key, cJSON **record);
