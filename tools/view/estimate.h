// estimate.h -- how far the picture at rest is off, as its method estimates it, and how that falls with the samples.
#pragma once
#include <stdint.h>

enum { ESTIMATE_POINTS = 200 };

typedef struct estimate {
    uint32_t samples;  // of the picture that was estimated; 0: none was
    float error, bias; // relative L1, of the picture and of the unrefined one; 0: not known
    float curve[ESTIMATE_POINTS]; // errors, by estimate_place; 0: none
} estimate;
