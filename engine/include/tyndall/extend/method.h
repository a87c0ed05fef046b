// method.h -- a method: what it can do, and how it declares a frame as a choice among sources, solvers and views. Tier 10.
#pragma once
#include "limits.h"
#include "view.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct tyn_method {
    // traces_rays: wants refs.geometry.nodes and refs.emitters where there are surfaces, and refs.areas for a balance.
    // info.passes and info.plugin are filled by the registry, and limits that are NULL by one row that says so.
    tyn_method_info info;
    // The names of the passes that it may declare, in the order of the frame, NULL at the
    // end. The bundles of sources.h, field.h and view.h are lists for it: {TYN_SUN_PASSES(TYN_PASS_NAME), "mine", NULL}.
    const char *const *passes;
    bool reads_env_cdf; // wants refs.env_cdf
    // Largest work a single record may be given (view.num_samples) to keep a dispatch short; NULL if
    // not progressive.
    uint32_t (*batch)(const tyn_job *job);
    // Adds the job's nodes. Called for every frame; it must be cheap and deterministic: no GPU calls, no allocation.
    // What is wrong is one line in job->log and a result that is not TYN_OK.
    tyn_result (*declare)(tyn_graph *g, const tyn_job *job);
} tyn_method;
#define TYN_PASS_NAME(name) #name

// Adds the nodes of another method to the frame and gives what it makes of job->outputs, by TYN_INDEX_*; {0}: it does not make
// it. Its passes must be among those of the method that calls. Hooks are left to the caller. `job` may have a view and a camera of
// its own.
TYN_API tyn_result tyn_job_declare(tyn_graph *g, const tyn_job *job, const char *method,
                                   tyn_ref *made);
// Largest work of a record of it; 1: it is not progressive.
TYN_API uint32_t tyn_job_batch(const tyn_job *job, const char *method);

// Adds a method, or a hook (job.h), to those of the process, for good: its tables must live as long. The names must be new,
// and those of a method's passes known. Else a log line and TYN_ERR_PARAMS, and nothing is added.
TYN_API tyn_result tyn_method_register(const tyn_method *method, const tyn_log *log);
TYN_API tyn_result tyn_picture_hook_register(const tyn_picture_hook *hook, const tyn_log *log);

#ifdef __cplusplus
}
#endif
