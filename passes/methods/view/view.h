// view.h -- pictures, probes and balances (tyndall/extend/view.h), with the passes of the library that make them.
#pragma once
#include <tyndall/extend/view.h>
#include "passes/methods/light/sources.h"
#include "passes/methods/view/passes.h"

// Albedo and normal of the surfaces that the camera sees, where the job wants them.
void tyn_add_guides(tyn_graph *g, const tyn_job *job);

// The surfaces that the camera sees, in the light of suns, lamps and VPLs that the medium leaves, by the shadows of `s`: for
// methods whose march knows none of these.
void tyn_add_surfaces_apart(tyn_graph *g, const tyn_job *job, tyn_sources s, tyn_view_inputs *view);
