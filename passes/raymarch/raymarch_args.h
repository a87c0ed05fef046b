// raymarch_args.h -- push constants and features of the ray march. Included by C and GLSL.
#ifndef RAYMARCH_ARGS_H
#define RAYMARCH_ARGS_H
#include "shared.h"

// Bits of the specialisation constant "features".
#define RAYMARCH_KERNELS 1u // sunlight scattered forward any number of times, else once only
#define RAYMARCH_FIELD 2u   // light of the texture inscatter
#define RAYMARCH_EMISSION 4u
#define RAYMARCH_MEAN 8u // the mean of the environment came in through the field
#define RAYMARCH_HOST_DEPTH 16u
#define RAYMARCH_BACKGROUND 32u // the environment behind the medium is seen
#define RAYMARCH_BEHIND 64u     // follow every ray to its end: what is behind the medium matters
#define RAYMARCH_TRANSMITTANCE 128u // layers
#define RAYMARCH_DEPTH 256u
#define RAYMARCH_SINGLE 512u
#define RAYMARCH_MULTIPLE 1024u
#define RAYMARCH_UNSCALED 2048u // no delta scaling: tau' is tau
#define RAYMARCH_SOURCE 4096u   // inscatter is what a metre of any medium sends, not per sigma_s
#define RAYMARCH_ONE_SHAPE 8192u
#define RAYMARCH_ONE_CHANNEL 32768u // inscatter has one channel
#define RAYMARCH_CLOSED 16384u      // no light enters through a face at which there is medium

struct raymarch_args {
    float step;           // longest step, m
    float stop;           // a ray ends where the transmittance is below this
    tyn_uint supersample; // 1: four rays where they disagree on which shapes they hit
    tyn_vec4 depth;       // p10, p14, p11, p15 of the host's view_to_clip
    tyn_uvec2 first;      // pixels in which the box of the media may be seen: from `first` ...
    tyn_uvec2 end;        // ... to before `end`
    tyn_vec3 tint;        // of the one channel of inscatter
};
TYN_ASSERT_SIZE(raymarch_args, 56);

#endif
