// raymarch_args.h -- push constants and features of the ray march. Included by C and GLSL.
#ifndef RAYMARCH_ARGS_H
#define RAYMARCH_ARGS_H
#include "shared.h"

// Bits of the specialisation constant "features".
#define RAYMARCH_FIELD 1u         // light that has scattered more than once: texture inscatter, kernels
#define RAYMARCH_EMISSION 2u
#define RAYMARCH_MEAN 4u          // the mean of the environment came in through the field
#define RAYMARCH_HOST_DEPTH 8u
#define RAYMARCH_BEHIND 16u       // what is behind the medium matters: follow every ray to its end
#define RAYMARCH_TRANSMITTANCE 32u // layers
#define RAYMARCH_DEPTH 64u
#define RAYMARCH_SINGLE 128u
#define RAYMARCH_MULTIPLE 256u

struct raymarch_args {
    float step;      // longest step, m
    float stop;      // a ray ends where the transmittance is below this
    tyn_uint supersample; // 1: four rays where they disagree on which shapes they hit
    tyn_uint pad;
    tyn_vec4 depth;  // p10, p14, p11, p15 of the host's view_to_clip
};
TYN_ASSERT_SIZE(raymarch_args, 32);

#endif
