// surface_args.h -- the triangles of a scene as shaders see them. Included by C and GLSL; scalar layout.
//
// Geometry stays in world space, so that a medium that moves leaves it alone; `surface_block` turns rays
// and points of M into the world and back. Both frames are metric and right-handed: distances agree.
#ifndef TYN_SURFACE_ARGS_H
#define TYN_SURFACE_ARGS_H
#include "shaders/common/shared.h"

#define TYN_SURFACE_DOUBLE_SIDED 1u // emits from both sides; all surfaces reflect on both
#define TYN_SURFACE_NO_TEXTURE 0xffffffffu
#define TYN_SURFACE_STACK 64 // levels of the hierarchy at most, so nodes that wait in a traversal

#define TYN_SURFACE_FEW 32 // triangles of a scene that rays try one after another, at most

struct surface_corners {
    tyn_vec3 v0, v1, v2; // world, m
    tyn_vec3 normal;     // (v1 - v0) x (v2 - v0)
    tyn_vec3 rounding;   // bounds what rounding has done to its components
};
TYN_ASSERT_SIZE(surface_corners, 60);

struct surface_block {    // uniform buffer "surfaces"
    tyn_vec4 to_world[3]; // M -> world: world_i = dot(rows[i].xyz, p) + rows[i].w
    tyn_vec4 from_world[3];
    tyn_vec3 lo; // world box of all triangles, m
    tyn_uint num_triangles;
    tyn_vec3 hi;
    tyn_uint num_nodes; // of the hierarchy: at least a leaf of all triangles
    TYN_STRUCT(surface_corners) few[TYN_SURFACE_FEW]; // the triangles, if there are no more
};
TYN_ASSERT_SIZE(surface_block, 2048);

struct surface_vertex { // element of storage buffer "vertices"
    tyn_vec3 position;  // world, m
    float u;
    tyn_vec3 normal; // world, unit, for shading only; its side is that of the triangle's front
    float v;
};
TYN_ASSERT_SIZE(surface_vertex, 32);

// Front: the side from which v0, v1, v2 run counter-clockwise, in world space (mirrored nodes are turned
// round when they are loaded).
struct surface_triangle { // element of storage buffer "triangles", in the hierarchy's order
    tyn_uint v0, v1, v2, material;
};
TYN_ASSERT_SIZE(surface_triangle, 16);

struct surface_material { // element of storage buffer "materials"
    tyn_vec3 albedo;      // linear, 0 to 1: baseColor (1 - metallic)
    tyn_uint flags;       // TYN_SURFACE_*
    tyn_vec3 emission;    // radiance, W/(m^2 sr)
    tyn_uint texture;     // index of its struct surface_texture, or TYN_SURFACE_NO_TEXTURE
};
TYN_ASSERT_SIZE(surface_material, 32);

// Element of storage buffer "textures": a mip chain in storage buffer "texels".
struct surface_texture {
    tyn_uint first; // texel (a uint: R8 G8 B8 A8, sRGB) of level 0; level l + 1 follows level l
    tyn_uint levels;
    tyn_uvec2 size; // of level 0; level l has max(1, size >> l)
    tyn_uvec2 wrap; // per axis: 0 repeat, 1 clamp, 2 mirror
};
TYN_ASSERT_SIZE(surface_texture, 24);

struct surface_node { // element of storage buffer "nodes": a binary hierarchy, node 0 is the root
    tyn_vec3 lo;      // world, m
    tyn_uint first;   // inner: its two children are `first` and `first` + 1; leaf: first triangle
    tyn_vec3 hi;
    tyn_uint count; // triangles; 0: inner
};
TYN_ASSERT_SIZE(surface_node, 32);

// Triangles that one draw takes: those that may be in a view are a few ranges, as neighbours in space are
// neighbours in the hierarchy's order.
#define TYN_SURFACE_RANGES 4
struct surface_range {
    tyn_uint first, count; // count 0: none
};
TYN_ASSERT_SIZE(surface_range, 8);

#endif
