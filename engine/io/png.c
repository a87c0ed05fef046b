// png.c -- 8-bit PNG images: written through zlib, read through stb_image.
#include <tyndall/io.h>
#include <stdlib.h>
#include <string.h>
#include "base/given.h"
#include "io/picture.h"
#include <zlib.h>

static const uint8_t signature[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};

static void store_u32(uint8_t *p, uint32_t v)
{
    p[0] = (uint8_t)(v >> 24), p[1] = (uint8_t)(v >> 16), p[2] = (uint8_t)(v >> 8);
    p[3] = (uint8_t)v;
}

static uint8_t *put_chunk(uint8_t *out, const char *type, const uint8_t *data, uint32_t size)
{
    store_u32(out, size);
    memcpy(out + 4, type, 4);
    if (size) {
        memmove(out + 8, data, size);
    }
    store_u32(out + 8 + size, (uint32_t)crc32(0, out + 4, size + 4));
    return out + 12 + size;
}

static uint8_t paeth(int left, int up, int corner)
{
    int estimate = left + up - corner;
    int a = abs(estimate - left), b = abs(estimate - up), c = abs(estimate - corner);
    return (uint8_t)(a <= b && a <= c ? left : b <= c ? up : corner);
}

// Filters a row (PNG 9.2) with method 0 none, 1 sub, 2 up, 4 Paeth; returns the sum of magnitudes,
// the usual guess of how well it will compress.
static uint64_t filter_row(uint8_t *out, const uint8_t *row, const uint8_t *above, size_t size,
                           size_t pixel, int method)
{
    uint64_t sum = 0;
    for (size_t i = 0; i < size; i++) {
        uint8_t left = i >= pixel ? row[i - pixel] : 0, up = above ? above[i] : 0;
        uint8_t corner = i >= pixel && above ? above[i - pixel] : 0;
        uint8_t guess = method == 1   ? left
                        : method == 2 ? up
                        : method == 4 ? paeth(left, up, corner)
                                      : 0;
        out[i] = (uint8_t)(row[i] - guess);
        sum += (uint64_t)abs((int8_t)out[i]);
    }
    return sum;
}

static void filter_image(uint8_t *out, const uint8_t *pixels, uint32_t height, size_t row_size,
                         size_t pixel)
{
    static const int methods[] = {0, 1, 2, 4};
    for (uint32_t y = 0; y < height; y++) {
        const uint8_t *row = pixels + y * row_size, *above = y ? row - row_size : NULL;
        uint8_t *to = out + y * (row_size + 1);
        uint64_t least = UINT64_MAX;
        for (int m = 0; m < 4; m++) {
            uint64_t sum = filter_row(to + 1, row, above, row_size, pixel, methods[m]);
            if (sum < least) {
                least = sum;
                to[0] = (uint8_t)methods[m];
            }
        }
        filter_row(to + 1, row, above, row_size, pixel, to[0]);
    }
}

tyn_result tyn_png_write(const char *path, uint32_t width, uint32_t height, uint32_t channels,
                         const uint8_t *pixels, const tyn_log *log)
{
    if (!TYN_GIVEN(log, path, pixels)) {
        return TYN_ERR_PARAMS;
    }
    if (width == 0 || height == 0 || width > 65536 || height > 65536 ||
        (channels != 3 && channels != 4)) {
        tyn_log_print(log, TYN_LOG_ERROR,
                      "%s: %u x %u pixels, %u channels: must be 1 to 65536 with 3 or 4 channels",
                      path, width, height, channels);
        return TYN_ERR_PARAMS;
    }
    size_t row_size = (size_t)width * channels, raw_size = (row_size + 1) * height;
    uLongf packed = compressBound((uLong)raw_size);
    uint8_t *raw = malloc(raw_size), *file = malloc(packed + 100);
    if (!raw || !file || packed > UINT32_MAX - 100) {
        tyn_log_print(log, TYN_LOG_ERROR, "%s: no memory to write it", path);
        free(raw);
        free(file);
        return TYN_ERR_MEMORY;
    }
    uint8_t header[13] = {[8] = 8, [9] = channels == 4 ? 6 : 2};
    store_u32(header, width);
    store_u32(header + 4, height);
    memcpy(file, signature, 8);
    uint8_t *end = put_chunk(file + 8, "IHDR", header, 13);
    end = put_chunk(end, "sRGB", (const uint8_t[]){0}, 1);
    filter_image(raw, pixels, height, row_size, channels);
    compress2(end + 8, &packed, raw, (uLong)raw_size, 6); // in place: the bound is its room
    end = put_chunk(end, "IDAT", end + 8, (uint32_t)packed);
    end = put_chunk(end, "IEND", NULL, 0);
    tyn_result r = tyn_file_write(path, file, (size_t)(end - file), log);
    free(raw);
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
    tyn_result r = tyn_file_read(path, UINT64_C(1) << 31, &bytes, &size, log);
    if (r) {
        return r;
    }
    if (size >= sizeof signature && memcmp(bytes, signature, sizeof signature) == 0) {
        *rgba = tyn_picture_decode(bytes, size, decoded, &reason);
    }
    free(bytes);
    *width = decoded[0];
    *height = decoded[1];
    if (!*rgba) {
        tyn_log_print(log, TYN_LOG_ERROR, "%s: must be a PNG picture: %s", path, reason);
        return TYN_ERR_PARAMS;
    }
    return TYN_OK;
}
