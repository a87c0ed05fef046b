// picture.c -- 8-bit PNG and JPEG pictures through stb_image.
#include "io/picture.h"
#include <limits.h>
#include <string.h>
#include <tyndall/scene.h>

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
