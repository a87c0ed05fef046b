// scene_args.h -- the scene as shaders see it. Included by C and GLSL; scalar layout.
//
// Everything is in the medium frame M: a right-handed orthonormal frame in world metres whose origin
// is a corner of the box around all media, so positions inside are in [0, extent]. One unsheared
// medium: M is turned with it, and its grid fills the box exactly. Otherwise M's axes are the world's.
#ifndef TYN_SCENE_ARGS_H
#define TYN_SCENE_ARGS_H
#include "shared.h"
#include "shaders/light/light_args.h"
#include "shaders/phase/phase_args.h"

// How the solvers (not `path`) read the medium.
#define TYN_MEDIUM_DENSITY 0 // one texture: density; coefficients are the constants below
// Textures sigma_s, sigma_a, g, emission (media of unequal coefficients).
#define TYN_MEDIUM_COEFFICIENTS 1
#define TYN_MEDIUM_ONE_PHASE 2 // as COEFFICIENTS, without g: the block has the phase function

#define TYN_SHAPE_KIND_BOX 0
#define TYN_SHAPE_KIND_SPHERE 1
#define TYN_SHAPE_KIND_ANY 2 // of several shapes: some are boxes, some spheres

// Elements that the buffers "shapes", "lights" and "suns" always have; the counts say how many are used.
#define TYN_SHAPES_MAX 64
#define TYN_LIGHTS_MAX 68 // those of a scene and the suns of its environment map

#define TYN_BRICK 8 // medium texels per brick along each axis

struct medium_block { // uniform buffer "medium"
    tyn_vec3 extent;  // of the box, m
    tyn_uint mode;    // TYN_MEDIUM_*
    tyn_uvec3 size;   // texels of the medium texture(s) that the solvers sample; they fill the box
    tyn_uint num_shapes;
    tyn_vec3 voxel;    // extent / size, m
    float max_density; // largest texture value (DENSITY), else 1
    tyn_vec3 sigma_s;  // 1/m at texture value 1 (DENSITY), else 0
    tyn_vec3 sigma_a;
    tyn_phase phase[3];  // of each channel (DENSITY and ONE_PHASE)
    tyn_vec3 emission;   // W/(m^3 sr) at texture value 1
    tyn_uvec3 bricks;    // brick counts, ceil(size / TYN_BRICK)
    tyn_vec3 brick_size; // voxel * TYN_BRICK, m (the last brick may reach beyond the box)
    tyn_uvec3 repeat;    // 1 = periodic along this axis of M with period extent
    // Largest channel of sigma_s + sigma_a at texture value 1 (DENSITY), else 1: what a brick's
    // maximum is multiplied with to give the majorant in 1/m.
    float sigma_t_max;
};
TYN_ASSERT_SIZE(medium_block, 124 + 3 * sizeof(tyn_phase));

// Grids of colours of a shape, each with a place in the texture "colors".
#define TYN_COLORS_EMISSION 0 // `emission` is multiplied with it in place of the density
#define TYN_COLORS_RADIANCE 1 // of black bodies, W/(m^2 sr): times the absorption it is emitted
#define TYN_COLORS_ALBEDO 2   // sigma_s over sigma_s + sigma_a, in place of the coefficients' own
#define TYN_COLORS_NUM 3
struct shape_colors {
    tyn_uvec3 size; // voxels; 0, 0, 0: there is none
    tyn_uint layer; // first z of the texture
    float scale;    // multiplies its texels, which are 0 to 1
};
TYN_ASSERT_SIZE(shape_colors, 20);

struct shape_block { // element of storage buffer "shapes": the exact media, as `path` reads them
    // M -> local unit box [-0.5, 0.5]^3: local_i = dot(rows[i].xyz, p) + rows[i].w.
    tyn_vec4 rows[3];
    tyn_uvec3 size; // voxels of its density grid; (1,1,1) if homogeneous
    tyn_uint kind;  // TYN_SHAPE_KIND_*
    // First texel in the atlas; neighbours in the atlas are never blended in if the texel coordinate is
    // clamped to [0.5, size - 0.5].
    tyn_uvec3 offset;
    tyn_uint pad;
    tyn_vec3 sigma_s; // at atlas value 1; density_scale is in
    tyn_vec3 sigma_a;
    tyn_phase phase[3]; // of each channel
    tyn_vec3 emission;
    TYN_STRUCT(shape_colors) colors[TYN_COLORS_NUM];
};
TYN_ASSERT_SIZE(shape_block, 176 + 3 * sizeof(tyn_phase));

struct camera_block { // uniform buffer "camera"
    tyn_vec3 origin;  // M, m
    tyn_uint orthographic;
    tyn_vec3 right;   // M, unit
    float half_width; // at distance 1 m (perspective) or in m (orthographic)
    tyn_vec3 up;
    float half_height;
    tyn_vec3 forward;
    tyn_uint background; // 1: environment seen through the medium goes into RGB
    tyn_uvec2 size;      // pixels
    tyn_vec2 shift;      // of the principal point, in half sizes (0 = centred)
    // The picture may be a part of another, whose half sizes and shift these are: its first pixel there, and how many pixels
    // that one has more than `size`.
    tyn_uvec2 corner;
    tyn_uvec2 beyond;
};
TYN_ASSERT_SIZE(camera_block, 96);
// Ray through image position (s, t) in [-1, 1], t up: perspective: direction = normalize(forward +
// (s + shift.x) half_width right + (t + shift.y) half_height up), from origin; orthographic: origin
// moved by that, direction forward. Pixel (x, y) of the whole picture, row 0 on top: s = 2 (x + u) / w - 1,
// t = 1 - 2 (y + v) / h with (u, v) in [0, 1)^2.

struct env_block {     // uniform buffer "environment"
    tyn_vec4 rows[3];  // M direction -> map direction (xyz used)
    tyn_vec3 radiance; // multiplies texels; or is the constant radiance
    tyn_uint has_map;  // 0: constant `radiance` (0,0,0 = no environment)
    tyn_vec3 mean;     // mean radiance over the sphere, W/(m^2 sr)
    tyn_uint pad;
    tyn_vec3 sky; // ... without the map's suns, which are in the buffer "suns": Lbar
    tyn_uint pad2;
    tyn_uvec2 size; // texels
    tyn_uvec2 pad3;
};
TYN_ASSERT_SIZE(env_block, 112);

#endif
