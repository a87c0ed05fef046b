// gltf_model.h -- nodes and buffers of a glTF file.
#pragma once
#include "io/json.h"

typedef struct gltf_node {
    const cJSON *json;
    bool has_matrix;
    double matrix[16];                            // if has_matrix, column-major; else:
    double translation[3], rotation[4], scale[3]; // rotation: quaternion x, y, z, w
    double to_world[16];                          // set by the walk over the nodes
    int64_t parent;                               // -1: a root
} gltf_node;

typedef struct gltf_buffer {
    const uint8_t *data; // byteLength bytes
    size_t size;
    void *owned; // `data`, or NULL where that is the file's binary chunk
} gltf_buffer;

typedef struct gltf_model {
    gltf_node *nodes;
    gltf_buffer *buffers;
    int64_t num_nodes, num_buffers;
} gltf_model;

// The document has passed tyn_gltf_check. `chunk`: the binary chunk of a .glb, which the model may point into.
tyn_result tyn_gltf_model_read(gltf_model *model, const json_doc *doc, const gltf_buffer *chunk);
void tyn_gltf_model_finish(gltf_model *model);

// The bytes of a "data:" uri in base64; freed with free(). False if it is none, or empty.
bool tyn_gltf_data_uri(const char *uri, void **bytes, size_t *size);
