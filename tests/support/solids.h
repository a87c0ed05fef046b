// solids.h -- surfaces made by hand: quads, boxes, under a material each.
#pragma once
#include <tyndall/scene.h>

// A material; texture none, emission from the front.
uint32_t solids_material(tyn_scene *scene, const float albedo[3], const float emission[3]);

// A parallelogram: corner, corner + u, corner + u + v, corner + v; its front is where u x v points.
void solids_quad(tyn_scene *scene, const float corner[3], const float u[3], const float v[3],
                 uint32_t material);

// The six faces of the box [lo, hi], turned by `angle` (radians) about the vertical axis through its
// centre. Fronts outwards, or inwards: a room.
void solids_box(tyn_scene *scene, const float lo[3], const float hi[3], float angle, bool inwards,
                uint32_t material);

// A sphere of triangles, `rings` (>= 2) from pole to pole about the vertical axis, with the area of the true
// sphere: then its mean shadow and what it emits are true as well.
void solids_sphere(tyn_scene *scene, const float centre[3], float radius, uint32_t rings,
                   bool inwards, uint32_t material);

// Sorts the triangles into a hierarchy of at most `leaf` triangles a leaf: split at the median.
void solids_hierarchy(tyn_scene *scene, uint32_t leaf);

// What a ray meets first, by trying all triangles in double precision.
typedef struct solids_hit {
    int triangle; // -1: none
    double distance, weights[3];
    bool doubtful; // it passes an edge so closely that rounding may decide
} solids_hit;
solids_hit solids_ray(const tyn_surfaces *s, const double origin[3], const double direction[3]);
