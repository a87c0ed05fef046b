// gltf_mesh.h -- meshes of a glTF file as triangles in the world.
#pragma once
#include "io/gltf_material.h"

typedef struct gltf_meshes {
    gltf_data data;
    gltf_materials materials;
    const json_list *list;
    int64_t facets;                      // that triangles may still be cut into
    uint64_t visited;                    // vertices and indices that were looked at
    uint32_t vertex_room, triangle_room; // that the scene's arrays have
    gltf_note lacks[6]; // what is not done, told once each with the first mesh it is about
} gltf_meshes;
tyn_result tyn_gltf_meshes_open(gltf_meshes *m, const json_doc *doc, const gltf_model *model,
                                tyn_scene *scene);
void tyn_gltf_meshes_close(gltf_meshes *m); // the scene is warned of what is not done

// The node's mesh under the node's matrix.
tyn_result tyn_gltf_mesh_add(gltf_meshes *m, const cJSON *node, int64_t mesh,
                             const double to_world[16]);
