// module.c -- what the module pop-paper brings.
#include <tyndall/extend/plugin.h>
#include "importance/importance.h"
#include "merge_grids/merge_grids.h"
#include "propagate_radial/propagate_radial.h"
#include "propagate_rect/propagate_rect.h"
#include "residuum/residuum.h"
#include "upsample/upsample.h"

extern const tyn_method tyn_method_pop_paper;
static const tyn_pass_desc *const passes[] = {&tyn_pass_importance,
                                              &tyn_pass_merge_grids,
                                              &tyn_pass_propagate_radial,
                                              &tyn_pass_propagate_rect,
                                              &tyn_pass_residuum,
                                              &tyn_pass_upsample,
                                              NULL};
static const tyn_method *const methods[] = {&tyn_method_pop_paper, NULL};

TYN_PLUGIN("pop-paper", "principal-ordinates propagation as published in 2014, cell by cell",
           passes, methods, NULL)
