// ceilings.h -- how fast the device at hand is at what passes are made of, and which of it bounds a node.
#pragma once
#include "app.h"
#include <cjson/cJSON.h>
#include <tyndall/context.h>
#include <tyndall/device.h>

typedef struct ceilings { // NAN: not measured
    double fma_gflops;    // 10^9 multiplications and additions a second, in chains of x a + b
    double copy_gb_s;     // 10^9 bytes a second, read and written, of a buffer beyond all caches
    double trilinear_gsamples_s; // 10^9 trilinear fetches of one float a second, along rays
    double exp_gops_s;           // 10^9 exponentials a second
    double dispatch_us;          // of an empty dispatch that waits for the one before
} ceilings;

// A few seconds on a CPU. Gives the exit code.
int ceilings_measure(app *a, tyn_device *device, ceilings *c);
cJSON *ceilings_json(const ceilings *c);

// What a node did, as far as it tells; 0 = it does not.
typedef struct node_work {
    double gpu_ms, flops, bytes, samples, exps;
    uint32_t dispatches;
} node_work;
// From a report: what the passes tell themselves, and what a step of those that march costs at least.
node_work node_work_of(const tyn_node_report *node);

// Which ceiling binds, the one that would take longest for the work, and which part of the node's time
// that is. NULL (and NAN) where the node tells nothing that could bind it.
const char *ceilings_bind(const ceilings *c, const node_work *work, double *fraction);
