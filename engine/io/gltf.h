// gltf.h -- scenes from glTF 2.0 (.gltf, .glb).
#pragma once
#include <tyndall/io.h>

// Reads a scene from a file in memory; other files it names are found beside `file`. `environment`
// (may be NULL) replaces the scene's map; `moment` may be NULL. `scene`
// must be empty; after a fault it is empty again.
tyn_result tyn_gltf_parse(tyn_scene *scene, const void *bytes, size_t size, const char *file,
                          const char *environment, const tyn_moment *moment, const tyn_log *log);

bool tyn_is_gltf(const char *path); // by its name
