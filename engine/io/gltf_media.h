// gltf_media.h -- the two Tyndall extensions of glTF.
#pragma once
#include "io/json.h"

// Which media have a grid with a transform of its own (shape "grid").
typedef struct gltf_media {
    bool own_transform[TYN_MAX_MEDIA];
} gltf_media;

// The root's TYN_participating_media: coefficients and volumes into the scene.
tyn_result tyn_gltf_read_media(tyn_scene *scene, gltf_media *media, const json_doc *doc);

// A node's TYN_participating_media, if it has one: a shape under the node's matrix.
tyn_result tyn_gltf_read_shape(tyn_scene *scene, const gltf_media *media, const json_doc *doc,
                               const cJSON *node, const double to_world[16]);

// A scene's TYN_environment_map, if it has one.
tyn_result tyn_gltf_read_environment(tyn_scene *scene, const json_doc *doc,
                                     const cJSON *gltf_scene);

// Warns of what is in the two extensions and is not known, wherever in the document they are.
void tyn_gltf_warn_unknown(tyn_scene *scene, const json_doc *doc);
