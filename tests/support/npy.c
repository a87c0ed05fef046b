// npy.c -- reader of NumPy arrays and the place of shared references.
#include "npy.h"
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifndef TYN_SHARED_DIR
#define TYN_SHARED_DIR "../shared"
#endif

// Reads the header's dictionary, e.g. {'descr': '<f4', 'fortran_order': False, 'shape': (64, 64, 2), }.
static bool parse_header(npy_array *array, const char *header, size_t *element_size)
{
    const char *descr = strstr(header, "'descr'");
    const char *shape = strstr(header, "'shape'");
    if (!descr || !shape || !strstr(header, "'fortran_order': False")) {
        return false;
    }
    if (strstr(descr, "'<f4'")) {
        *element_size = sizeof(float);
    } else if (strstr(descr, "'<f8'")) {
        *element_size = sizeof(double);
    } else {
        return false;
    }
    const char *p = strchr(shape, '(');
    array->rank = 0;
    array->count = 1;
    for (int i = 0; i < 4; i++) {
        array->shape[i] = 1;
    }
    while (p && *p && *p != ')') {
        char *end;
        unsigned long n = strtoul(p + 1, &end, 10);
        if (end == p + 1) {
            break; // the trailing comma of a one-element tuple
        }
        if (array->rank == 4 || n == 0 || n > UINT32_MAX) {
            return false;
        }
        array->shape[array->rank++] = (uint32_t)n;
        array->count *= n;
        p = strpbrk(end, ",)");
    }
    return p && array->count <= (size_t)1 << 28;
}

bool npy_read(npy_array *array, const char *path)
{
    memset(array, 0, sizeof(*array));
    FILE *file = fopen(path, "rb");
    if (!file) {
        fprintf(stderr, "%s: cannot open\n", path);
        return false;
    }
    unsigned char magic[12];
    char *header = NULL;
    size_t size = 0, header_size = 0;
    bool ok = fread(magic, 1, 10, file) == 10 && !memcmp(magic, "\x93NUMPY", 6);
    if (ok && magic[6] == 1) {
        header_size = magic[8] | (size_t)magic[9] << 8;
    } else if (ok) {
        ok = fread(magic + 10, 1, 2, file) == 2;
        header_size = magic[8] | (size_t)magic[9] << 8 | (size_t)magic[10] << 16;
    }
    if (ok && header_size < 1 << 16) {
        header = calloc(header_size + 1, 1);
        ok = header && fread(header, 1, header_size, file) == header_size &&
             parse_header(array, header, &size);
    }
    if (ok) {
        array->data = malloc(array->count * sizeof(double));
        ok = array->data && fread(array->data, size, array->count, file) == array->count;
        if (ok && size == sizeof(double)) {
            for (size_t i = 0; i < array->count; i++) {
                double value;
                memcpy(&value, (char *)array->data + i * sizeof(double), sizeof(double));
                array->data[i] = (float)value;
            }
        }
    }
    free(header);
    fclose(file);
    if (!ok) {
        fprintf(stderr, "%s: not a little-endian f4 or f8 array in C order of rank <= 4\n", path);
        npy_free(array);
    }
    return ok;
}

void npy_free(npy_array *array)
{
    free(array->data);
    memset(array, 0, sizeof(*array));
}

bool shared_path(char *path, size_t size, const char *name)
{
    const char *root = getenv("TYN_SHARED");
    int n = snprintf(path, size, "%s/%s", root && *root ? root : TYN_SHARED_DIR, name);
    if (n < 0 || (size_t)n >= size) {
        return false;
    }
    FILE *file = fopen(path, "rb");
    if (file) {
        fclose(file);
    }
    return file != NULL;
}
