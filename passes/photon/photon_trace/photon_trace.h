// photon_trace.h -- photons of suns, lamps and the environment, in generations.
//
// The history "ring" keeps what each of the last m generations left in the cells of a lattice. Where it has just been started all
// m are traced, else as many as are renewed in a frame; the node does so until all are of the present scene.
#pragma once
#include <tyndall/pass.h>
#include <tyndall/extend/lattice_shape.h>
#include "shaders/common/bundles.h"
#include "shaders/path/path_scene.h"
#include "photon_trace_args.h"

enum { TYN_PHOTON_DISPATCHES = 512 }; // at most, of all photons of all generations

typedef enum tyn_photon_similarity {
    TYN_PHOTON_SIMILARITY_OFF = 0,
    TYN_PHOTON_SIMILARITY_USUAL,   // sigma_s (1 - g)
    TYN_PHOTON_SIMILARITY_PRINTED, // sigma_s sqrt(1 - g)
} tyn_photon_similarity;

typedef enum tyn_photon_mean {
    TYN_PHOTON_MEAN_VOLUME = 0,
    TYN_PHOTON_MEAN_MEDIUM,
} tyn_photon_mean;

typedef enum tyn_photon_first {
    TYN_PHOTON_FIRST_CACHE = 0,
    TYN_PHOTON_FIRST_BEAMS, // the march follows suns and lamps, delta scaled
} tyn_photon_first;

typedef struct tyn_photon_trace_params {
    tyn_lattice_shape shape; // "photon_trace.cells"
    int32_t photons;         // "photon_trace.photons", of a generation
    int32_t generations;     // "photon_trace.generations", m
    int32_t renewed;         // "photon_trace.renewed", in a frame
    float stop;              // "photon_trace.stop"
    uint32_t roulette;       // "photon_trace.roulette"
    int32_t similarity;      // "photon_trace.similarity"
    float threshold;         // "photon_trace.threshold"
    float points;            // "photon_trace.points"
    int32_t first;           // "photon_trace.first"
    int32_t lobes;           // "photon_trace.lobes"
    int32_t mean;            // "photon_trace.mean"
    // For the method:
    tyn_path_params path;
    float sun[3]; // reference direction (M), unit, of travel; 0: none
    float sun_cosine;
    float power;    // of all lights, rounded up so that it hardly ever changes, W
    float reduced;  // of extinction, what similarity leaves at most
    float scaled;   // ... what delta scaling leaves at most
    float majorant; // of extinction as the photons meet it, 1/m
    // Lights that the march follows: bits by their number in the path tracer's list, and suns of the map.
    uint32_t marched[3];
    uint32_t num_map_suns;
    struct photon_map_sun map_suns[4];
    uint32_t sky_first; // lobe of the map's first region, or of all that is no sun's
    uint32_t batch;     // photons of a dispatch
    uint32_t settles;   // frames until all generations are new
} tyn_photon_trace_params;

// clang-format off
#define PHOTON_TRACE_PORTS(X) \
    TYN_PATH_SCENE(X, PHOTON_TRACE), \
    X(PHOTON_TRACE, ORDINATES, ordinates, OPTIONAL, BUFFER, "struct ordinates_block: regions of the map"), \
    X(PHOTON_TRACE, RING, ring, INOUT, BUFFER, "tyn_photon_ring_size bytes: a history"), \
    X(PHOTON_TRACE, FLUX, flux, INOUT, BUFFER, "tyn_photon_flux_size bytes: a history"), \
    X(PHOTON_TRACE, COUNTERS, counters, OUT, BUFFER, \
        "struct counters_block: points examined, photons that were not followed to their end"), \
    X(PHOTON_TRACE, PLAN, plan, SCRATCH, BUFFER, "struct photon_trace_plan"), \
    X(PHOTON_TRACE, GROUPS, groups, SCRATCH, BUFFER, "workgroups of each dispatch")
// clang-format on
TYN_PASS(PHOTON_TRACE, photon_trace);

// Bytes of its histories, and of that of photon_cache.
uint64_t tyn_photon_ring_size(const tyn_photon_trace_params *params);
uint64_t tyn_photon_flux_size(const tyn_photon_trace_params *params);
// Lobes for which there is room in a ring of PHOTON_MOST_BYTES; 0: not for one.
uint32_t tyn_photon_most_lobes(const tyn_photon_trace_params *params);
uint64_t tyn_photon_sum_size(const tyn_photon_trace_params *params);
// Units of a cell's words in a watt times metre, in a lattice of these cells.
float tyn_photon_units(const tyn_photon_trace_params *params);
