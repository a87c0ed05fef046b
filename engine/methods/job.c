// job.c -- what methods give the graph of what a job asks for.
#include "methods/job.h"

const char *tyn_output_name(tyn_output which)
{
    static const char *const names[] = {"radiance", "transmittance", "depth",   "single",
                                        "multiple", "error",         "display", "probe",
                                        "balance",  "composite",     "fluxes"};
    for (uint32_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        if (which == (tyn_output)(1u << i)) {
            return names[i];
        }
    }
    return "unknown";
}

void tyn_job_output(tyn_graph *g, const tyn_job *job, tyn_output which, tyn_ref ref)
{
    if (job->outputs & which) {
        tyn_graph_output(g, tyn_output_name(which), ref,
                         job->readback && which != TYN_OUTPUT_COMPOSITE);
    }
}

void tyn_job_counters(tyn_graph *g, const tyn_job *job, const tyn_pass_desc *pass, tyn_ref ref)
{
    // Named as the pass: the report finds them by the node's name. Unasked, they keep nothing alive.
    if (job->readback && ref.resource) {
        tyn_graph_output(g, pass->name, ref, true);
    }
}
