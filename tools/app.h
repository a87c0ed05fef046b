// app.h -- what all subcommands share: exit codes, messages, interruption, time, text.
#pragma once
#include <tyndall/base.h>
#include "options.h"
#include "progress.h"

enum {
    EXIT_DONE = 0,
    EXIT_FAILED = 1, // no device, out of memory, unwritable file, failed selftest
    EXIT_WRONG = 2,  // arguments or input
    EXIT_INTERRUPTED = 130,
};

struct app {
    const char *command; // name of the subcommand, "" before it is known
    const char *
        within; // the part of an input that is being tried, before every error; NULL: the command line
    bool quiet;
    tyn_log log;           // to stderr; give this to the library
    uint32_t num_errors;   // messages at TYN_LOG_ERROR so far
    char last_error[2048]; // the newest of them
    progress bar;
};

void app_init(app *a);
void app_error(app *a, const char *format, ...) TYN_PRINTF(2, 3); // one line to stderr
void app_warn(app *a, const char *format, ...) TYN_PRINTF(2, 3);
void app_note(app *a, const char *format, ...) TYN_PRINTF(2, 3); // not with --quiet

// What an error calls a value: the option that gave it, or the key in the file that is being tried.
const char *app_word(const app *a, const char *by_option, const char *by_key);

// The exit code for a result. With `input` the call read an input or worked on it: then a file that
// cannot be read, or what this version cannot do yet, is a wrong input. Says what happened where the
// library has not said it.
int app_exit_code(app *a, tyn_result result, bool input);

// True from Ctrl-C, SIGTERM or SIGHUP on. A second one ends the process at once, and two seconds do unless app_exit_code
// is called before.
bool app_interrupted(void);

double app_seconds(void); // monotonic clock

// printf into a new string; NULL if out of memory.
char *text_format(const char *format, ...) TYN_PRINTF(1, 2);
// "5%", "5 %" or "0.05" -> 0.05; NaN: neither.
double text_fraction(const char *text, bool *percent);
bool text_ends_with(const char *text, const char *end); // ignores case
// "dir/smoke.gltf" -> "smoke" (a new string)
char *text_stem(const char *path);
uint64_t text_hash(const void *data, size_t size, uint64_t seed); // FNV-1a

#define ARRAY_SIZE(a) (sizeof(a) / sizeof(a)[0])

// The subcommands.
extern const command cmd_render, cmd_compare, cmd_probe, cmd_balance, cmd_fluxes, cmd_bench,
    cmd_graph, cmd_info, cmd_merge, cmd_selftest, cmd_view;
