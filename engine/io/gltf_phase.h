// gltf_phase.h -- the phase function of a medium of TYN_participating_media.
#pragma once
#include "io/json.h"

// The member "phase" of a medium: one for all channels, or a list of three. Leaves `phase` where it is not there. Tables go
// into the scene.
tyn_result tyn_gltf_read_phase(tyn_scene *scene, const json_doc *doc, const cJSON *medium,
                               tyn_phase phase[3]);

// Members of a phase function and of its lobes, separated and enclosed by blanks.
#define TYN_GLTF_PHASE_MEMBERS " lobes legendre angles values droplets "
#define TYN_GLTF_LOBE_MEMBERS " weight g alpha "
