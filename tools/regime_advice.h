// regime_advice.h -- which assumptions of which method hold in a regime, each with what it rests on.
#pragma once
#include "regime.h"

typedef enum advice_level {
    ADVICE_HOLDS = 0,
    ADVICE_STRAINED, // costs accuracy
    ADVICE_BREAKS,   // do not rely on it
    ADVICE_REFUSED,  // the method does not take such scenes
} advice_level;
extern const char *const advice_level_names[]; // "holds", "strained", "breaks", "refused"

typedef struct advice {
    const char *method;
    advice_level level;
    char text[320];
    const char *source; // page of the documentation with the measurement
} advice;

enum { REGIME_MAX_ADVICE = 16 };
uint32_t regime_advise(const regime *r, advice list[REGIME_MAX_ADVICE]); // their number

// Methods that refuse such scenes, as " single pop-paper ".
const char *regime_refused(const regime *r);
