// method.h -- a method: what it can do, and how it declares a frame as a choice among sources, solvers and views.
//
// `declare` is called for every frame and must be cheap and deterministic: no GPU calls, no allocation.
#pragma once
#include "job/job.h"

typedef struct tyn_method {
    // traces_rays: wants refs.geometry.nodes and refs.emitters where there are surfaces, and refs.areas for a balance.
    tyn_method_info info;
    bool reads_env_cdf; // wants refs.env_cdf
    // Largest work a single record may be given (view.num_samples) to keep a dispatch short; NULL if
    // not progressive.
    uint32_t (*batch)(const tyn_job *job);
    tyn_result (*declare)(tyn_graph *g, const tyn_job *job);
} tyn_method;
