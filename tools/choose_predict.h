// choose_predict.h -- error and time of a run in a scene, from the stored scenes of the most similar regimes.
#pragma once
#include "choose.h"
#include "regime_limits.h"

// Every stored scene by its distance from a regime, in error and in cost.
typedef struct neighbour {
    const fronts_scene *scene;
    double distance;
} neighbour;
typedef struct neighbours {
    neighbour *error, *cost; // the nearest first
    uint32_t count;
    bool by_pixel;
} neighbours;

// `without` NULL: of all scenes. False: out of memory; neighbours_finish is due in any case.
bool neighbours_make(const fronts *f, const regime *r, const fronts_scene *without, bool by_pixel,
                     neighbours *n);
void neighbours_finish(neighbours *n);

// Has a stored scene measured that run, or can it be had from others of its samples?
bool run_is_known(const fronts_scene *scene, const char *key, uint32_t spp, bool by_pixel);

typedef struct prediction {
    double error;                       // of the medium's light
    double fixed_ms, pixels_ms;         // on the device that was measured
    double error_distance, ms_distance; // of the nearest scene it is taken from
    regime_limit limit;                 // what the error is where that is known to be more
} prediction;

// Of method, settings, samples (0: it does not sample) and a picture of so many pixels. False: never measured.
bool predict(const neighbours *n, const regime *r, const fronts_run *run, uint32_t spp,
             double pixels, prediction *p);

// How the logarithms of the margins grow with the distance: from each stored run of a method, predicted
// from the other scenes. False: out of memory.
typedef struct margin_slopes {
    double error, ms;
} margin_slopes;
bool margins_find(const fronts *f, const char *method, bool by_pixel, margin_slopes *m);
double margin_at(double slope, double distance);

// The part of the light of the picture that the medium sends: errors count relative to it all.
double share_of_medium(const regime *r);
