// tags.h -- what an .exr says of its picture: camera, method, settings, samples, and what it is a picture of.
#pragma once
#include "app.h"
#include "method_setup.h"
#include <tyndall/io.h>

// Attributes beside the standard ones ("chromaticities", "software", "worldToCamera", "worldToNDC").
#define TAG_METHOD "tyndall:method"
#define TAG_SETTINGS "tyndall:settings" // JSON, as in the stats
#define TAG_CAMERA "tyndall:camera"     // JSON
#define TAG_SAMPLES "tyndall:samples"   // of each pixel; methods that sample
#define TAG_SEED "tyndall:seed"         // one that takes part, as text: it may be beyond 2^31
#define TAG_SCENE "tyndall:scene"       // hash of all that is seen and of the settings
#define TAG_PARTS "tyndall:parts"       // JSON: which samples of which seeds there are

typedef struct picture_tags {
    const method *method;
    const tyn_scene *scene;
    const tyn_view *view;
    uint32_t samples; // of each pixel that the picture has; 0: the method does not sample
} picture_tags;

// Adds them to the file's attributes. Gives the exit code.
int tags_add(app *a, const picture_tags *tags, tyn_image_file *file);

// A hash of all that decides on the picture, the version too, but for seed and samples.
void tags_hash(const picture_tags *tags, char hash[17]);

// [first, first + count) of the samples of a seed.
typedef struct sample_range {
    uint32_t seed, first, count;
} sample_range;
// Reads TAG_PARTS; freed with free(). NULL: there are none.
sample_range *tags_parts(const tyn_image_file *file, uint32_t *count);
bool tags_set_parts(tyn_image_file *file, const sample_range *parts, uint32_t count);
