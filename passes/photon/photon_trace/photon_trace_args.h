// photon_trace_args.h -- push constants and plan of the photons of a frame. Included by C and GLSL.
#ifndef TYN_PHOTON_TRACE_ARGS_H
#define TYN_PHOTON_TRACE_ARGS_H
#include "shaders/common/shared.h"

#define PHOTON_TRACE_GROUP 64 // threads of a workgroup
#define PHOTON_TRACE_EACH 4   // photons of a thread

#define PHOTON_SIMILARITY_OFF 0
#define PHOTON_SIMILARITY_USUAL 1   // sigma_s (1 - g)
#define PHOTON_SIMILARITY_PRINTED 2 // sigma_s sqrt(1 - g)

// A sun whose beam the march follows and that photons start from as a part of the map: within its disc the map's texel less
// `around` is its light (env_suns.h).
struct photon_map_sun {
    tyn_vec3 direction; // of travel (M)
    float cos_radius;
    tyn_vec3 around; // W/(m^2 sr)
    tyn_uint pad;
};
TYN_ASSERT_SIZE(photon_map_sun, 32);

struct photon_turn_args {
    tyn_uint all, each;  // generations where nothing has been traced yet, and else
    tyn_uint photons;    // of a generation
    tyn_uint dispatches; // at most TYN_PHOTON_DISPATCHES
    tyn_uint batch;      // photons of each
    tyn_uint quads;      // of a slot
    tyn_uint slots;
};
TYN_ASSERT_SIZE(photon_turn_args, 28);

struct photon_trace_plan {
    tyn_vec3 sun;     // reference direction (M), unit, direction of travel; 0: there is none
    float sun_cosine; // light within this cosine of it is the sun's
    tyn_uvec3 dims;   // cells
    tyn_uint photons; // of a generation
    tyn_uint slots;
    tyn_uint lobes;     // of a cell
    tyn_uint sky_first; // that of the map's first region; suns have those before
    float per_unit;     // units per W m
    float least;        // points are examined as densely as this extinction asks for at least, 1/m
    float stop;         // transmittance at which a beam is ended
    tyn_uint roulette;  // 1: by chance, so that nothing is lost on average
    tyn_uint similarity;
    float threshold; // mean cosine of the directions from which on it is used
    float reduced;   // of extinction, what it leaves at most
    float
        per_extinction; // > 0: light is left in proportion to the extinction (delta scaled) times this
    float scaled;       // of extinction, what delta scaling leaves at most; 1: nothing is scaled
    tyn_uint
        beams; // 1: forward scattering counts as none, and so do lights that are marched, until they scatter
    tyn_uint marched[3]; // bits of lights that the march follows
    tyn_uint num_map_suns;
    TYN_STRUCT(photon_map_sun) map_suns[4]; // that it follows, too
};
TYN_ASSERT_SIZE(photon_trace_plan, 228);

#endif
