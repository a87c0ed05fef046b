// gradient_bindings.glsl -- what kernels that follow light have bound in common, and how they do it.
#include "gradient_args.h"
#include "shaders/common/counters.h"
TYN_ARGS(gradient_args args);
#define MEDIUM_AT 0
#include "shaders/medium/medium.glsl"
layout(binding = 5) uniform usamplerBuffer light_list_texels;
#define SHADOWS_AT 6
#include "shaders/light/shadow.glsl"
#define SKY_MAPS_AT 8
#include "shaders/light/sky_maps.glsl"
layout(binding = 10) uniform usamplerBuffer light_shades_texels;
#include "shaders/lattice/lattice.glsl"
layout(binding = 11) uniform sampler3D scattered_tex;
#define WALLS_AT 12
#include "shaders/walls/lattice_walls.glsl"
TYN_UNIFORM(14, camera, camera_block camera);
#include "shaders/common/camera.glsl"
TYN_UPDATE(15, counters, counters_block counters);
#include "passes/light_list/common/light_list.glsl"
#include "passes/light_list/common/light_shades_args.h"
#include "gradient_light.glsl"
