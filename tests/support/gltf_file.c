// gltf_file.c -- glTF files with buffers, put together for tests.
#include "gltf_file.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void append(char *text, size_t room, const char *part)
{
    const size_t used = strlen(text);
    assert_true(used + strlen(part) + 3 < room);
    snprintf(text + used, room - used, "%s%s", used ? ", " : "", part);
}

int gltf_file_view(gltf_file *f, const void *data, size_t size, int stride)
{
    char part[128], of_stride[32] = "";
    f->size = (f->size + 3) / 4 * 4;
    assert_true(f->size + size <= sizeof f->bytes);
    memcpy(f->bytes + f->size, data, size);
    if (stride) {
        snprintf(of_stride, sizeof of_stride, ", 'byteStride': %d", stride);
    }
    snprintf(part, sizeof part, "{'buffer': 0, 'byteOffset': %zu, 'byteLength': %zu%s}", f->size,
             size, of_stride);
    append(f->views, sizeof f->views, part);
    f->size += size;
    return f->num_views++;
}

int gltf_file_accessor(gltf_file *f, int view, int offset, int component_type, const char *type,
                       int count, const char *more)
{
    char part[512];
    snprintf(part, sizeof part,
             "{'bufferView': %d, 'byteOffset': %d, 'componentType': %d, 'type': '%s', 'count': "
             "%d%s}",
             view, offset, component_type, type, count, more);
    append(f->accessors, sizeof f->accessors, part);
    return f->num_accessors++;
}

int gltf_file_array(gltf_file *f, int component_type, const char *type, int count, const void *data,
                    size_t size)
{
    return gltf_file_accessor(f, gltf_file_view(f, data, size, 0), 0, component_type, type, count,
                              "");
}

const char *gltf_file_put(const gltf_file *f, const char *name, const char *rest)
{
    char file[64], *text = malloc(65536);
    assert_non_null(text);
    snprintf(file, sizeof file, "%s.bin", name);
    io_put(file, f->bytes, f->size);
    snprintf(text, 65536,
             "{'asset': {'version': '2.0'}, 'buffers': [{'uri': '%s', 'byteLength': %zu}], "
             "'bufferViews': [%s], 'accessors': [%s], %s}",
             file, f->size, f->views, f->accessors, rest);
    for (char *c = text; *c; c++) {
        *c = *c == '\'' ? '"' : *c;
    }
    snprintf(file, sizeof file, "%s.gltf", name);
    const char *path = io_put_text(file, text);
    free(text);
    return path;
}
