// view_args.h -- the arguments of `tyndall view`.
#pragma once
#include "machine.h"
#include "method_setup.h"
#include "scene_setup.h"

typedef struct view_args {
    scene_options scene;
    view_options view;
    method_options method;
    machine_options machine;
    const char *output, *stats, *frames, *rebuild;
    float exposure, fps, seconds, target_ms;
    bool validate, busy, orbit, no_panel;
} view_args;
