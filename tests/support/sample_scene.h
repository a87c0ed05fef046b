// sample_scene.h -- the scenes of samples/, for tests that run methods on them.
#pragma once
#include "gpu_test.h"
#include <tyndall/scene.h>

// Loads NAME.gltf of the build's sample scenes, with its hierarchy if it has surfaces. Fails the test if that cannot
// be.
void sample_scene_load(tyn_scene *scene, const char *name, const gpu_test *t);
