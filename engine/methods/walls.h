// walls.h -- surfaces as the lattice sees them.
#pragma once
#include "methods/nodes.h"
#include "passes/lattice/lattice.h"

// Do surfaces come near the media's box? Else the lattice has no walls.
bool tyn_has_walls(const tyn_frame_scene *frame);

// `hits`: the triangles that links meet, for tyn_add_wall_light.
tyn_result tyn_add_walls(tyn_graph *g, const tyn_job *job, const tyn_lattice_shape *shape,
                         tyn_wall_refs *walls, tyn_ref *hits);

// What the first of frame->suns (those whose light is not reflected otherwise) and the VPLs of `radials`
// shine on the walls of the cells: LATTICE_PORT_WALL_LIGHT; {0} without walls or such lights. `rooms` may be {0}.
tyn_result tyn_add_wall_light(tyn_graph *g, const tyn_job *job, const tyn_lattice_shape *shape,
                              const tyn_picture_inputs *in, tyn_ref hits, uint32_t num_suns,
                              tyn_ref *light);

// Which cells are joined, and which of them the VPLs shine in (shaders/walls/rooms.h); {0} without walls, or VPLs that see.
tyn_result tyn_add_rooms(tyn_graph *g, const tyn_job *job, const tyn_lattice_shape *shape,
                         const tyn_wall_refs *walls, const tyn_vpl_refs *vpls, tyn_ref *rooms);
