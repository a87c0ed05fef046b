// rendering.h -- a context of the library, frame by frame, on the viewer's device for it.
#pragma once
#include "method_setup.h"
#include "view/gpu.h"
#include <tyndall/context.h>

typedef enum rendering_state {
    RENDERING_DONE = 0,
    RENDERING_BUSY,    // the device computes the frame
    RENDERING_PENDING, // kernels are being compiled: nothing was begun, try again
    RENDERING_FAILED,  // said
} rendering_state;

typedef struct rendering {
    gpu *gpu;
    tyn_method_info method;
    tyn_context *context; // NULL: closed
    gpu_commands commands;
    double started;         // the frame under way, seconds
    uint32_t width, height; // of the last frame
    uint32_t samples;       // a pixel, of progressive methods
    uint32_t batch;         // samples of the next frame
    uint32_t most, added;   // samples: of a frame at most; of the last one
    uint32_t frames;        // since it was opened
    bool resized;           // the last frame is the first of its size
    double ms;              // wall clock of the last frame
} rendering;

bool rendering_open(rendering *r, gpu *g, const method *m);
void rendering_close(rendering *r); // waits for the frame under way

// Begins a frame, if none is under way. Progressive methods choose view->num_samples so that a frame takes about the time
// that rendering_poll is given, and with `more` add to the last frames of the same scene and view.
rendering_state rendering_begin(rendering *r, const tyn_scene *scene, const tyn_view *view,
                                bool more);
// Waits for the frame under way, `seconds` at most.
rendering_state rendering_poll(rendering *r, double seconds, double budget_ms);
uint32_t rendering_pending(const rendering *r); // kernels that are still to be compiled
// Valid until the next frame begins.
const void *rendering_output(const rendering *r, tyn_output output);
// Time of the nodes that work on pixels in the last frame, ms, of one sample: what a smaller picture makes shorter.
double rendering_pixels_ms(const rendering *r);
