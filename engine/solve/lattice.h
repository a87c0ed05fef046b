// lattice.h -- the solver of method "pop": one lattice for everything that has scattered.
#pragma once
#include "solve/field.h"
#include "passes/lattice/lattice.h"
#include "passes/lattice_keep/lattice_keep.h"
#include "passes/lattice_recall/lattice_recall.h"

#define TYN_LATTICE_PASSES &tyn_pass_lattice_recall, &tyn_pass_lattice, &tyn_pass_lattice_keep

// The lattice of `s`: everything that has scattered, for all lights together.
void tyn_solve_lattice(tyn_graph *g, const tyn_job *job, const tyn_sources *s, tyn_field *field);
