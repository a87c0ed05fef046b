// jpeg_write.c -- a JPEG picture in memory, by stb_image_write.
#include "jpeg_write.h"
#include <stdlib.h>
#include <string.h>
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>

typedef struct sink {
    uint8_t *out;
    size_t room, size;
} sink;

static void put(void *user, void *data, int size)
{
    sink *s = user;
    if ((size_t)size > s->room - s->size) {
        abort();
    }
    memcpy(s->out + s->size, data, (size_t)size);
    s->size += (size_t)size;
}

size_t jpeg_write(uint8_t *out, size_t room, int width, int height, const uint8_t *rgb)
{
    sink s = {out, room, 0};
    stbi_write_jpg_to_func(put, &s, width, height, 3, rgb, 100);
    return s.size;
}
