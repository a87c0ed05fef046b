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
