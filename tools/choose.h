// choose.h -- method and settings for an error or a time asked for, from stored measurements.
//
// The error and the time of a run in a scene are taken to be those that it has in the stored scenes of the
// most similar regimes. How far such predictions are off is found by making them for each stored scene from
// the others, in proportion to how far the nearest of them is: `margin` is the factor that four in five
// predictions from such a distance stay below, and what is promised includes it. Where a method is known to make
// more of an error in such a regime (regime_limits.h), that is its error, wherever it was measured.
#pragma once
#include "fronts.h"
#include "regime_limits.h"

enum { CHOOSE_NEAREST = 4, CHOOSE_MAX_SPP = 65536 };

typedef struct choose_request {
    double max_error;    // of `compare`; NaN: not asked for
    bool by_pixel;       // errors are of single pixels, not of blocks of 8x8
    bool no_background;  // the picture is the medium alone
    double budget_ms;    // of a cold frame; NaN: not asked for
    const char *method;  // NULL: any
    const char *without; // methods that cannot do the scene, " path single "; NULL: none
    uint32_t width, height;
    paces slowness; // this device's times over those of the fronts' device
} choose_request;

typedef struct choice {
    const fronts_run *run; // method and settings: as it was run in the nearest scene that has it
    uint32_t spp;          // 0: the method does not sample
    double error, ms;      // predicted
    const char *
        limit; // tyn_limit.key: why the error is what it is, where it is known to be that at least; NULL
    double error_margin, ms_margin; // factors that four in five predictions stay below
    bool error_met, budget_met;     // with the margins; true where nothing was asked for
    const fronts_scene *nearest[CHOOSE_NEAREST]; // the most similar first
    double distance[CHOOSE_NEAREST];             // of their regimes
    uint32_t num_nearest;
    // What is beside it: the best of the other kind, for a word about what was traded. NULL: none
    const fronts_run *other;
    double other_error, other_ms;
    uint32_t other_spp;
    const char *other_limit;
} choice;

// False: no stored run is of that method, or out of memory.
bool choose(const fronts *f, const regime *r, const choose_request *request, choice *c);

// Error (on blocks of 8x8, with the background) and time of a cold frame that a method is likely to have as it
// is, on the device that was measured; `spp` 0: it does not sample. False: it has not been measured so, or out
// of memory.
bool choose_outlook(const fronts *f, const regime *r, const char *method, uint32_t spp,
                    uint32_t width, uint32_t height, double *error, double *ms);

// How far two regimes are from each other; at 1 they differ in one respect that matters.
double choose_distance(const regime *a, const regime *b);
