// false_colour.h -- pass "false_colour": how thick, how clear or how far the medium is, in colours, in place of its picture.
#pragma once
#include <tyndall/extend/job.h>

typedef struct false_colour_params {
    uint32_t show; // "false_colour.show"
    int32_t of;    // "false_colour.of": FALSE_COLOUR_*
    float most;    // "false_colour.most": what the last colour stands for
} false_colour_params;

// clang-format off
#define FALSE_COLOUR_PORTS(X) \
    X(FALSE_COLOUR, RADIANCE, radiance, IN, IMAGE_2D, "of the picture: its alpha is kept"), \
    X(FALSE_COLOUR, TRANSMITTANCE, transmittance, OPTIONAL, IMAGE_2D, "of the picture"), \
    X(FALSE_COLOUR, DEPTH, depth, OPTIONAL, IMAGE_2D, "of the picture: distances, m"), \
    X(FALSE_COLOUR, COLOURS, colours, OUT, IMAGE_2D, "linear, 0 to 1; a as of radiance", \
        .format = VK_FORMAT_R32G32B32A32_SFLOAT)
// clang-format on
enum { FALSE_COLOUR_PORTS(TYN_PORT_ENUM), FALSE_COLOUR_NUM_PORTS };
extern const tyn_pass_desc pass_false_colour;
extern const tyn_picture_hook hook_false_colour;
