// gltf_check.h -- what must hold before a file's nodes, meshes and textures are read.
#pragma once
#include "io/gltf_model.h"

// What reads the file follows indices, offsets and types on trust, so these are checked here: required extensions, index
// ranges, extents of accessors and buffer views, which are kept in the model with its lists. Values of cameras and lights
// are checked as well. `glb`: buffer 0 may have no uri. `model`: empty at first; to be finished after a fault, too.
tyn_result tyn_gltf_check(const json_doc *doc, bool glb, gltf_model *model);
