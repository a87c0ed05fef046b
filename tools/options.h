// options.h -- command-line options as tables.
//
// One table per subcommand drives parsing, `--help` and docs/cli.md. An option names a field of the
// subcommand's argument struct by its offset; groups of options that several subcommands share
// (scene, method, machine) sit in member structs, so a group has an offset of its own.
#pragma once
#include <tyndall/base.h>

typedef enum opt_kind {
    OPT_FLAG = 0, // bool
    OPT_TEXT,     // const char *
    OPT_LIST,     // opt_list: may be given several times
    OPT_UINT,     // uint32_t; default NaN: 0 = not given
    OPT_NUMBER,   // float; NAN = not given
    OPT_VECTOR,   // opt_vector: "X,Y,Z"
    OPT_COLOR,    // opt_vector: "R,G,B", or one number for all three
    OPT_SIZE,     // opt_size: "WxH"
} opt_kind;

typedef enum opt_file {
    OPT_NO_FILE = 0,
    OPT_READS, // the value names a file that is read
    OPT_WRITES,
} opt_file;

enum { OPT_MAX_LIST = 64 };
typedef struct opt_list {
    const char *items[OPT_MAX_LIST];
    uint32_t count;
} opt_list;

typedef struct opt_vector {
    bool given;
    float v[3];
} opt_vector;

typedef struct opt_size {
    uint32_t width, height; // 0: not given
} opt_size;

typedef struct option {
    char letter;      // 'o' for -o, 0 for none
    const char *name; // without dashes; NULL where there is only the letter
    opt_kind kind;
    size_t offset;            // of the field in the group's struct
    const char *value;        // "FILE", "N": how the value is called in the help
    const char *doc;          // one line
    double def, min, max;     // UINT, NUMBER: default and inclusive range (max 0 = no limit)
    const char *const *names; // TEXT: the words allowed, NULL-terminated; NULL = any
    // LIST: what is done with a value as soon as it is read, NULL = nothing. Not TYN_OK: wrong, and a line was logged.
    tyn_result (*given)(const char *value, const tyn_log *log);
    opt_file file; // TEXT, LIST
} option;

typedef struct opt_group {
    const char *title;
    const option *options;
    uint32_t num_options;
    size_t offset; // of the group's struct in the argument struct
} opt_group;

typedef struct opt_positional { // a file that is read
    const char *name, *doc;
    bool required;
    size_t offset; // of a const char * in the argument struct; `repeat`: of an opt_list
    bool repeat;   // the last one only: may be given several times
} opt_positional;

typedef struct app app;
typedef struct command {
    const char *name, *summary;
    const char *details; // paragraphs below the options; may be NULL
    const opt_positional *positionals;
    uint32_t num_positionals;
    const opt_group *groups;
    uint32_t num_groups;
    size_t args_size;
    int (*run)(app *a, const void *args); // gives the exit code
} command;

typedef enum opt_outcome { OPT_RUN = 0, OPT_HELP, OPT_WRONG } opt_outcome;

// Fills `args` (args_size bytes) with the defaults, then with what the command line says. OPT_WRONG:
// one line about the first fault has gone to `log`.
opt_outcome options_parse(const command *cmd, int argc, char **argv, void *args,
                          const tyn_log *log);

// "X,Y,Z", and with `spread` also one number for all three. False: not that.
bool options_vector(const char *text, bool spread, float v[3]);

// The name, or the start of one, that a mistyped one may mean; NULL: none. `name_at` gives NULL behind the last.
const char *options_nearest(const char *typed, const char *(*name_at)(const void *user, uint32_t i),
                            const void *user);

// No file that is written is another that is written or read, by any path. False: said.
bool options_check_files(const command *cmd, const void *args, const tyn_log *log);

void options_help(const command *cmd);     // to stdout
void options_markdown(const command *cmd); // to stdout, one section of docs/cli.md
void options_man(const command *cmd);      // to stdout, a manual page
void options_man_title(const char *name, const char *summary);
void options_bash(const command *const *commands, size_t count); // to stdout, completions
void options_zsh(const command *const *commands, size_t count);
void options_fish(const command *const *commands, size_t count);

// "-o, --output FILE", and "default 64, 1 to 1000" as far as there are any.
void options_left_side(const option *o, char *text, size_t size);
void options_right_side(const option *o, char *text, size_t size);
