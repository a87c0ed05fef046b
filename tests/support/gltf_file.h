// gltf_file.h -- glTF files with buffers, put together for tests.
#pragma once
#include "io_test.h"

typedef struct gltf_file {
    uint8_t bytes[16384]; // buffer 0
    size_t size;
    int num_views, num_accessors;
    char views[4096], accessors[4096]; // JSON, elements of the arrays
} gltf_file;

// Puts bytes into the buffer; gives the view. stride 0: none.
int gltf_file_view(gltf_file *f, const void *data, size_t size, int stride);
// An accessor of that view; `more` is further JSON such as ", 'normalized': true". Gives its index.
int gltf_file_accessor(gltf_file *f, int view, int offset, int component_type, const char *type,
                       int count, const char *more);
// All at once: a tightly packed array.
int gltf_file_array(gltf_file *f, int component_type, const char *type, int count, const void *data,
                    size_t size);

// Writes NAME.gltf and NAME.bin with `rest`, the other members of the document; JSON has ' for ".
// Gives the path.
const char *gltf_file_put(const gltf_file *f, const char *name, const char *rest);
