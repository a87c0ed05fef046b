// field.h -- what the nodes of method "pop" share, and those of them that make and read its lattice.
#pragma once
#include "methods/sky.h"
#include "methods/walls.h"

typedef struct tyn_field {
    tyn_lattice_shape shape;
    tyn_picture_inputs picture;
    tyn_sky_refs sky;
    tyn_ref tms;
    tyn_column_refs columns;
    tyn_ref cells, source, power, lamp_power, vpl_light, moments, leaks, wall_power;
    tyn_ref wall_hits;   // of the walls in `picture`
    tyn_ref wall_light;  // what they reflect of light that is not the lattice's; {0} if nothing
    bool from_all_sides; // the mean of the environment lights the medium
} tyn_field;

// A node or a few, added if they are wanted.
typedef struct tyn_field_step {
    bool wanted;
    tyn_result (*add)(tyn_graph *g, const tyn_job *job, tyn_field *f);
} tyn_field_step;

// Runs the `count` steps in order until one fails.
tyn_result tyn_add_steps(tyn_graph *g, const tyn_job *job, tyn_field *f,
                         const tyn_field_step *steps, size_t count);

// The lattice: its cells and walls, what shines into them, the solve, and what the job wants of the solution: merged
// for the camera (f->picture.inscatter), probed, balanced. The media, the lights and the sky are in `f` already.
tyn_result tyn_add_field(tyn_graph *g, const tyn_job *job, tyn_field *f);
