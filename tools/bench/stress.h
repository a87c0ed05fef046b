// stress.h -- numerical stress: every method where numbers get extreme, against answers that are known.
//
// Cases lie on axes (extinction, albedo, g, contrast, scale, grids, storage); docs/stress.md says what
// is tried and against what. The result is the object "stress" of report.json (docs/report-schema.md).
#pragma once
#include "app.h"
#include "machine.h"
#include <cjson/cJSON.h>
#include <tyndall/device.h>

typedef struct stress_options {
    bool quick;          // some cases of every axis: a minute instead of ten
    const char *axis;    // NULL: all
    const char *methods; // names with commas between; NULL: all
} stress_options;

// Runs the cases and prints a line each while `table`; fills the object `stress`. Cells of `before` (NULL: none) that
// are not asked for stay. Gives the exit code.
int stress_run(app *a, tyn_device *device, const stress_options *options, bool table,
               const cJSON *before, cJSON *stress);

bool stress_has_axis(const char *part); // an axis with this in its name
// Is each of the names with commas between a method? Else the first that is not is `name`, as far as there is room.
bool stress_has_methods(const char *methods, char name[64]);

// The heat table: a row of cases for every axis and method, a letter each.
void stress_print(const cJSON *stress);

// What must not be: values that are not finite or negative, and errors above STRESS_LOSSY without a
// warning of the method. Says each in a line; gives their number.
#define STRESS_LOSSY 0.10
uint32_t stress_faults(app *a, const cJSON *stress);

// DIR/stress.json if this build of the library made it on this device; else NULL, and a word if there is another.
cJSON *stress_read(app *a, const char *dir, uint64_t library, tyn_device *device);

// `tyndall bench --stress`: all of it, on the device of `machine`; the object goes to DIR/stress.json and into
// a report.json that is there. EXIT_FAILED if there are faults.
int stress_command(app *a, const machine_options *options, const stress_options *what,
                   const char *report, bool json);
