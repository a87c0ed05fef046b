// walls.h -- surfaces as the lattice sees them.
#pragma once
#include "passes/methods/light/sources.h"

// Links that surfaces cut, and which cells are joined (shaders/walls/rooms.h). Nothing without surfaces near the media.
void tyn_add_walls(tyn_graph *g, const tyn_job *job, tyn_sources *s);
// What walls reflect of light that is not the lattice's.
void tyn_add_wall_light(tyn_graph *g, const tyn_job *job, tyn_sources *s);
