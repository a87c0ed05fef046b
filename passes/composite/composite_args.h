// composite_args.h -- push constants of the joint build. Included by C and GLSL.
#include "shaders/common/shared.h"

struct composite_args {
    tyn_vec4 depth; // of the host's depth: tyn_job.host_depth; all 0: there is none
};
TYN_ASSERT_SIZE(composite_args, 16);
