// gltf_check.h -- what must hold before a file's nodes, meshes and textures are read.
#pragma once
#include "io/json.h"

// The lists of things that others name by their index. Those of KHR_lights_punctual are lights.
typedef enum gltf_kind {
    GLTF_BUFFERS,
    GLTF_BUFFER_VIEWS,
    GLTF_ACCESSORS,
    GLTF_IMAGES,
    GLTF_SAMPLERS,
    GLTF_TEXTURES,
    GLTF_MATERIALS,
    GLTF_MESHES,
    GLTF_CAMERAS,
    GLTF_LIGHTS,
    GLTF_SCENES,
    GLTF_NODES,
    GLTF_NUM_LISTS
} gltf_kind;
extern const char *const tyn_gltf_lists[GLTF_NUM_LISTS]; // what they are called

// What reads the file follows indices, offsets and types on trust, so these are checked here:
// required extensions, index ranges, extents of accessors and buffer views. Values of cameras and lights are checked as well. `glb`: buffer 0 may have
// no uri. `lists`: empty at first; items are freed with free(), after a fault too.
tyn_result tyn_gltf_check(const json_doc *doc, bool glb, json_list lists[GLTF_NUM_LISTS]);
