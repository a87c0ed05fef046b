// gltf_json.h -- the JSON of a .gltf or .glb.
#pragma once
#include <tyndall/io.h>

// Finds it in the bytes of the file; `glb`: it is a binary one.
tyn_result tyn_gltf_find_json(const uint8_t *bytes, size_t size, const char *file,
                              const char **json, size_t *json_size, bool *glb, const tyn_log *log);
