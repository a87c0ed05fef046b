// renderer.h -- one frame of a method, with progress, that can be interrupted.
#pragma once
#include "app.h"
#include "machine.h"
#include "method_setup.h"
#include <tyndall/offline.h>

// Called between the records of a frame of a method that samples, where so many samples of each pixel are done.
typedef void (*renderer_keep_fn)(void *user, uint32_t samples);

typedef struct renderer {
    tyn_offline *offline;
    bool progressive;
    double setup_ms, frame_ms; // of the last frame
    uint32_t samples;          // that the last frame has done, also when it was interrupted
    renderer_keep_fn keep;     // NULL: nothing is kept while a frame is rendered
    void *keep_user;
    app *a;
    bool labelled; // the frame has a bar
    // What kernels counted in a frame and should not have had to: values that were not finite, paths
    // ended by the safety cap. One line each, NULL = none.
    char *warnings[2];
} renderer;

// Gives the exit code; renderer_close is due in any case.
int renderer_open(app *a, tyn_device *device, const method *m, renderer *r);
void renderer_close(renderer *r);

// Computes one frame with view->num_samples samples (progressive methods) from view->first_sample on. `label` is
// what the progress bar says; NULL = no bar. Gives the exit code, EXIT_INTERRUPTED at Ctrl-C.
int renderer_frame(app *a, renderer *r, const tyn_scene *scene, const tyn_view *view,
                   bool recompute, const char *label);
