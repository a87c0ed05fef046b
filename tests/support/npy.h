// npy.h -- reads NumPy arrays (format 1.0 to 3.0, little-endian f4 or f8, C order), for tests that
// compare with stored references.
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct npy_array {
    uint32_t rank, shape[4]; // slowest index first; unused entries are 1
    size_t count;            // elements
    float *data;
} npy_array;

// False, with one line on stderr, if the file is missing or is not such an array.
bool npy_read(npy_array *array, const char *path);
void npy_free(npy_array *array);

// Path of a file below the shared data ($TYN_SHARED, else what meson says). False if it is absent: the
// case then is skipped (skip.h).
bool shared_path(char *path, size_t size, const char *name);
