// gltf_media.h -- the two Tyndall extensions of glTF.
#pragma once
#include "io/json.h"

// The box that all grids of a medium fill, by the transform of a .vdb or .nvdb file (shape "grid").
typedef struct gltf_grids {
    bool placed; // there is one
    double index_to_world[16];
    uint32_t size[3];
} gltf_grids;

typedef struct gltf_media {
    gltf_grids grids[TYN_MAX_MEDIA];
} gltf_media;

// A medium's density, temperature, emission_density and albedo; its coefficients have been read.
tyn_result tyn_gltf_read_grids(tyn_scene *scene, tyn_medium *medium, gltf_grids *place,
                               const json_doc *doc, const cJSON *from);

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
