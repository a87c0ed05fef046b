// constellation_args.h -- push constants, features and lists of the method constellation. Included by C and GLSL.
#include "shaders/common/shared.h"
#include "../common/slices_args.h"

// Bits of the specialisation constant "features".
#define CONSTELLATION_MASK (1u << 0)          // the image "mask" says where rays begin
#define CONSTELLATION_DISTANCE (1u << 1)      // empty space is skipped
#define CONSTELLATION_PRINTED (1u << 2)       // slices are summed as Eqs 4 and 5 are printed
#define CONSTELLATION_EMISSION (1u << 3)      // media emit
#define CONSTELLATION_HOST_DEPTH (1u << 4)    // rays end at the host's surfaces
#define CONSTELLATION_BACKGROUND (1u << 5)    // the environment behind the medium is seen
#define CONSTELLATION_SURFACE (1u << 6)       // rays end at the scene's surfaces ...
#define CONSTELLATION_SURFACE_SEEN (1u << 7)  // ... which are seen
#define CONSTELLATION_SHADOWS (1u << 8)       // surfaces stand before suns and lamps
#define CONSTELLATION_TRANSMITTANCE (1u << 9) // layers
#define CONSTELLATION_DEPTH (1u << 10)
#define CONSTELLATION_LAMPS (1u << 11) // some lights are points

// Specialisation constant "lighting".
#define CONSTELLATION_ALPHA 0u
#define CONSTELLATION_PRIMARY 1u
#define CONSTELLATION_SHADOWED 2u

struct constellation_args {
    tyn_vec4 depth; // of the host's depth: tyn_job.host_depth
    TYN_STRUCT(slices_args) slices;
    float scale;     // of light that is scattered: 4 pi over the norm
    tyn_uint rounds; // slices that one dispatch lights
    tyn_uint first;  // 1: the dispatch begins the rays
    tyn_uint last;   // 1: it ends them and stores the picture
    // Lights of the list that shine in the dispatch. What is not light is done with light 0, and what has been lit by the
    // last one (light_end: ~0) is left.
    tyn_uint light_begin, light_end;
};
TYN_ASSERT_SIZE(constellation_args, 48);
