// scenes.h -- the sample scenes: a table of descriptions, and the volumes that they refer to.
#pragma once
#include "gltf.h"
#include "volume.h"

extern const gen_scene gen_scenes[];
extern const int gen_num_scenes;

// Those with lamps and walls.
extern const gen_scene gen_room, gen_cornell_smoke; // room.c
extern const gen_scene gen_fog_hall, gen_lantern, gen_vpl_cave, gen_many_lights;

// A rising plume of smoke: density in [0, 1], Y up.
gen_grid gen_plume(void);
// A cumulus: density in [0, 1], Y up.
gen_grid gen_cumulus(void);
// Three soft blobs: density in [0, 1].
gen_grid gen_blobs(void);
// A sitting hare: density 1 inside, Y up.
gen_grid gen_hare(void);
// Smoke that creeps over the ground, the dusty air of a cave, a haze: densities in [0, 1], Y up.
gen_grid gen_lantern_smoke(void);
gen_grid gen_cave_dust(void);
gen_grid gen_haze(void);
