// runs.h -- all runs of a suite on one scene: taken over from records, or measured.
#pragma once
#include "measure.h"

// The settings of every run and the files of every scene are tried before hours may be spent on the first. Gives the
// exit code.
int bench_check(app *a, const bench_suite *suite);

// Objects "run" of records into `runs`, in the order of the suite; into `left_out` {"run", "group", "why"}. `fresh`: no
// record is taken over. Gives the exit code.
int bench_runs(bench_case *c, bool fresh, cJSON *runs, cJSON *left_out);
