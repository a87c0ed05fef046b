// rendering.h -- a context of the library, frame by frame, on the viewer's device.
#pragma once
#include "method_setup.h"
#include "view/gpu.h"
#include <tyndall/context.h>

typedef enum rendering_state {
    RENDERING_DONE = 0,
    RENDERING_PENDING, // kernels are being compiled: nothing was computed, try again
    RENDERING_FAILED,  // said
} rendering_state;

typedef struct rendering {
    gpu *gpu;
    tyn_method_info method;
    tyn_context *context; // NULL: closed
    gpu_commands commands;
    uint32_t width, height; // of the last frame
    uint32_t samples;       // a pixel, of progressive methods
    uint32_t batch;         // samples of the next frame
    double ms;              // wall clock of the last frame
} rendering;

bool rendering_open(rendering *r, gpu *g, const method *m);
void rendering_close(rendering *r);

// Computes a frame and waits for it. Progressive methods choose view->num_samples so that a frame takes about `budget_ms`,
// and with `more` add to the last frames of the same scene and view.
rendering_state rendering_frame(rendering *r, const tyn_scene *scene, const tyn_view *view,
                                double budget_ms, bool more);
uint32_t rendering_pending(const rendering *r); // kernels that are still to be compiled
// Valid until the next call.
const void *rendering_output(const rendering *r, tyn_output output);
// Time of the nodes that work on pixels in the last frame, ms: what a smaller picture makes shorter.
double rendering_pixels_ms(const rendering *r);
