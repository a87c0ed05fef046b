// constellation.h -- the picture of the method constellation: slices back to front, with a shadow ray per light and slice.
//
// Navarro, Gutierrez and Seron, "Interactive HDR lighting of dynamic participating media" (The Visual Computer 24, 2008),
// sections 3 and 4.3.
#pragma once
#include <tyndall/pass.h>
#include "constellation_args.h"
#include "shaders/common/bundles.h"
#include "shaders/common/scene_args.h"

enum { CONSTELLATION_NORM_4_PI = 0, CONSTELLATION_NORM_16_PI2 };
enum { CONSTELLATION_QUADRATURE_EXACT = 0, CONSTELLATION_QUADRATURE_PRINTED };

enum {
    CONSTELLATION_LAYER_TRANSMITTANCE = 1 << 0,
    CONSTELLATION_LAYER_DEPTH = 1 << 1,
};

typedef struct tyn_constellation_params {
    int32_t lights;     // "constellation.lights": that stand for the environment
    float slice;        // "constellation.slice": distance between slices, voxels
    int32_t lighting;   // "constellation.lighting": CONSTELLATION_ALPHA, _PRIMARY, _SHADOWED
    uint32_t mask;      // "constellation.mask"
    uint32_t distance;  // "constellation.distance"
    int32_t norm;       // "constellation.norm": CONSTELLATION_NORM_*
    int32_t quadrature; // "constellation.quadrature": CONSTELLATION_QUADRATURE_*
    // Set by the method.
    uint32_t mode;       // TYN_MEDIUM_*
    uint32_t emissive;   // 1: media emit light
    uint32_t background; // 1: the environment behind the medium is seen
    uint32_t surfaces;   // 1: so are surfaces; else rays end there, but show the medium alone
    uint32_t layers;     // set of CONSTELLATION_LAYER_*
    uint32_t width, height;
    struct slices_args slices;
    float extent[3];     // medium_block.extent, m
    uint32_t num_lights; // in the list, at most
    uint32_t lamps;      // 1: some of them are lamps
    float depth[4];      // of the host's depth: tyn_job.host_depth
} tyn_constellation_params;

// How rays are cut: slices `slice` voxels apart. A medium counts as one of 64 voxels at least along its longest side, and of
// more where it is thick (`longest_step`, m: no voxel is longer).
struct slices_args tyn_constellation_slices(const struct medium_block *medium, float slice,
                                            float longest_step);

// clang-format off
#define CONSTELLATION_PORTS(X) \
    TYN_MEDIUM(X##_OPTIONAL, CONSTELLATION), \
    X(CONSTELLATION, VOXELS, voxels, OPTIONAL, IMAGE_3D, "of voxel_distance"), \
    X(CONSTELLATION, MASK, mask, OPTIONAL, IMAGE_2D, "of validity_mask; absent: rays begin where they leave the box"), \
    X(CONSTELLATION, LIGHT_LIST, light_list, IN, BUFFER, "of light_list: all lights"), \
    TYN_SHADOWS(X##_OPTIONAL, CONSTELLATION), \
    X(CONSTELLATION, CAMERA, camera, IN, BUFFER, "struct camera_block"), \
    X(CONSTELLATION, ENVIRONMENT, environment, IN, BUFFER, "struct env_block"), \
    X(CONSTELLATION, ENV_MAP, env_map, OPTIONAL, IMAGE_2D, "latitude-longitude map, W/(m^2 sr)"), \
    X(CONSTELLATION, HOST_DEPTH, host_depth, OPTIONAL, IMAGE_2D, "hardware depth of the host's surfaces"), \
    X(CONSTELLATION, SURFACE, surface, OPTIONAL, IMAGE_2D, \
        "piece_light.glsl: radiance of the first surfaces, and distance: rays end there", \
        .format = VK_FORMAT_R32G32B32A32_UINT), \
    X(CONSTELLATION, SEEN, seen, OPTIONAL, IMAGE_2D, "gbuffer.glsl: share of the pixel that each has", \
        .format = VK_FORMAT_R32_UINT), \
    X(CONSTELLATION, RADIANCE, radiance, OUT, RGBA_2D, \
        "radiance W/(m^2 sr); a = 1 - mean transmittance, or 1 where an environment or a surface is seen"), \
    X(CONSTELLATION, TRANSMITTANCE, transmittance, OUT, RGBA_2D, \
        "transmittance to the first surface or out of the scene"), \
    X(CONSTELLATION, DEPTH, depth, OUT, RGBA_2D, \
        "distance to the first surface, and to where the mean transmittance is 1/2, m; infinity if there is " \
        "none"), \
    X(CONSTELLATION, COUNTERS, counters, OUT, BUFFER, "struct counters_block"), \
    X(CONSTELLATION, STATE_LIGHT, state_light, SCRATCH, RGBA_2D, "between dispatches: radiance, next slice"), \
    X(CONSTELLATION, STATE_THROUGH, state_through, SCRATCH, RGBA_2D, \
        "between dispatches: transmittance, where the ray is, m"), \
    X(CONSTELLATION, STATE_UNCOVERED, state_uncovered, SCRATCH, RGBA_2D, \
        "between dispatches: the share of the background")
// clang-format on
TYN_PASS(CONSTELLATION, constellation);
