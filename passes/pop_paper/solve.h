// solve.h -- the solver of method "pop-paper": light moves from cell to cell of its own aligned grid.
#pragma once
#include <tyndall/extend/field.h>
#include "merge_grids/merge_grids.h"
#include "propagate_radial/propagate_radial.h"
#include "propagate_rect/propagate_rect.h"
#include "residuum/residuum.h"
#include "upsample/upsample.h"

#define TYN_PROPAGATION_PASSES                                                                     \
    "importance", "propagate_rect", "propagate_radial", "residuum", "merge_grids", "upsample"

// The light of each sun, ordinate and lamp of `s` and of its virtual point lights, scattered or not; merged towards the
// eye and upsampled with the medium as guide. `field` stays as it is where nothing shines.
void tyn_solve_propagation(tyn_graph *g, const tyn_job *job, const tyn_sources *s,
                           tyn_field *field);
