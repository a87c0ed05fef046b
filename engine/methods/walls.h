// walls.h -- surfaces as the lattice sees them.
#pragma once
#include "methods/job.h"
#include "passes/lattice/lattice.h"

// What shaders/lattice_walls.glsl and the lattice read.
typedef struct tyn_wall_refs {
    tyn_ref links, cells;
} tyn_wall_refs;

// Do surfaces come near the media's box? Else the lattice has no walls.
bool tyn_has_walls(const tyn_frame_scene *frame);

// {0} without walls.
tyn_result tyn_add_walls(tyn_graph *g, const tyn_job *job, const tyn_lattice_shape *shape,
                         tyn_wall_refs *walls);
