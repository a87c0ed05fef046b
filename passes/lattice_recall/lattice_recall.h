// lattice_recall.h -- the last frame's solution in this frame's cells.
#pragma once
#include <tyndall/pass.h>
#include "shaders/lattice/lattice_memory.h"

// clang-format off
#define LATTICE_RECALL_PORTS(X) \
    X(LATTICE_RECALL, MEMORY, memory, IN, BUFFER, "struct lattice_memory_block and moments"), \
    X(LATTICE_RECALL, CELLS, cells, IN, IMAGE_3D, "as lattice has it"), \
    X(LATTICE_RECALL, SOURCE, source, OPTIONAL, IMAGE_3D, "as lattice has it"), \
    X(LATTICE_RECALL, ENVIRONMENT, environment, OPTIONAL, BUFFER, "struct env_block: as lattice has it"), \
    X(LATTICE_RECALL, GUESS, guess, OUT, BUFFER, \
        "vec4[]: moments by cell. The last frame's where it had any, by the place in the world, scaled by " \
        "what light puts in now over what it did then; elsewhere the environment as if unhindered"), \
    X(LATTICE_RECALL, POWER, power, OUT, BUFFER, "what light puts into the cells")
// clang-format on
TYN_PASS(LATTICE_RECALL, lattice_recall);

// Bytes that hold any lattice of so many cells along its longest side: the same for a medium whose
// box changes from frame to frame.
uint64_t tyn_lattice_memory_size(int32_t cells, uint32_t channels);
