// output.h -- the pictures a frame gives: EXR layers and display-ready PNG.
#pragma once
#include "app.h"
#include "tags.h"
#include <tyndall/offline.h>

// What an .exr keeps of a picture that is gone on with.
#define OUTPUT_SUMS (TYN_OUTPUT_LOW | TYN_OUTPUT_DEVIATION)

typedef struct output_plan {
    uint32_t outputs; // set of tyn_output to ask the method for
    uint32_t layers;  // set of indices into the table of layers
    bool full_float;
} output_plan;

// Gives the exit code. `files` are the names of -o; `info` says what the method can make.
int output_plan_make(app *a, const tyn_method_info *info, const opt_list *files, const char *aov,
                     bool full_float, output_plan *plan);

// A file that cannot be written is said before the work, not after it; nothing is touched. False: said. A folder with a
// sequence's number in its name is not known yet, and passes.
bool output_folder_is_writable(app *a, const char *path);

// Writes one file of the last frame; with `sums` an .exr from which it may be gone on with. Gives the exit code.
int output_write(app *a, const output_plan *plan, tyn_offline *offline, const picture_tags *tags,
                 bool sums, const char *path);
