// measure.h -- one run on one scene: errors, times, nodes, memory, imbalance, flicker, as a record.
#pragma once
#include "reference.h"
#include "suite.h"

// A scene that is being measured.
typedef struct bench_case {
    app *a;
    const bench_machine *machine;
    const bench_suite *suite;
    const bench_scene *spec;
    const char *folder; // of --report; NULL: nothing is kept
    uint32_t blocks[3]; // that errors are of: suite->block, 1, and 0 for FLIP
    tyn_scene scene;
    tyn_view view;
    uint64_t hash; // bench_scene_hash
    bench_reference reference;
} bench_case;

// Opens the scene and a reference that is a file, and closes them: what is wrong with them is said. Gives the exit
// code.
int bench_case_check(app *a, const bench_suite *suite, const bench_scene *spec);

// Loads the scene, and gets its reference; `make`: makes the one that is stored with the suite. Gives the exit code; bench_case_close is due in any case.
int bench_case_open(app *a, const bench_machine *on, const bench_suite *suite,
                    const bench_scene *spec, const char *folder, bool make, bench_case *c);
void bench_case_close(bench_case *c);

// The key of a run's record: of everything that its figures depend on.
int bench_key(bench_case *c, const bench_run *run, char key[17]);

// Measures a run, and gives its record (docs/report-schema.md, "A record"). A method that cannot do the scene
// gives a record that says why, and EXIT_DONE.
int bench_measure(bench_case *c, const bench_run *run, const char *key, cJSON **record);
