// resolution.h -- the size of a picture, a whole fraction of the window's, chosen from what earlier pictures took. Pure functions.
#pragma once
#include <stdbool.h>
#include <stdint.h>

// What a picture took.
typedef struct resolution_cost {
    uint32_t divisor; // of the window's width and height
    double ms;        // in all
    double pixels_ms; // of it, what shrinks with the number of pixels
    bool first;       // of its size: it allocates
    bool cold; // of its context: it may have compiled kernels as well, which pixels_ms then holds
} resolution_cost;

double resolution_expected_ms(const resolution_cost *cost, uint32_t divisor);

// For the first picture of a method, which may take anything: some 2048 pixels.
uint32_t resolution_start(uint32_t width, uint32_t height);
// The largest: some 1024 pixels, 1 where the window has no more.
uint32_t resolution_coarsest(uint32_t width, uint32_t height);

// The divisor of the next picture while nothing moves: the finest that is expected to take `bound_ms` at most. The same
// as that of the last picture: none finer is. After a cold picture, which says too much, the next finer one is tried in
// any case; a coarser one follows a picture that took more than twice the bound.
uint32_t resolution_at_rest(const resolution_cost *last, double bound_ms, uint32_t coarsest);

// While something moves.
typedef struct resolution {
    uint32_t divisor; // 0: not known
    uint32_t easy;    // pictures in a row after which a finer one would have fitted
} resolution;
enum { RESOLUTION_EASY = 6 }; // so many make it finer
// After a picture while moving: coarser at once where it took far too long and fewer pixels help, by twice at most;
// finer by one after RESOLUTION_EASY pictures in a row that say it would take 0.6 of the target at most. Between both
// nothing changes, as another size costs a set-up.
void resolution_moved(resolution *r, const resolution_cost *last, double target_ms,
                      uint32_t coarsest);
// From a picture at rest: for the next movement.
void resolution_rested(resolution *r, const resolution_cost *last, double target_ms,
                       uint32_t coarsest);
