// gbuffer_args.h -- push constants of the G-buffer.
#ifndef TYN_GBUFFER_ARGS_H
#define TYN_GBUFFER_ARGS_H
#include "shared.h"

struct gbuffer_args {
    tyn_uint samples; // per axis of a pixel
};
TYN_ASSERT_SIZE(gbuffer_args, 4);

#endif
