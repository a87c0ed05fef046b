// raymarch_args.h -- push constants and features of the ray march. Included by C and GLSL.
#include "shaders/common/shared.h"

// Bits of the specialisation constant "features".
#define RAYMARCH_SPEC_FEATURES 2   // number of that constant
#define RAYMARCH_KERNELS (1u << 0) // sunlight scattered forward any number of times, else once only
#define RAYMARCH_FIELD (1u << 1)   // light of the texture inscatter
#define RAYMARCH_ONE_CHANNEL (1u << 2) // inscatter has one channel
#define RAYMARCH_UNSCALED (1u << 3)    // no delta scaling: tau' is tau
#define RAYMARCH_TABLED (1u << 4)      // some phase functions are tables
#define RAYMARCH_EMISSION (1u << 5)
#define RAYMARCH_MEAN (1u << 6) // the mean of the environment came in through the field
#define RAYMARCH_HOST_DEPTH (1u << 7)
#define RAYMARCH_BACKGROUND (1u << 8) // the environment behind the medium is seen
#define RAYMARCH_BEHIND (1u << 9)  // follow every ray to its end: what is behind the medium matters
#define RAYMARCH_ROOMS (1u << 10)  // it is known which cells are joined
#define RAYMARCH_CLOSED (1u << 11) // no light enters through a face at which there is medium
#define RAYMARCH_SUPERSAMPLE (1u << 12)   // four rays where they disagree on which shapes they hit
#define RAYMARCH_TRANSMITTANCE (1u << 13) // layers, as the three below
#define RAYMARCH_DEPTH (1u << 14)
#define RAYMARCH_SINGLE (1u << 15)
#define RAYMARCH_MULTIPLE (1u << 16)
#define RAYMARCH_GLOW (1u << 17)      // what is scattered forward comes from the texture glow
#define RAYMARCH_SOFT_SUNS (1u << 18) // there are suns that are seen under an angle
#define RAYMARCH_SURFACE (1u << 19)   // rays end at the scene's surfaces
#define RAYMARCH_SURFACE_SEEN (1u << 20)
#define RAYMARCH_WALLS (1u << 21)         // surfaces part the cells of inscatter
#define RAYMARCH_SHADOWS (1u << 22)       // surfaces stand before suns and lamps
#define RAYMARCH_REPEAT (1u << 23)        // the medium is periodic
#define RAYMARCH_SPARSE_NODES (1u << 24)  // rays of nodes, into "sparse"
#define RAYMARCH_SPARSE_FILL (1u << 25)   // pixels where that is smooth; the others are listed
#define RAYMARCH_SPARSE_COARSE (1u << 26) // with SPARSE_FILL: nodes of the finer grid
#define RAYMARCH_SPOTS (1u << 27)         // there are lamps that shine in a cone
#define RAYMARCH_SPARSE_PIXELS                                                                     \
    (1u << 28)                    // rays of listed pixels; with SPARSE_NODES args.rays tells which
#define RAYMARCH_NOISE (1u << 29) // places at which medium and light are looked up are moved

#define RAYMARCH_NODES 4 // pixels from a node of the coarsest grid to the next

// args.rays
#define RAYMARCH_ALL_NODES 0
#define RAYMARCH_LISTED_NODES 1
#define RAYMARCH_LISTED_PIXELS 2

struct raymarch_args {
    float step;       // longest step, m
    float longest;    // ... where the medium is so thin that it
    float step_depth; // ... is no deeper than this
    float stop;       // a ray ends where the transmittance is below this
    tyn_vec4 depth;   // of the host's depth: tyn_job.host_depth
    tyn_uvec2 first;  // pixels in which the box of the media may be seen: from `first` ...
    tyn_uvec2 end;    // ... to before `end`
    tyn_vec3 tint;    // of the one channel of inscatter
    float reach;      // of lamps that are marched nearby only, m (radial_reach)
    tyn_uint rays;    // sparse: RAYMARCH_ALL_NODES, ...
    float noise;      // by how much along an axis at most, m
    float noise_size; // of the largest features, m
};
TYN_ASSERT_SIZE(raymarch_args, 76);

// Start of the buffer "rest", twice: of nodes, and of pixels that need rays of their own. A list follows: x | y << 16; when pixels
// are listed, nodes have had their rays.
struct raymarch_rest {
    tyn_uvec3 groups; // of threads, for an indirect dispatch
    tyn_uint count;
};
TYN_ASSERT_SIZE(raymarch_rest, 16);
// groups.x: few, so that the last row of groups is neither long nor empty.
#define RAYMARCH_REST_GROUPS 16u
// So many places may be listed.
#define RAYMARCH_REST_MAX (64u * 65535u * RAYMARCH_REST_GROUPS)
