// regime_limits.h -- what the methods' tables (tyn_limit) say of a regime: the errors that they are known to make in it,
// whatever was measured elsewhere, and which of their assumptions hold, each with what it rests on.
#pragma once
#include "regime.h"
#include <tyndall/registry.h>

// With so many lattice cells along the longest side.
void regime_figures(const regime *r, double cells, tyn_regime *out);

typedef struct regime_limit {
    const char *key; // tyn_limit.key; NULL: none
    double error;    // of the medium's light, as `compare --block 8` gives it; 0: none is known
} regime_limit;

// Of a method by its name: the largest, and the root of the sum of the squares of all.
regime_limit regime_limit_of(const regime *r, const char *method, double cells);

bool regime_refused(const regime *r, const tyn_method_info *method);

typedef struct advice {
    const char *method;
    tyn_limit_level level;
    char text[320];
    const char *source; // page of the documentation with the measurement
} advice;
extern const char *const advice_level_names[]; // "holds", "strained", "breaks", "refused"

enum { REGIME_MAX_ADVICE = 32 };
uint32_t regime_advise(const regime *r, advice list[REGIME_MAX_ADVICE]); // their number
