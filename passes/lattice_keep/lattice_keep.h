// lattice_keep.h -- this frame's solution, put away for the next.
#pragma once
#include <tyndall/pass.h>
#include "shaders/lattice/lattice_memory.h"

// clang-format off
#define LATTICE_KEEP_PORTS(X) \
    X(LATTICE_KEEP, MOMENTS, moments, IN, IMAGE_3D, "of lattice"), \
    X(LATTICE_KEEP, POWER, power, IN, BUFFER, "of lattice_recall"), \
    X(LATTICE_KEEP, MEMORY, memory, INOUT, BUFFER, "struct lattice_memory_block and moments")
// clang-format on
TYN_PASS(LATTICE_KEEP, lattice_keep);
