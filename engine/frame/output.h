// output.h -- what outputs are called in the graph, and which the host may lend images for.
#pragma once
#include <tyndall/context.h>

// tyn_output_name, but for PROBE: the counters of the pass `probe` go by that name.
const char *tyn_job_output_name(tyn_output which);

typedef struct tyn_lent_image {
    tyn_output output;
    size_t at;                   // of its pointer in tyn_frame_images
    const char *constant, *what; // in messages
    const char *given, *made;    // in the graph: as it came, and with the result in it
    VkFormat other;              // that it may have besides RGBA32F
    const char *formats;
} tyn_lent_image;

enum { TYN_NUM_LENT = 3 };
extern const tyn_lent_image tyn_lent_images[TYN_NUM_LENT]; // places of tyn_scene_refs.images
const tyn_image *tyn_lent(const tyn_frame_images *images, uint32_t index); // NULL: not lent
