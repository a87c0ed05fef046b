// path_resources.glsl -- what every tracing kernel of the path tracer reads (set 0, bindings 0 to 17), and
// what it is specialised to.
#ifndef TYN_PATH_RESOURCES_GLSL
#define TYN_PATH_RESOURCES_GLSL
#include "shaders/common/counters.h"
#include "shaders/light/env_args.h"
#include "shaders/common/scene_args.h"
#include "shaders/surfaces/surface_args.h"
#include "shaders/surfaces/surface_table_args.h"

layout(local_size_x = 64) in;

layout(constant_id = 0) const uint SHAPES = 0u;
layout(constant_id = 1) const bool HOMOGENEOUS = false;
layout(constant_id = 2) const bool GREY = false;
layout(constant_id = 3) const uint LIGHTS = 2u;
layout(constant_id = 4) const uint ENVIRONMENT = 2u;
layout(constant_id = 5) const uint FLAGS = 0u;
layout(constant_id = 6) const uint FEW = 0u;
#define SURFACE_FEW FEW
#define SURFACE_KEPT ((FLAGS & TYN_PATH_KEEP_FEW) != 0u)

layout(set = 0, binding = 0) uniform sampler3D atlas;
TYN_UNIFORM(1, medium, medium_block medium_in);
TYN_READ(2, shapes, shape_block shapes[]);
layout(set = 0, binding = 3) uniform sampler3D bricks;
layout(set = 0, binding = 4) uniform usamplerBuffer lights_texels; // light_block: four rows
TYN_UNIFORM(5, environment, env_block env_in);
layout(set = 0, binding = 6) uniform sampler2D env_map_wrapped;
TYN_READ(7, env_table, env_table_block env_table; env_cell env_cells[]);
#define GEOMETRY_AT 8
#define MATERIALS_AT 12
#include "shaders/surfaces/surfaces.glsl"
#define PHASE_TABLES 17
#define PHASE_TABLED ((FLAGS & TYN_PATH_TABLED) != 0u)
TYN_READ(15, emitters, surface_table emitters; surface_cell emitter_cells[]);
layout(set = 0, binding = 16) uniform sampler3D colors;
TYN_ARGS(path_args args_in);

// Copies that live in registers: inside a loop whose lanes diverge, software devices read buffers lane by lane.
medium_block medium;
env_block env;
path_args args;
shape_block path_shapes[TYN_PATH_SHAPES_MAX]; // where there are no more
light_block path_light0; // the only light
vec3 path_atlas_texel;   // 1 / texels of the atlas
vec3 path_colors_texel;  // ... of the grids of colours
vec4 path_emitters;      // centre of the emissive triangles (M) and squared radius

light_block path_light(uint index)
{
    uvec4 rows[4];
    for (uint i = 0u; i < 4u; i++) {
        rows[i] = texelFetch(lights_texels, int(4u * index + i));
    }
    vec4 color = uintBitsToFloat(rows[1]), direction = uintBitsToFloat(rows[2]), disc = uintBitsToFloat(rows[3]);
    return light_block(uintBitsToFloat(rows[0].xyz), rows[0].w, color.rgb, color.a, direction.xyz, direction.w, disc.x,
                       rows[3].y, disc.z, rows[3].w);
}

void path_load()
{
    surface_load_few();
    medium = medium_in;
    args = args_in;
    path_atlas_texel = 1.0 / vec3(textureSize(atlas, 0));
    if ((FLAGS & (TYN_PATH_GLOW | TYN_PATH_ALBEDO)) != 0u) {
        path_colors_texel = 1.0 / vec3(textureSize(colors, 0));
    }
    if (ENVIRONMENT != TYN_PATH_ENV_NONE) {
        env = env_in;
    }
    for (uint i = 0u; i < SHAPES; i++) {
        path_shapes[i] = shapes[i];
    }
    if (LIGHTS == 1u) {
        path_light0 = path_light(0u);
    }
    if ((FLAGS & TYN_PATH_EMITTERS) != 0u) {
        for (uint i = 0u; i < 3u; i++) {
            path_emitters[i] = dot(surfaces.from_world[i], vec4(emitters.centre, 1.0));
        }
        path_emitters.w = emitters.radius * emitters.radius;
    }
}

#endif
