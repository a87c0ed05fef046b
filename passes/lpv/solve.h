// solve.h -- the solver of method "lpv": power moves on from cell to cell of one lattice.
#pragma once
#include <tyndall/extend/field.h>
#include "lpv/lpv.h"
#include "lpv_blockers/lpv_blockers.h"
#include "lpv_reflect/lpv_reflect.h"
#include "lpv_scatter/lpv_scatter.h"

#define TYN_LPV_PASSES "lpv_reflect", "lpv_scatter", "lpv_blockers", "lpv"

// The cells of `s` with their unscattered light, and what surfaces reflect of it: after so many iterations.
void tyn_solve_lpv(tyn_graph *g, const tyn_job *job, const tyn_sources *s, tyn_field *field);
