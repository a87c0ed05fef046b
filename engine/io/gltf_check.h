// gltf_check.h -- what must hold before a file's nodes, meshes and textures are read.
#pragma once
#include "io/json.h"

// What reads the file follows indices, offsets and types on trust, so these are checked here:
// required extensions, index ranges, extents of accessors and buffer views, and that nodes form
// trees. Values of cameras and lights are checked as well. `glb`: buffer 0 may have
// no uri.
tyn_result tyn_gltf_check(const json_doc *doc, bool glb);
