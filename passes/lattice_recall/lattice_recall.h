// lattice_recall.h -- the last frame's solution in this frame's cells.
#pragma once
#include <tyndall/pass.h>
#include "shaders/lattice/lattice_memory.h"

enum {
    LATTICE_RECALL_PORT_MEMORY,      // IN buffer, a history of tyn_lattice_memory_size bytes
    LATTICE_RECALL_PORT_CELLS,       // IN 3D, as lattice has it, and the two below
    LATTICE_RECALL_PORT_SOURCE,      // IN optional 3D
    LATTICE_RECALL_PORT_ENVIRONMENT, // IN optional buffer
    LATTICE_RECALL_PORT_GUESS, // OUT buffer vec4[]: moments by cell. The last frame's where it had any, by
                               // the place in the world, scaled by what light puts in now over what
                               // it did then; elsewhere the environment as if unhindered
    LATTICE_RECALL_PORT_POWER, // OUT buffer vec3: what light puts in
    LATTICE_RECALL_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_lattice_recall;

// Bytes that hold any lattice of so many cells along its longest side: the same for a medium whose
// box changes from frame to frame.
uint64_t tyn_lattice_memory_size(int32_t cells, uint32_t channels);
