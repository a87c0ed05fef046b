// reference_scenes.h -- the scenes with surfaces of the shared reference images, and their cameras.
#pragma once
#include "picture.h"

// images/room: a closed room with fog, lit through a hole in its ceiling. 64x64 pixels.
void reference_room(tyn_scene *scene, tyn_view *view);
// images/sphere_em_gG: a black sphere that emits, in the middle of a sphere of fog. 64x64 pixels.
void reference_sphere(tyn_scene *scene, tyn_view *view, float g);
