// gltf_accessor.h -- values of accessors as floats or indices. The document has passed tyn_gltf_check.
#pragma once
#include "io/gltf_model.h"

typedef struct gltf_data {
    const json_doc *doc;
    const gltf_model *model;
} gltf_data;

const uint8_t *tyn_gltf_view_bytes(const gltf_data *data, int64_t view, size_t *size);

// `at` is the member that names the accessor, for messages: "attributes.POSITION". Normalised integers
// become 0 to 1 or -1 to 1, others keep their value; sparse values are put in. The accessor's type must be
// VEC<least> to VEC<most>. `out`: count * components floats, all finite, freed with free().
typedef struct gltf_floats {
    float *values;
    uint32_t count, components;
} gltf_floats;
tyn_result tyn_gltf_read_floats(const gltf_data *data, const cJSON *at, uint32_t least,
                                uint32_t most, gltf_floats *out);

// Indices, each < `limit`; freed with free().
tyn_result tyn_gltf_read_indices(const gltf_data *data, const cJSON *at, uint32_t limit,
                                 uint32_t **out, uint32_t *count);
