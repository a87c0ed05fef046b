// gltf_json.h -- the JSON and the binary chunk of a .gltf or .glb.
#pragma once
#include "io/gltf_model.h"

typedef struct gltf_container {
    const char *json;
    size_t json_size;
    bool glb;           // a binary one
    gltf_buffer binary; // its binary chunk; no bytes: there is none
} gltf_container;
// Finds them in the bytes of the file.
tyn_result tyn_gltf_open(gltf_container *out, const uint8_t *bytes, size_t size, const char *file,
                         const tyn_log *log);
