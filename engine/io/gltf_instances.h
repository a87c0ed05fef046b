// gltf_instances.h -- EXT_mesh_gpu_instancing: one mesh of a node in many places.
#pragma once
#include "io/gltf_accessor.h"

typedef struct gltf_instances {
    uint32_t count;                              // 0: the node has no such extension
    gltf_floats translations, rotations, scales; // count 0: none of them
} gltf_instances;
tyn_result tyn_gltf_instances_read(gltf_instances *instances, const gltf_data *data,
                                   const cJSON *node);
void tyn_gltf_instances_finish(gltf_instances *instances);

// From the instance to the node.
void tyn_gltf_instance_matrix(const gltf_instances *instances, uint32_t i, double m[16]);

// gltf.c: translation, rotation (a quaternion x, y, z, w of any length but 0) and scale as a matrix, by columns.
void tyn_gltf_trs(double m[16], const double translation[3], const double rotation[4],
                  const double scale[3]);
