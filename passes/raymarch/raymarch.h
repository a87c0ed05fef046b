// raymarch.h -- the picture: light of the medium gathered along the rays of a camera.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"
#include "shaders/common/scene_args.h"
#include "shaders/march/inscatter.h"

typedef struct tyn_raymarch_params {
    // "raymarch.step": longest step, in voxels (homogeneous: in steps that resolve the light).
    float step;
    float stop;         // "raymarch.stop": transmittance at which a ray ends
    uint32_t antialias; // "raymarch.antialias": four rays a pixel where they disagree
    uint32_t sparse;    // "raymarch.sparse": fewer rays than pixels where the light is smooth
    float noise;        // "raymarch.noise", voxels
    float noise_size;   // "raymarch.noise_size", voxels
    // Set by the method.
    uint32_t grey;      // 1: one medium (mode DENSITY), equal in all channels
    uint32_t tabled;    // 1: some phase function of the medium is a table (`phases`)
    uint32_t mode;      // TYN_MEDIUM_*
    uint32_t num_suns;  // 0..4
    uint32_t num_lamps; // that are marched: the first of `radials`
    // That are marched nearby only, the next ones; `inscatter` has the rest of their light.
    uint32_t num_near_lamps;
    float reach;          // ... of these, m (shaders/beams/radial.glsl: radial_reach)
    uint32_t spots;       // 1: some of all these shine in a cone only
    uint32_t kernels;     // 1: sunlight scattered forward any number of times (lut); else once only
    uint32_t mean;        // 1: the mean of the environment came in through the field
    uint32_t emissive;    // 1: media emit light
    uint32_t background;  // 1: the environment behind the medium is seen
    uint32_t surfaces;    // 1: so are surfaces; else rays end there, but show the medium alone
    uint32_t layers;      // set of RAYMARCH_LAYER_*
    uint32_t field;       // TYN_INSCATTER_*: what `inscatter` is
    uint32_t one_channel; // 1: inscatter has one channel, to be multiplied with `tint`
    float tint[3];
    uint32_t width, height;
    uint32_t whole[2];  // not {0}: of the picture that this is a part of (tyn_view)
    float extent[3];    // medium_block.extent, m
    float longest_step; // m; a step is no longer than this
    float majorant;     // of sigma_t, 1/m; 0: not known
    // 1: the medium is empty at the faces through which suns shine in, or homogeneous: depths along
    // suns take one fetch.
    uint32_t closed;
    uint32_t num_shapes;
    uint32_t kind;   // of all shapes (TYN_SHAPE_KIND_*), or TYN_SHAPE_KIND_ANY
    uint32_t repeat; // 1: the medium is periodic along an axis
    uint32_t first[2],
        end[2];      // pixels that may see the media (tyn_raymarch_window); all 0: every pixel
    uint32_t across; // the longer side of the whole picture's window; 0: of the whole picture
    // 1: single and multiple are interpolated where the picture is; 0: they have a ray in every pixel.
    uint32_t sparse_layers;
    // 1: rays of nodes and of pixels have kernels of their own. For software devices, which compute both sides of a branch.
    uint32_t parted;
    float depth[4]; // of the host's depth: tyn_job.host_depth
} tyn_raymarch_params;

// Sets first, end and across to a window that holds every pixel from which a ray may meet the media's box. It begins where
// a part of the picture, at a multiple of RAYMARCH_NODES pixels, has the same nodes as the whole (raymarch_sparse.glsl).
void tyn_raymarch_window(tyn_raymarch_params *params, const struct camera_block *camera);

enum {
    RAYMARCH_LAYER_TRANSMITTANCE = 1 << 0,
    RAYMARCH_LAYER_DEPTH = 1 << 1,
    RAYMARCH_LAYER_SINGLE = 1 << 2,
    RAYMARCH_LAYER_MULTIPLE = 1 << 3,
};

// clang-format off
#define RAYMARCH_PORTS(X) \
    TYN_MEDIUM(X##_OPTIONAL, RAYMARCH), \
    X(RAYMARCH, DISTANCE, distance, OPTIONAL, IMAGE_3D, "bricks to the nearest one that is not empty"), \
    X(RAYMARCH, SHAPES, shapes, IN, BUFFER, "struct shape_block[]"), \
    X(RAYMARCH, LIGHTS, lights, IN, BUFFER, "struct light_block[]: directional lights first"), \
    TYN_BEAMS(X##_OPTIONAL, RAYMARCH), \
    TYN_RADIALS(X##_OPTIONAL, RAYMARCH), \
    X(RAYMARCH, PHASES, phases, OPTIONAL, BUFFER, "tables of phase functions"), \
    X(RAYMARCH, LUT, lut, OPTIONAL, IMAGE_2D, "of scatter_lut: with `kernels` and suns"), \
    X(RAYMARCH, LUT_BLOCK, lut_block, OPTIONAL, BUFFER, "struct lut_block: with `kernels` and suns"), \
    X(RAYMARCH, INSCATTER, inscatter, OPTIONAL, IMAGE_3D, "of merge; without it suns and emission only"), \
    TYN_WALLS(X##_OPTIONAL, RAYMARCH), \
    X(RAYMARCH, ROOMS, rooms, OPTIONAL, BUFFER, "of rooms: with walls, what light of inscatter rays are among"), \
    TYN_SHADOWS(X##_OPTIONAL, RAYMARCH), \
    X(RAYMARCH, CAMERA, camera, IN, BUFFER, "struct camera_block"), \
    X(RAYMARCH, ENVIRONMENT, environment, IN, BUFFER, "struct env_block"), \
    X(RAYMARCH, ENV_MAP, env_map, OPTIONAL, IMAGE_2D, "latitude-longitude map, W/(m^2 sr)"), \
    X(RAYMARCH, GLOW, glow, OPTIONAL, IMAGE_3D, \
        "of env_glow, the map scattered forward; without it what is scattered forward comes from the mean " \
        "alone (`mean`)"), \
    X(RAYMARCH, HOST_DEPTH, host_depth, OPTIONAL, IMAGE_2D, "hardware depth of the host's surfaces"), \
    X(RAYMARCH, SURFACE, surface, OPTIONAL, IMAGE_2D, \
        "piece_light.glsl: radiance of the first surfaces, and distance: rays end there", \
        .format = VK_FORMAT_R32G32B32A32_UINT), \
    X(RAYMARCH, SEEN, seen, OPTIONAL, IMAGE_2D, "gbuffer.glsl: share of the pixel that each has", \
        .format = VK_FORMAT_R32_UINT), \
    X(RAYMARCH, RADIANCE, radiance, OUT, RGBA_2D, \
        "radiance W/(m^2 sr); a = 1 - mean transmittance, or 1 where an environment or a surface is seen"), \
    X(RAYMARCH, TRANSMITTANCE, transmittance, OUT, RGBA_2D, \
        "transmittance to the first surface or out of the scene"), \
    X(RAYMARCH, DEPTH, depth, OUT, RGBA_2D, \
        "distance to the first surface, and to where the mean transmittance is 1/2, m; infinity if there is none"), \
    X(RAYMARCH, SINGLE, single, OUT, RGBA_2D, "light that has scattered once"), \
    X(RAYMARCH, MULTIPLE, multiple, OUT, RGBA_2D, "light that has scattered more often, or was emitted"), \
    X(RAYMARCH, COUNTERS, counters, OUT, BUFFER, "struct counters_block"), \
    X(RAYMARCH, SPARSE, sparse, SCRATCH, RGBA_2D, "of one pixel in 2x2: radiance, transmittance and e^-tau'"), \
    X(RAYMARCH, REST, rest, SCRATCH, BUFFER, "pixels that have rays of their own")
// clang-format on
TYN_PASS(RAYMARCH, raymarch);
