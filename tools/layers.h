// layers.h -- what a picture is looked at, stored and gone on with by: the one table of layers of .exr files.
#pragma once
#include "view/picture_args.h"
#include <stdbool.h>
#include <stddef.h>
#include <tyndall/context.h>

// X(name, output, start, channels, first, kind, title, shows)
//   start, channels  names in the file: "depth." and "Z"; `first`: which component of the output the first of them is
//   kind             COLOR: the picture itself. SUM: mean over samples; stored as halves, or as floats where it is gone on with.
//                    ROUNDED: as halves. EXACT: as floats. KEPT: as floats, of pictures that are gone on with; not for --aov.
//   title, shows     in the viewer, PICTURE_SHOWS_*; NULL: not there
#define PICTURE_LAYERS(X)                                                                          \
    X("color", RADIANCE, "", "RGBA", 0, COLOR, "radiance", RADIANCE)                               \
    X("transmittance", TRANSMITTANCE, "transmittance.", "RGB", 0, SUM, "transmittance", VALUES)    \
    X("depth", DEPTH, "depth.", "Z", 0, EXACT, "depth of surfaces", FIRST)                         \
    X("depth_t50", DEPTH, "depth_t50.", "Z", 1, EXACT, "depth of transmittance 0.5", FIRST)        \
    X("single", SINGLE, "single.", "RGB", 0, SUM, "single scattering", RADIANCE)                   \
    X("multiple", MULTIPLE, "multiple.", "RGB", 0, SUM, "multiple scattering", RADIANCE)           \
    X("error", ERROR, "error.", "RGB", 0, ROUNDED, "standard error", RADIANCE)                     \
    X("bias", BIAS, "bias.", "RGB", 0, ROUNDED, "estimated error of pop", RADIANCE)                \
    X("albedo", ALBEDO, "albedo.", "RGB", 0, ROUNDED, NULL, VALUES)                                \
    X("normal", NORMAL, "normal.", "XYZ", 0, ROUNDED, NULL, VALUES)                                \
    X("low", LOW, "resume_low.", "RGBA", 0, KEPT, NULL, VALUES)                                    \
    X("deviation", DEVIATION, "resume_deviation.", "RGBA", 0, KEPT, NULL, VALUES)

typedef enum layer_kind {
    LAYER_COLOR = 0,
    LAYER_SUM,
    LAYER_ROUNDED,
    LAYER_EXACT,
    LAYER_KEPT,
} layer_kind;

typedef struct picture_layer {
    const char *name; // as --aov calls it
    tyn_output output;
    const char *start, *channels;
    uint32_t first;
    layer_kind kind;
    const char *title;
    uint32_t shows;
} picture_layer;

#define LAYER_ONE(name, output, start, channels, first, kind, title, shows) +1
enum { NUM_PICTURE_LAYERS = 0 PICTURE_LAYERS(LAYER_ONE) };
extern const picture_layer picture_layers[NUM_PICTURE_LAYERS]; // the picture itself first

// Names for --aov, a blank before each, as a constant.
#define LAYER_AOV_COLOR(name)
#define LAYER_AOV_SUM(name) " " name
#define LAYER_AOV_ROUNDED(name) " " name
#define LAYER_AOV_EXACT(name) " " name
#define LAYER_AOV_KEPT(name)
#define LAYER_AOV(name, output, start, channels, first, kind, title, shows) LAYER_AOV_##kind(name)
#define LAYER_AOV_NAMES "" PICTURE_LAYERS(LAYER_AOV)

// The first layer of an output.
const picture_layer *layer_of_output(tyn_output output);
// The layer that a channel of a file belongs to; NULL: of none.
const picture_layer *layer_of_channel(const char *name);
// "depth.Z", channel 0 of "depth".
void layer_channel_name(const picture_layer *layer, size_t channel, char name[48]);
