// fronts.h -- error and time of methods over their settings, scene by scene: what a choice is made from.
//
// A file of them is what a report of `tyndall bench` says of that, and no more; docs/choosing.md has its
// form. One is compiled into the tool.
#pragma once
#include "app.h"
#include "paces.h"
#include "regime.h"

extern const char fronts_schema[];
enum { FRONTS_VERSION = 1 };

// One run. Errors are those of `tyndall compare` over blocks of 8x8 pixels and over single ones, of pictures
// without background, as the bench takes them.
typedef struct fronts_run {
    char method[24];
    cJSON *settings; // {"lattice.cells": 16}, without "spp"; borrowed from fronts.json
    char *key;       // method and settings as text: the same in two scenes for the same run
    uint32_t spp;    // of methods that sample, else 0
    double cells;    // of the lattice along its longest side, of `pop`
    double error, error_pixel;
    double fixed_ms,
        pixel_ms; // of a cold frame: what does not grow with the picture, and for one pixel
} fronts_run;

typedef struct fronts_scene {
    const char *name;
    regime regime;
    uint32_t width, height;
    fronts_run *runs;
    uint32_t num_runs;
} fronts_scene;

// What was measured on.
typedef struct fronts_device {
    const char *name, *driver;
    paces paces;
} fronts_device;

typedef struct fronts {
    cJSON *json;
    fronts_device device;
    fronts_scene *scenes;
    uint32_t num_scenes;
} fronts;

// Reads FILE, or with NULL what is compiled in. Gives the exit code; fronts_finish is due in any case.
int fronts_open(app *a, const char *path, fronts *f);
void fronts_finish(fronts *f);

// What a report.json says, as a file of fronts. Gives the exit code.
int fronts_write(app *a, const cJSON *report, const char *path);
