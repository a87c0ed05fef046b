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
enum { LATTICE_KEEP_PORTS(TYN_PORT_ENUM), LATTICE_KEEP_NUM_PORTS };
extern const tyn_pass_desc tyn_pass_lattice_keep;
