// report.h -- records put together: report.json (docs/report-schema.md).
#pragma once
#include "measure.h"

typedef struct bench_report {
    cJSON *root;
    double reference_seconds, measuring_seconds;
} bench_report;

// Head of the report. bench_report_finish is due in any case.
void bench_report_begin(app *a, bench_report *r, const bench_machine *on, const bench_suite *suite);
void bench_report_finish(bench_report *r);

// Adds a scene with its runs (objects "run" of records, taken over) and what follows from them: fronts, times at
// equal error, verdicts. `left_out`: list of {"run", "why"}, taken over.
void bench_report_scene(bench_report *r, const bench_case *c, cJSON *runs, cJSON *left_out);

// What follows from all scenes: headline and ratios.
void bench_report_end(bench_report *r, const bench_suite *suite);
