// propagate_rect_args.h -- arguments of all kernels. Included by C and GLSL.
#ifndef TYN_PROPAGATE_RECT_ARGS_H
#define TYN_PROPAGATE_RECT_ARGS_H
#include "shared.h"

struct propagate_rect_args {
    tyn_uint cells;
    tyn_uint num_suns;
    tyn_uint channels;
    tyn_uint last_event;
    tyn_uint rate;
};
TYN_ASSERT_SIZE(propagate_rect_args, 20);

#endif
