// gltf_model.h -- nodes and buffers of a glTF file.
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

typedef struct gltf_node {
    const cJSON *json;
    bool has_matrix;
    double matrix[16];                            // if has_matrix, column-major; else:
    double translation[3], rotation[4], scale[3]; // rotation: quaternion x, y, z, w
    double to_world[16];                          // set by the walk over the nodes
    int64_t parent;                               // -1: a root
    int64_t walk;                                 // by which the check of parents came here
} gltf_node;

typedef struct gltf_buffer {
    const uint8_t *data; // byteLength bytes
    size_t size;
    void *owned; // `data`, or NULL where that is the file's binary chunk
} gltf_buffer;

typedef struct gltf_view {
    int64_t buffer, offset, length;
    int64_t stride; // 0: elements lie side by side
} gltf_view;

// Elements in a view, `stride` bytes apart.
typedef struct gltf_elements {
    int64_t view; // -1: all are zero
    int64_t offset, stride;
} gltf_elements;

typedef struct gltf_accessor {
    gltf_elements elements;
    int64_t count, type; // of its components, as in the file
    uint32_t components; // 0: of a matrix
    bool normalized;
    int64_t num_sparse, index_type; // elements that are replaced
    gltf_elements indices, values;
} gltf_accessor;

typedef struct gltf_model {
    json_list lists[GLTF_NUM_LISTS];
    gltf_node *nodes;     // of lists[GLTF_NODES]
    gltf_buffer *buffers; // of lists[GLTF_BUFFERS]
    gltf_view *views;     // of lists[GLTF_BUFFER_VIEWS]
    gltf_accessor *accessors;
} gltf_model;

// Checks the document first. `chunk`: the binary chunk of a .glb, which the model may point into; NULL: it is none.
tyn_result tyn_gltf_model_read(gltf_model *model, const json_doc *doc, const gltf_buffer *chunk);
void tyn_gltf_model_finish(gltf_model *model);

// Counts what a thing of a list lacks, and keeps the name of the first, or its number; `none`: behind the last.
typedef struct gltf_note {
    char name[64];
    uint32_t count;
} gltf_note;
void tyn_gltf_note(gltf_note *note, const json_list *list, int64_t index, const char *none);

// The bytes of a "data:" uri in base64; freed with free(). False if it is none, or empty.
bool tyn_gltf_data_uri(const char *uri, void **bytes, size_t *size);
