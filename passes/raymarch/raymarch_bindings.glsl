// raymarch_bindings.glsl -- what the kernels of the ray march read and write, and their constants.
#include "shaders/common/scene_args.h"
#include "shaders/common/counters.h"
#include "raymarch_args.h"

// Specialisation constant 0 is the medium's mode (medium.glsl).
layout(constant_id = 1) const uint raymarch_num_suns = 1u;
layout(constant_id = 2) const uint raymarch_features = 0u;
layout(constant_id = 3) const uint raymarch_num_lamps = 0u;
layout(constant_id = 4) const uint raymarch_num_near = 0u; // lamps after these that are marched nearby only
layout(constant_id = 5) const uint raymarch_num_shapes = 1u;
layout(constant_id = 6) const uint raymarch_kind = 0u; // of all shapes, or TYN_SHAPE_KIND_ANY

#define PHASE_TABLES 39
#define PHASE_TABLED ((raymarch_features & RAYMARCH_TABLED) != 0u)
#define MEDIUM_AT 0
#define BEAMS_AT 5
#define SCATTER_LUT 9
#define SCATTER_LUT_BLOCK 10
#define SCATTER_LUT_SOFT ((raymarch_features & RAYMARCH_SOFT_SUNS) != 0u)
layout(binding = 11) uniform sampler3D distance_tex;
layout(binding = 12) uniform sampler3D inscatter_tex;
TYN_UNIFORM(13, shapes, shape_block shapes[TYN_SHAPES_MAX]);
TYN_UNIFORM(14, lights, light_block lights[TYN_LIGHTS_MAX]);
TYN_UNIFORM(15, camera, camera_block camera);
TYN_UNIFORM(16, environment, env_block environment);
layout(binding = 17) uniform sampler2D env_map_wrapped;
layout(binding = 18) uniform sampler2D host_depth_tex;
layout(binding = 19, rgba32f) uniform writeonly image2D radiance_image;
layout(binding = 20, rgba32f) uniform writeonly image2D transmittance_image;
layout(binding = 21, rgba32f) uniform writeonly image2D depth_image;
layout(binding = 22, rgba32f) uniform writeonly image2D single_image;
layout(binding = 23, rgba32f) uniform writeonly image2D multiple_image;
TYN_UPDATE(24, counters, counters_block counters);
layout(binding = 25) uniform sampler3D glow_wrapped;
#define SURFACE_RADIANCE 26
#define GBUFFER_AT 27
#define WALLS_AT 28
#define LATTICE_ROOMS 30
#define SHADOWS_AT 31
#define SHADOWS_STORAGE
#define RADIALS_AT 33
#define RADIALS_STORAGE
layout(binding = 37, rgba32f) uniform image2D sparse_image;
layout(binding = 38, scalar) buffer rest_buffer
{
    raymarch_rest head[2];
    uint places[];
} sparse_rest;

TYN_ARGS(raymarch_args args);
