// png.c -- 8-bit PNG images.
#include <tyndall/io.h>
#include "base/fault.h"
#include <stdlib.h>
#include <string.h>
#include "base/given.h"
#include "io/picture.h"

static const uint8_t signature[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};

tyn_result tyn_png_write(const char *path, uint32_t width, uint32_t height, uint32_t channels,
                         const uint8_t *pixels, const tyn_log *log)
{
    if (!TYN_GIVEN(log, path, pixels)) {
        return TYN_ERR_PARAMS;
    }
    if (width == 0 || height == 0 || width > 65536 || height > 65536 ||
        (channels != 3 && channels != 4)) {
        return TYN_FAULT(log, TYN_ERR_PARAMS,
                         "%s: %u x %u pixels, %u channels: must be 1 to 65536 with 3 or 4 channels",
                         path, width, height, channels);
    }
    size_t size = 0;
    uint8_t *file = tyn_picture_encode(pixels, width, height, channels, &size);
    if (!file) {
        return TYN_FAULT(log, TYN_ERR_MEMORY, "%s: no memory to write it", path);
    }
    tyn_result r = tyn_file_write(path, file, size, log);
    free(file);
    return r;
}

tyn_result tyn_png_read(const char *path, uint32_t *width, uint32_t *height, uint8_t **rgba,
                        const tyn_log *log)
{
    if (!TYN_GIVEN(log, path, width, height, rgba)) {
        return TYN_ERR_PARAMS;
    }
    void *bytes;
    size_t size;
    uint32_t decoded[2] = {0, 0};
    const char *reason = "it does not begin as one";
    *rgba = NULL;
    TYN_TRY(tyn_file_read(path, UINT64_C(1) << 31, &bytes, &size, log));
    if (size >= sizeof signature && memcmp(bytes, signature, sizeof signature) == 0) {
        *rgba = tyn_picture_decode(bytes, size, decoded, &reason);
    }
    free(bytes);
    *width = decoded[0];
    *height = decoded[1];
    if (!*rgba) {
        return TYN_FAULT(log, TYN_ERR_PARAMS, "%s: must be a PNG picture: %s", path, reason);
    }
    return TYN_OK;
}
