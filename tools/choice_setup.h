// choice_setup.h -- --max-error and --budget-ms: method and settings that are chosen for a scene.
#pragma once
#include "choose.h"
#include "machine.h"
#include "method_setup.h"

typedef struct choice_options {
    const char *max_error; // "5%", "0.05"; NULL: not asked for
    float budget_ms;       // NAN: not asked for
    const char *blocks;    // "8", "1": of which pixels errors are; NULL: 8
    const char *fronts;    // NULL: those that are compiled in
} choice_options;
extern const option choice_table[];
enum { CHOICE_TABLE_SIZE = 4 };

// What was chosen. `method` is that of the options given, with method, settings and samples put before
// what -D says.
typedef struct chosen {
    method_options method;
    cJSON *json;   // for the stats
    char *warning; // why it is not what was asked for; NULL: it is
    char *texts[OPT_MAX_LIST];
    uint32_t num_texts;
} chosen;

bool choice_is_asked(const choice_options *options);

// False: said. Before any work.
bool choice_check(app *a, const choice_options *options, const method_options *how);

// Chooses for a scene as it is seen by `view`, and says what and why. Gives the exit code; chosen_finish is
// due in any case.
int choice_make(app *a, const choice_options *options, const method_options *how,
                const machine *mach, const tyn_scene *scene, const tyn_view *view, chosen *out);
void chosen_finish(chosen *c);
