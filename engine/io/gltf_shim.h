// gltf_shim.h -- tinygltf behind a C interface: what a scene needs of a glTF file, as plain data.
#pragma once
#include <tyndall/io.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct gltf_node {
    char *name;                                   // "" if none
    double matrix[16];                            // if has_matrix, column-major; else:
    double translation[3], rotation[4], scale[3]; // rotation: quaternion x, y, z, w
    bool has_matrix;
    int32_t camera, mesh, light; // -1: none
    uint32_t *children, num_children;
} gltf_node;

typedef struct gltf_camera {
    char *name;
    bool orthographic;
    double yfov, aspect, xmag, ymag; // aspect 0: not given
} gltf_camera;

typedef struct gltf_bytes {
    uint8_t *data;
    size_t size;
} gltf_bytes;

typedef struct gltf_model {
    char *scene_name; // of the scene that is shown
    int32_t scene;    // its index; -1: the file has none, every root node is shown
    uint32_t *roots, num_roots;
    gltf_node *nodes;
    gltf_camera *cameras;
    gltf_bytes *buffers; // of the file, each at least as long as its byteLength
    uint32_t num_nodes, num_cameras, num_buffers;
} gltf_model;

typedef struct gltf_source {
    const void *bytes; // have passed tyn_gltf_check
    size_t size;       // < 2^31
    bool glb;
    char *const *buffer_files; // paths of the buffers with a uri that is not data, in their order
    size_t num_buffer_files;
    const char *directory; // where uris start
    const char *file;      // for messages
} gltf_source;

// Buffers are read and their sizes compared; images are left alone. No exception leaves; faults are one
// line.
tyn_result gltf_model_read(gltf_model *model, const gltf_source *source, const tyn_log *log);
void gltf_model_finish(gltf_model *model);

// What a "data:" uri holds; freed with free(). False if it is not one, or cannot be read.
bool gltf_data_uri(const char *uri, gltf_bytes *out);

#ifdef __cplusplus
}
#endif
