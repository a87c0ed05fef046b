// limits.h -- says in the report's warnings where a method is known to lose accuracy, and why (docs/stress.md).
//
// From figures of the scene alone, or from what a frame counted anyway, so that it costs nothing: each line starts
// with "accuracy:".
#pragma once
#include "methods/job.h"

// Of `pop`: cells of the lattice, m.
void tyn_limits_lattice(const tyn_job *job, float cell);
// Of `pop-paper`: hops from cell to cell, m.
void tyn_limits_hops(const tyn_job *job, float hop);
// Of `single`: what is left out.
void tyn_limits_single(const tyn_job *job);
// Of `pop`: an environment lights the medium, and walls are in its lattice.
void tyn_limits_sky(const tyn_job *job);
// Of every method that follows rays: places are floats.
void tyn_limits_rays(const tyn_job *job);
// Of `path`: its safety cap.
void tyn_limits_paths(const tyn_job *job, uint32_t max_steps);
