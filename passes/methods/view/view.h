// view.h -- pictures, probes and balances (tyndall/extend/view.h), with the passes of the library that make them.
#pragma once
#include <tyndall/extend/view.h>
#include "passes/methods/light/sources.h"

// Albedo and normal of the surfaces that the camera sees, where the job wants them.
void tyn_add_guides(tyn_graph *g, const tyn_job *job);
