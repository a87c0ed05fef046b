// measuring.h -- the inside of measure.c and measure_json.c: a run while it is being measured.
#pragma once
#include "measure.h"
#include "renderer.h"
#include "times.h"

enum { MAX_NODES = 64 };

// A run that is being measured. Times are NAN where they were not measured.
typedef struct measuring {
    bench_case *c;
    const bench_run *run;
    method method;
    renderer renderer;
    tyn_view view;
    float *planes; // 6 w h: the picture
    metrics_image image;
    metrics errors[BENCH_BLOCKS];
    double flip, fill, setup_ms;
    double ms[NUM_TIMES];
    uint32_t frames[NUM_TIMES]; // that these are medians of
    uint64_t persistent, transient;
    cJSON *nodes, *warnings; // NULL until they are known
    uint32_t num_nodes;
    double node_ms[MAX_NODES];
    double flicker, imbalance[3], imbalance_se[3];
    bool has_balance;
} measuring;

// The record of what was measured; `key`: its name. `reason` NULL: it was measured, else why it was not. Writes the
// picture, too. Gives the exit code; *record is NULL after a failure.
int measuring_record(measuring *m, const char *key, const char *reason, cJSON **record);
