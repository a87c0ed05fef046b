// lamps.h -- local lights of the methods: point and spot lights, and those that stand for surfaces' light.
#pragma once
#include "methods/nodes.h"

enum { TYN_METHOD_FINE_LAMPS = 2 }; // so many are always followed everywhere

// Cells of the lattice within which all others are followed too: beams of spots farther, until they are as wide.
#define TYN_METHOD_LAMP_REACH 3.0f

// `vpls`: buffer struct radial_vpls, or {0}.
tyn_result tyn_add_radials(tyn_graph *g, const tyn_job *job, const tyn_medium_refs *medium,
                           tyn_ref vpls, tyn_lamps *out);

// Groups of local lights that the lattice keeps apart (lattice_lamps).
uint32_t tyn_radial_groups(const tyn_lamps *lamps);
