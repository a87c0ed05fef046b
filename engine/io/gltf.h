// gltf.h -- scenes from glTF 2.0 (.gltf, .glb).
#pragma once
#include <tyndall/io.h>

// Reads a scene from a file in memory; other files it names are found beside `file`. `environment`
// (may be NULL) replaces the scene's map; `frame` (may be NULL) numbers the files it names. `scene`
// must be empty; after a fault it is empty again.
tyn_result tyn_gltf_parse(tyn_scene *scene, const void *bytes, size_t size, const char *file,
                          const char *environment, const uint32_t *frame, const tyn_log *log);
