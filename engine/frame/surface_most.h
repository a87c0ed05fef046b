// surface_most.h -- where most triangles are.
#pragma once
#include <stdbool.h>
#include <tyndall/scene.h>

// World box of the triangles whose middles are among the inner four fifths along every axis, without those that are more than
// twice as large as the box of these middles: a model without the ground that it stands on. Of all triangles where that leaves
// none. False: no memory.
bool tyn_surfaces_most(const tyn_surfaces *surfaces, float lo[3], float hi[3]);
