// shading.h -- what a picture shows of surfaces, and the light that they send on.
#pragma once
#include "methods/nodes.h"
#include "passes/balance/balance.h"

// Have the surfaces a hierarchy, or are they so few that rays need none?
bool tyn_can_trace(const tyn_job *job);

// Do VPLs carry all reflections between surfaces? So they do where surfaces reach far beyond the medium's box, which
// the lattice fills; else they carry the first, and the lattice's walls the others.
bool tyn_vpls_bounce(const tyn_job *job);

// Virtual point lights of what surfaces reflect first and emit. {0} without surfaces, or
// if none of them can shine. `num_suns`: the first of frame->suns.
tyn_result tyn_add_vpls(tyn_graph *g, const tyn_job *job, const tyn_medium_refs *medium,
                        uint32_t num_suns, tyn_vpl_refs *vpls);

// Radiance and distances of the surfaces that the camera sees, for the march (in->surface, in->distances). `moments`:
// light of the lattice, or {0}. `num_suns`: the first of frame->suns.
tyn_result tyn_add_surfaces(tyn_graph *g, const tyn_job *job, tyn_ref moments, uint32_t num_suns,
                            tyn_picture_inputs *in);

// What a balance needs to follow unscattered light to surfaces, if there are any: ports of pass balance in `refs`.
void tyn_follow_lights(const tyn_job *job, const tyn_picture_inputs *in, tyn_balance_params *params,
                       tyn_ref *refs);
