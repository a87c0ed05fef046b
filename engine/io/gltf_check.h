// gltf_check.h -- what must hold before tinygltf may see a file.
#pragma once
#include "io/json.h"

// tinygltf follows indices, offsets and types on trust, so all that it reads is checked here:
// required extensions, index ranges, extents of accessors and buffer views, node transforms, and
// that nodes form trees. Values of cameras and lights are checked as well. `glb`: buffer 0 may have
// no uri.
tyn_result tyn_gltf_check(const json_doc *doc, bool glb);
