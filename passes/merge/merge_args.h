// merge_args.h -- push constants of the merge kernel. Included by C and GLSL.
#ifndef TYN_MERGE_ARGS_H
#define TYN_MERGE_ARGS_H
#include "shared.h"

struct merge_args {
    tyn_vec3 tint;
    tyn_uint channels;
};

#endif
