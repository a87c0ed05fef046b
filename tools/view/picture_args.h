// picture_args.h -- push constants of the viewer's picture. Included by C and GLSL.
#ifndef PICTURE_ARGS_H
#define PICTURE_ARGS_H

#define PICTURE_SHOWS_RADIANCE 0 // through the tone curve
#define PICTURE_SHOWS_VALUES 1   // three channels, `low` black and `high` full
#define PICTURE_SHOWS_FIRST                                                                        \
    2 // of the first channel, grey, near is bright; 0 and what is not finite: black

#define PICTURE_CURVE_FILMIC 0 // as the library's display output
#define PICTURE_CURVE_LINEAR 1 // clipped at 1
#define PICTURE_CURVE_REINHARD 2

#ifdef __STDC__
#include <stdint.h>
typedef uint32_t picture_uint;
#else
#define picture_uint uint
#endif

struct picture_args {
    float width, height; // of the window, pixels
    float split;         // the reference is shown right of this pixel
    float scale;         // 2^exposure
    float low, high;
    picture_uint shows; // PICTURE_SHOWS_*
    picture_uint curve; // PICTURE_CURVE_*
};

#endif
