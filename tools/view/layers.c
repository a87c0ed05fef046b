// layers.c -- what of a picture can be looked at.
#include "view/layers.h"

const view_layer view_layers[VIEW_NUM_LAYERS] = {
    {"radiance", NULL, TYN_OUTPUT_RADIANCE, PICTURE_SHOWS_RADIANCE, 0, false},
    {"transmittance", "transmittance", TYN_OUTPUT_TRANSMITTANCE, PICTURE_SHOWS_VALUES, 0, false},
    {"single scattering", "single", TYN_OUTPUT_SINGLE, PICTURE_SHOWS_RADIANCE, 0, false},
    {"multiple scattering", "multiple", TYN_OUTPUT_MULTIPLE, PICTURE_SHOWS_RADIANCE, 0, false},
    {"depth of surfaces", "depth", TYN_OUTPUT_DEPTH, PICTURE_SHOWS_FIRST, 0, true},
    {"depth of transmittance 0.5", "depth_t50", TYN_OUTPUT_DEPTH, PICTURE_SHOWS_FIRST, 1, true},
    {"standard error", "error", TYN_OUTPUT_ERROR, PICTURE_SHOWS_RADIANCE, 0, false},
};

uint32_t view_layer_next(uint32_t layer, uint32_t outputs)
{
    do {
        layer = (layer + 1) % VIEW_NUM_LAYERS;
    } while (layer && !(view_layers[layer].output & outputs));
    return layer;
}
