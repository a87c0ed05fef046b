// record.h -- a run's record as JSON, kept as a file: what makes a suite resumable and a figure citable.
#pragma once
#include "app.h"
#include "json.h"
#include "suite.h"

enum { BENCH_RECORD_VERSION = 2 };

// What the suite says of a run, into the "run" of a record: its name, group, list and entry.
void record_name_run(cJSON *json, const bench_run *run);

// DIR/records/KEY.json as a record of this run on this scene, or NULL where there is none that is whole and has its
// picture.
cJSON *record_load(const char *folder, const char *key, const bench_scene *scene,
                   const bench_run *run);
// Writes it there (`folder` NULL: nowhere) and replaces it by what a reader of the file sees. Gives the
// exit code.
int record_store(app *a, const char *folder, const char *key, cJSON **record);
