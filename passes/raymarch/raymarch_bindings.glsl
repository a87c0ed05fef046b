// raymarch_bindings.glsl -- what the kernels of the ray march read and write, and their constants.
#ifndef TYN_RAYMARCH_BINDINGS_GLSL
#define TYN_RAYMARCH_BINDINGS_GLSL
#include "scene_args.h"
#include "counters.h"
#include "raymarch_args.h"
#include "light_cells_args.h"

// Specialisation constant 0 is the medium's mode (medium.glsl).
layout(constant_id = 1) const uint raymarch_num_suns = 1u;
layout(constant_id = 2) const uint raymarch_features = 0u;
layout(constant_id = 3) const uint raymarch_num_lamps = 0u;
layout(constant_id = 4) const uint raymarch_num_near = 0u; // lamps after these that are marched nearby only
layout(constant_id = 5) const uint raymarch_num_shapes = 1u;
layout(constant_id = 6) const uint raymarch_kind = 0u; // of all shapes, or TYN_SHAPE_KIND_ANY

#define MEDIUM_BLOCK 0
#define MEDIUM_DENSITY 1
#define BEAM_BLOCKS 2
#define BEAM_UNIFORM
#define BEAM_COLUMN 3
#define SCATTER_LUT 4
#define SCATTER_LUT_BLOCK 5
#define SCATTER_LUT_SOFT ((raymarch_features & RAYMARCH_SOFT_SUNS) != 0u)
layout(binding = 6) uniform sampler3D distance_tex;
layout(binding = 7) uniform sampler3D inscatter_tex;
layout(binding = 8, scalar) uniform shape_uniform
{
    shape_block shapes[TYN_SHAPES_MAX];
};
layout(binding = 9, scalar) uniform light_uniform
{
    light_block lights[TYN_LIGHTS_MAX];
};
layout(binding = 10, scalar) uniform camera_uniform
{
    camera_block camera;
};
layout(binding = 11, scalar) uniform env_uniform
{
    env_block environment;
};
layout(binding = 12) uniform sampler2D environment_tex;
layout(binding = 13) uniform sampler2D host_depth_tex;
layout(binding = 14, rgba32f) uniform writeonly image2D radiance_image;
layout(binding = 15, rgba32f) uniform writeonly image2D transmittance_image;
layout(binding = 16, rgba32f) uniform writeonly image2D depth_image;
layout(binding = 17, rgba32f) uniform writeonly image2D single_image;
layout(binding = 18, rgba32f) uniform writeonly image2D multiple_image;
layout(binding = 19, scalar) buffer counter_buffer
{
    counters_block counters;
};
layout(binding = 20) uniform sampler3D glow_tex;
layout(binding = 28) uniform sampler2D sparse_tex;
layout(binding = 29, rgba32f) uniform writeonly image2D sparse_image;
layout(binding = 32) uniform sampler3D light_cells_tex;
layout(binding = 30, scalar) buffer sparse_rest_buffer
{
    raymarch_rest head;
    uint blocks[];
} sparse_rest;
#define SURFACE_RADIANCE 21
#define SURFACE_DISTANCES 31
#define WALLS_LINKS 22
#define WALLS_CELLS 23
#define WALLS_TEXELS
#define SHADOW_ATLAS 24
#define SHADOW_LIGHTS 25
#define RADIAL_BLOCK 26
#define RADIAL_COLUMN 27
#define LATTICE_ROOMS 33
#ifndef RAYMARCH_GREY
#define MEDIUM_SIGMA_A 34
#define MEDIUM_G 35
#define MEDIUM_EMISSION 36
#define BEAM_TAU_A 37
#define BEAM_TAU_P 38
#define RADIAL_TAU_A 39
#define RADIAL_TAU_P 40
#endif

layout(push_constant, scalar) uniform Args
{
    raymarch_args args;
};

#endif
