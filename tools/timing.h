// timing.h -- medians of frame times: everything anew, or only what a change needs.
#pragma once
#include "renderer.h"

typedef enum timing_change {
    TIMING_COLD = 0,  // every node runs in every frame
    TIMING_UNCHANGED, // nothing changes
    TIMING_CAMERA,    // the camera goes round the middle of the scene
    TIMING_LIGHT,     // the lights turn, point lights get darker
    TIMING_SKY,       // the environment gets darker
} timing_change;

// Renders `frames` frames and gives the median of their times in ms; before them one that is not timed where something
// changes. TIMING_LIGHT leaves the scene's lights turned, TIMING_SKY its environment darker. Gives the exit code.
int timing_run(app *a, renderer *r, tyn_scene *scene, const tyn_view *view, timing_change change,
               uint32_t frames, double *median_ms);

// Turns a camera about +Y round the middle of the scene.
void timing_turn_camera(const tyn_scene *scene, tyn_camera *camera, double radians);

double timing_median(double *values, uint32_t count); // NaN if there are none; sorts
