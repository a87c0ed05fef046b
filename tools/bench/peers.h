// peers.h -- renderers that are not of this library, in a report: their errors and times come from a file that
// something else has measured (docs/bench.md, "Peers").
#pragma once
#include "suite.h"

typedef struct bench_case bench_case; // measure.h

// Reads and checks such a file. Takes `path` over. False: said.
bool peers_load(app *a, char *path, const bench_suite *suite, bench_peer *peer);

// Adds what the suite's peers have measured in this scene to its runs, after all that is compared among these. Gives
// the scene's list "peers" (docs/report-schema.md). Pictures measured against another reference are left out, and
// said: in a warning, and in the report's list "peers_left_out".
cJSON *peers_add(const bench_case *c, cJSON *runs, cJSON *left_out);

// Says the same of scenes of the suite's peers that the suite does not have.
void peers_unknown(app *a, const bench_suite *suite, cJSON *left_out);
