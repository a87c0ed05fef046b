// stress_render.h -- a picture or balance of a case, and what was counted on the way.
#pragma once
#include "app.h"
#include "metrics.h"
#include <cjson/cJSON.h>
#include <tyndall/offline.h>
#include "stress_cases.h"

enum { STRESS_PIXELS = STRESS_SIZE * STRESS_SIZE };

typedef struct stress_picture {
    float rgb[3][STRESS_PIXELS], se[3][STRESS_PIXELS];
    bool has_se;
    double cut;   // share of its paths that were ended by their cap
    double noise; // of block means, relative (metrics.n); 0 without standard errors
} stress_picture;

typedef struct stress_counts {
    double non_finite, negative; // values
    double cut;                  // paths ended by the safety cap
    double clamped;              // cells, pixels and so on whose light was negative and set to 0
    double hidden;               // that light, as a share: of the node where it is largest
    double paths;                // how many there were
    double ms;
    cJSON *warnings; // array, the caller's
    char *failure;   // NULL, or why the method gave nothing; the caller's
} stress_counts;

// How long a sampling method goes on: until the noise of blocks is below, or the time is over.
typedef struct stress_effort {
    double noise, seconds;
    uint32_t seed, max_depth;
} stress_effort;

// EXIT_DONE even where the method refuses: counts->failure says why then.
int stress_render(app *a, tyn_device *device, const char *with, const stress_case *c,
                  const stress_effort *effort, stress_picture *picture, stress_counts *counts);
// The imbalance of the worst channel, and its standard error.
int stress_balance(app *a, tyn_device *device, const char *with, const stress_case *c,
                   const stress_effort *effort, double *imbalance, double *se,
                   stress_counts *counts);

void stress_image(const stress_picture *picture, metrics_image *image);
