// sources.h -- what shines (tyndall/extend/sources.h), with the passes of the library that make it.
#pragma once
#include <tyndall/extend/sources.h>
#include "passes/methods/light/passes.h"

// Do surfaces reach beyond the medium's box by more than so many of its longest side?
bool tyn_reach_beyond(const tyn_frame_scene *frame, float sides);
// Sums of the environment's map without its suns (sky_args.h: struct sky_sum).
tyn_ref tyn_add_sky_sums(tyn_graph *g, const tyn_job *job);
// All light of the environment that is no sun's with a beam, its mean too, as ordinates and their directions, whatever the camera
// sees; with surfaces depth maps.
void tyn_add_whole_sky(tyn_graph *g, const tyn_job *job, tyn_sources *s);
// The medium averaged for `dims` cells, two texels a cell, if it is much finer; `texel`: the size of its texels then, m. False: it
// is as it was.
bool tyn_average_medium(tyn_graph *g, const tyn_job *job, const uint32_t dims[3],
                        tyn_medium_refs *medium, float texel[3]);
// What the medium leaves of the ordinates on their way to so many cells along its longest side.
void tyn_add_columns(tyn_graph *g, const tyn_job *job, int32_t cells, tyn_sources *s);
