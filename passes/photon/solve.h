// solve.h -- the solver of method "photon": caches of photons, renewed a few in a frame.
#pragma once
#include <tyndall/extend/field.h>
#include "photon_cache/photon_cache.h"
#include "photon_trace/photon_trace.h"
#include "photon_upsample/photon_upsample.h"
#include "photon_view/photon_view.h"

#define TYN_PHOTON_PASSES "photon_trace", "photon_cache", "photon_upsample", "photon_view"

// Light in the cells of `s`, which hold the medium alone: as moments, and towards the eye if a picture is wanted. All light of
// the scene, but what `marched` has of suns and lamps until it has scattered (photon_trace.first).
void tyn_solve_photon(tyn_graph *g, const tyn_job *job, const tyn_sources *s,
                      const tyn_sources *marched, tyn_field *field);
