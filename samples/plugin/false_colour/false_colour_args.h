// false_colour_args.h -- push constants of false_colour. Included by C and GLSL.
#ifndef FALSE_COLOUR_ARGS_H
#define FALSE_COLOUR_ARGS_H
#include "shaders/common/shared.h"

#define FALSE_COLOUR_OPTICAL_DEPTH 0
#define FALSE_COLOUR_TRANSMITTANCE 1
#define FALSE_COLOUR_DISTANCE 2 // to where half of the light from behind is gone

struct false_colour_args {
    tyn_uint of;
    float most;
};
TYN_ASSERT_SIZE(false_colour_args, 8);

#endif
