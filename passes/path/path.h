// path.h -- the unbiased path tracer: images and the light field at points.
#pragma once
#include <tyndall/pass.h>
#include "bundles.h"

// Of both passes. What is not in the parameter table is set by the method.
typedef struct tyn_path_params {
    uint32_t mixture;     // light-lobe mixture sampling; 0 = the phase function alone
    uint32_t equiangular; // equi-angular distances for lamps; 0 = free flights alone
    int32_t max_steps;    // safety cap of one path: tentative collisions and brick crossings

    uint32_t seed;
    uint32_t first_sample, num_samples; // per pixel or point; 0 starts the statistics anew
    uint32_t max_depth;                 // longest path, scatterings; 0 = no limit
    uint32_t rr_depth;                  // Russian roulette from here on; 0 = 4
    uint32_t threads;     // at most, of a dispatch: what keeps one below the time limit
    uint32_t homogeneous; // one shape and no density grid
    uint32_t num_shapes;
    uint32_t sphere;   // the only shape is one
    uint32_t grey;     // sigma_s, sigma_a and g are equal in all channels
    uint32_t repeat;   // some axis is periodic
    uint32_t surfaces; // there are triangles
    uint32_t emitters; // some of them emit and are in the table
    uint32_t emissive;
    uint32_t num_lights;
    uint32_t num_lamps;   // point and spot lights among them
    uint32_t near_lamps;  // those in or near the media
    uint32_t environment; // TYN_PATH_ENV_*
    float sigma_guess;    // typical extinction, 1/m
    float stretch;   // > 1: images and probes draw first flights for so many times the extinction
    uint32_t layers; // images: single, multiple and transmittance as well
    uint32_t opaque; // images: a background is seen, alpha is 1
    uint32_t scattered;  // probes: without light that has not scattered
    float world[3][3];   // probes: the world's axes in M
    float lamp_power[3]; // balance: of the lamps inside, W
    float box[2][3];     // balance of surfaces: corners of the box around everything, M
    uint32_t chunks;     // balance: dispatches of num_samples paths each; fluxes: of each thread
} tyn_path_params;

// What every tracing pass reads.
enum {
    PATH_PORT_ATLAS,       // IN 3D, optional: all density grids
    PATH_PORT_MEDIUM,      // IN buffer struct medium_block
    PATH_PORT_SHAPES,      // IN buffer struct shape_block[]
    PATH_PORT_BRICKS,      // IN 3D, optional: bounds of the density or the extinction, of `medium`
    PATH_PORT_LIGHTS,      // IN buffer struct light_block[], optional
    PATH_PORT_ENVIRONMENT, // IN buffer struct env_block, optional
    PATH_PORT_ENV_MAP,     // IN 2D, optional
    PATH_PORT_ENV_TABLE, // IN buffer struct env_table_block and cells, optional: methods/env_cdf.h
    TYN_GEOMETRY(TYN_BUNDLE_ENUM, PATH),  // IN optional; without nodes all triangles are tried
    TYN_MATERIALS(TYN_BUNDLE_ENUM, PATH), // IN optional
    PATH_PORT_EMITTERS, // IN buffer struct surface_table and cells: methods/surface_tables.h
    PATH_NUM_SCENE_PORTS,
};

// Image. The INOUT ports are histories of the image's size (the last three of 1x1 without layers).
enum {
    PATH_PORT_CAMERA = PATH_NUM_SCENE_PORTS, // IN buffer struct camera_block
    PATH_PORT_MEAN,                          // INOUT 2D RGBA32F: radiance; a = 1 - transmittance
    PATH_PORT_LOW,                           // INOUT: what single precision loses of it
    PATH_PORT_DEVIATION,                     // INOUT: sums of squared deviations
    PATH_PORT_MEAN_SINGLE,                   // INOUT
    PATH_PORT_MEAN_MULTIPLE,                 // INOUT
    PATH_PORT_MEAN_TRANSMITTANCE,            // INOUT
    PATH_PORT_RADIANCE,                      // OUT 2D RGBA32F, W/(m^2 sr); alpha
    PATH_PORT_ERROR,                         // OUT 2D RGBA32F: one standard error of the mean
    PATH_PORT_SINGLE,                        // OUT 2D RGBA32F: first order (1x1 without layers)
    PATH_PORT_MULTIPLE,                      // OUT 2D RGBA32F: higher orders and emission
    PATH_PORT_TRANSMITTANCE,                 // OUT 2D RGBA32F
    PATH_PORT_COUNTERS,                      // OUT buffer struct counters_block, of this record
    PATH_PORT_PARTIALS,                      // SCRATCH
    PATH_PORT_LAYERS,                        // SCRATCH
    PATH_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_path;

// Light field at points.
enum {
    PATH_PROBE_PORT_POINTS = PATH_NUM_SCENE_PORTS, // IN buffer vec3[], M, m
    PATH_PROBE_PORT_STATE,    // INOUT buffer, tyn_path_probe_state_size bytes: a history
    PATH_PROBE_PORT_RESULTS,  // OUT buffer tyn_probe_result[]
    PATH_PROBE_PORT_COUNTERS, // OUT buffer struct counters_block
    PATH_PROBE_PORT_PARTIALS, // SCRATCH
    PATH_PROBE_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_path_probe;

// Where the energy goes.
enum {
    PATH_BALANCE_PORT_STATE =
        PATH_NUM_SCENE_PORTS,   // INOUT buffer, tyn_path_balance_state_size bytes: a history
    PATH_BALANCE_PORT_BALANCE,  // OUT buffer tyn_balance
    PATH_BALANCE_PORT_RESULT,   // OUT buffer struct path_balance_result: values and standard errors
    PATH_BALANCE_PORT_COUNTERS, // OUT buffer struct counters_block
    PATH_BALANCE_PORT_PARTIALS, // SCRATCH
    PATH_BALANCE_PORT_AREAS,    // IN buffer struct surface_table and cells, optional
    PATH_BALANCE_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_path_balance;

// Where the light of suns and surroundings goes.
enum {
    PATH_FLUXES_PORT_STATE =
        PATH_NUM_SCENE_PORTS,  // INOUT buffer, tyn_path_fluxes_state_size bytes: a history
    PATH_FLUXES_PORT_FLUXES,   // OUT buffer tyn_fluxes
    PATH_FLUXES_PORT_COUNTERS, // OUT buffer struct counters_block
    PATH_FLUXES_PORT_PARTIALS, // SCRATCH
    PATH_FLUXES_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_path_fluxes;

// Where surfaces are, in the pixels' middles.
typedef struct tyn_path_distance_params {
    uint32_t width, height; // of the picture
} tyn_path_distance_params;
enum {
    PATH_DISTANCE_PORT_CAMERA,                    // IN buffer struct camera_block
    TYN_GEOMETRY(TYN_BUNDLE_ENUM, PATH_DISTANCE), // IN
    PATH_DISTANCE_PORT_RADIANCE,                  // OUT 2D RG32UI: none, packed_colour.glsl
    PATH_DISTANCE_PORT_DISTANCES,                 // OUT 2D R32F, m; 0: none
    PATH_DISTANCE_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_path_distance;

// Bytes of the probes' history.
uint64_t tyn_path_probe_state_size(uint32_t num_points);
// ... and of a balance's, and of fluxes'.
uint64_t tyn_path_balance_state_size(void);
uint64_t tyn_path_fluxes_state_size(void);
