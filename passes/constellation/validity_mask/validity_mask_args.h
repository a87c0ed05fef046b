// validity_mask_args.h -- push constants of validity_mask. Included by C and GLSL.
#include "../common/slices_args.h"

struct validity_mask_args {
    TYN_STRUCT(slices_args) slices;
};
TYN_ASSERT_SIZE(validity_mask_args, 8);
