// lattice_keep.h -- this frame's solution, put away for the next.
#pragma once
#include <tyndall/pass.h>
#include "shaders/lattice/lattice_memory.h"

enum {
    LATTICE_KEEP_PORT_MOMENTS, // IN 3D, of lattice
    LATTICE_KEEP_PORT_POWER,   // IN buffer, of lattice_recall
    LATTICE_KEEP_PORT_MEMORY,  // INOUT buffer, the history
    LATTICE_KEEP_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_lattice_keep;
