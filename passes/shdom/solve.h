// solve.h -- the solver of method "shdom": spherical harmonics and discrete ordinates on the lattice.
#pragma once
#include <tyndall/extend/field.h>
#include "shdom/shdom.h"
#include "shdom_view/shdom_view.h"

#define TYN_SHDOM_PASSES "shdom", "shdom_view"

// The cells of `s` with the unscattered light of its ordinates, among which are all suns. `probes` has moments, `picture`
// light towards the eye without what scatters once of lamps and of the first `num_suns` suns; made if the job wants pictures.
void tyn_solve_shdom(tyn_graph *g, const tyn_job *job, const tyn_sources *s, uint32_t num_suns,
                     tyn_field *probes, tyn_field *picture);
