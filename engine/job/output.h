// output.h -- what outputs are called in the graph.
#pragma once
#include <tyndall/context.h>

// tyn_output_name, but for PROBE: the counters of the pass `probe` go by that name.
const char *tyn_job_output_name(tyn_output which);
