// layers.h -- what of a picture can be looked at.
#pragma once
#include "view/picture_args.h"
#include <tyndall/context.h>

typedef struct view_layer {
    const char *name, *aov; // the second as `tyndall render --aov` calls it
    tyn_output output;
    uint32_t shows;     // PICTURE_SHOWS_*
    uint32_t component; // of PICTURE_SHOWS_FIRST, in the output
    bool from_values;   // black and full are the least and the largest value
} view_layer;

enum { VIEW_NUM_LAYERS = 7 };
extern const view_layer view_layers[VIEW_NUM_LAYERS]; // the first is radiance

// The layer after `layer` of those that are made; `outputs`: set of tyn_output.
uint32_t view_layer_next(uint32_t layer, uint32_t outputs);
