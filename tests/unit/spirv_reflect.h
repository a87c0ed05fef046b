// spirv_reflect.h -- what a shader says about its interface, read from its SPIR-V.
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { REFLECT_MAX_BINDINGS = 64, REFLECT_MAX_CAPABILITIES = 32 };

typedef enum reflect_kind {
    REFLECT_OTHER = 0, // an array of descriptors, a separate sampler, ...
    REFLECT_SAMPLED_IMAGE,
    REFLECT_STORAGE_IMAGE,
    REFLECT_STORAGE_BUFFER,
    REFLECT_UNIFORM_BUFFER,
    REFLECT_TEXELS, // uniform texel buffer
} reflect_kind;

typedef struct reflect_binding {
    uint32_t set, binding;
    reflect_kind kind;
    uint32_t dim;                             // SpvDim of images
    uint32_t format;                          // SpvImageFormat of storage images
    bool arrayed, multisampled, float_texels; // float_texels: else integers
    bool non_writable, non_readable;          // of the variable, or of every member of the block
} reflect_binding;

typedef struct reflect_shader {
    reflect_binding bindings[REFLECT_MAX_BINDINGS];
    uint32_t num_bindings;
    uint32_t capabilities[REFLECT_MAX_CAPABILITIES];
    uint32_t num_capabilities;
    uint32_t num_entry_points;
    bool compute, vertex, fragment; // the stage
    bool named_main;
    uint32_t local_size[3];
    uint32_t push_constant_bytes; // 0: there are none
    uint32_t inputs, outputs;     // bit i: location i is read, written
    uint32_t shared_bytes;        // workgroup memory
    uint32_t spec_ids;            // bit i: specialisation constant i exists
    bool spec_wide;               // one has an id >= 32 or is not 32 bits (or bool)
} reflect_shader;

// False, with a reason, if the words are not a SPIR-V module that this reader understands.
bool reflect(const uint32_t *words, size_t bytes, reflect_shader *out, const char **why);
