// sources.h -- what shines (tyndall/extend/sources.h), with the passes of the library that make it.
#pragma once
#include <tyndall/extend/sources.h>
#include "passes/passes.h"

// Are the axes of the only shape not those of M?
bool tyn_is_sheared(const tyn_frame_scene *frame);
// Fills what passes know of the lattice.
void tyn_put_lattice(const tyn_lattice_shape *shape, float extent[3], uint32_t dims[3]);
// Do surfaces reach beyond the medium's box by more than so many of its longest side?
bool tyn_reach_beyond(const tyn_frame_scene *frame, float sides);
// Links that surfaces cut, and which cells are joined (shaders/walls/rooms.h). Nothing without surfaces near the media.
void tyn_add_walls(tyn_graph *g, const tyn_job *job, tyn_sources *s);
// Sunlight that the walls of a periodic lattice reflect.
void tyn_add_wall_light(tyn_graph *g, const tyn_job *job, tyn_sources *s);
