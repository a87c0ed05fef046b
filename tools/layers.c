// layers.c -- see layers.h.
#include "layers.h"
#include <stdio.h>
#include <string.h>

const picture_layer picture_layers[NUM_PICTURE_LAYERS] = {
#define ROW(name, output, start, channels, first, kind, title, shows)                              \
    {name, TYN_OUTPUT_##output, start, channels, first, LAYER_##kind, title, PICTURE_SHOWS_##shows},
    PICTURE_LAYERS(ROW)
#undef ROW
};

const picture_layer *layer_of_output(tyn_output output)
{
    size_t i = 0;
    while (picture_layers[i].output != output) {
        i++;
    }
    return &picture_layers[i];
}

const picture_layer *layer_of_channel(const char *name)
{
    for (size_t i = 0; i < NUM_PICTURE_LAYERS; i++) {
        const picture_layer *layer = &picture_layers[i];
        const size_t start = strlen(layer->start);
        if (strncmp(name, layer->start, start) == 0 && name[start] && !name[start + 1] &&
            strchr(layer->channels, name[start])) {
            return layer;
        }
    }
    return NULL;
}

void layer_channel_name(const picture_layer *layer, size_t channel, char name[48])
{
    snprintf(name, 48, "%s%c", layer->start, layer->channels[channel]);
}
