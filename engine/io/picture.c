// picture.c -- 8-bit PNG and JPEG pictures through stb_image, and PNG through stb_image_write.
#include "io/picture.h"
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <tyndall/scene.h>
#include <zlib.h>

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#define STBI_NO_LINEAR
#define STBI_NO_HDR
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
#define STBI_MAX_DIMENSIONS 256
#else
#define STBI_MAX_DIMENSIONS TYN_MAX_TEXTURE_SIDE
#endif
#include <stb/stb_image.h>

// zlib packs better, and faster.
static unsigned char *compress_bytes(unsigned char *data, int size, int *out_size, int level)
{
    uLongf packed = compressBound((uLong)size);
    unsigned char *out = malloc(packed);
    if (out && compress2(out, &packed, data, (uLong)size, level) != Z_OK) {
        free(out);
        out = NULL;
    }
    *out_size = (int)packed;
    return out;
}

#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#define STBIW_ZLIB_COMPRESS compress_bytes
#include <stb/stb_image_write.h>

uint8_t *tyn_picture_decode(const uint8_t *bytes, size_t size, uint32_t out_size[2],
                            const char **reason)
{
    int width = 0, height = 0, channels = 0;
    uint8_t *texels = NULL;
    *reason = "too large";
    if (size <= INT_MAX) {
        texels = stbi_load_from_memory(bytes, (int)size, &width, &height, &channels, 4);
        *reason = texels ? NULL : stbi_failure_reason();
        if (!texels && size >= 12 && !memcmp(bytes, "RIFF", 4) && !memcmp(bytes + 8, "WEBP", 4)) {
            *reason = "it is WebP; 'gltf-transform png IN.glb OUT.glb' unpacks it";
        }
    }
    out_size[0] = (uint32_t)width;
    out_size[1] = (uint32_t)height;
    return texels;
}

uint8_t *tyn_picture_encode(const uint8_t *pixels, uint32_t width, uint32_t height,
                            uint32_t channels, size_t *size)
{
    static const uint8_t srgb[] = {0, 0, 0, 1, 's', 'R', 'G', 'B', 0, 0xae, 0xce, 0x1c, 0xe9};
    enum { HEADER = 33, MARGIN = 1 << 16 }; // signature and IHDR; what packing may add
    int length = 0;
    if (((uint64_t)width * channels + 1) * height > INT_MAX - MARGIN) {
        return NULL;
    }
    stbi_write_png_compression_level = 6;
    uint8_t *png = stbi_write_png_to_mem(pixels, (int)(width * channels), (int)width, (int)height,
                                         (int)channels, &length);
    uint8_t *grown = png ? realloc(png, (size_t)length + sizeof srgb) : NULL;
    if (!grown) {
        free(png);
        return NULL;
    }
    memmove(grown + HEADER + sizeof srgb, grown + HEADER, (size_t)length - HEADER);
    memcpy(grown + HEADER, srgb, sizeof srgb);
    *size = (size_t)length + sizeof srgb;
    return grown;
}
