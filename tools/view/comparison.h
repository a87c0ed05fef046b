// comparison.h -- the method's picture beside that of the progressive path tracer, and how far it is off.
#pragma once
#include "metrics.h"
#include "view/rendering.h"

typedef struct comparison {
    bool on;
    float split; // where the reference begins, in parts of the window's width
    method method;
    rendering rendering;
    bool started; // samples are of what is shown
    bool measured;
    metrics error; // of radiance over blocks of 8x8 pixels
    double last_measured;
} comparison;

enum { COMPARISON_BLOCK = 8 };
