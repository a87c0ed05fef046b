// scenes.h -- the sample scenes: a table of descriptions, and the volumes that they refer to.
#pragma once
#include "gltf.h"
#include "volume.h"

extern const gen_scene gen_scenes[];
extern const int gen_num_scenes;

// A rising plume of smoke: density in [0, 1], Y up.
gen_grid gen_plume(void);
// A cumulus: density in [0, 1], Y up.
gen_grid gen_cumulus(void);
// Three soft blobs: density in [0, 1].
gen_grid gen_blobs(void);
// A sitting hare: density 1 inside, Y up.
gen_grid gen_hare(void);
