// html_picture.c -- a picture as text for the page.
//
// Differences of neighbours and bytes sorted by weight are what OpenEXR's ZIP does: smooth pictures shrink
// to a third, noisy ones to three quarters.
#include "html_picture.h"
#include <tyndall/io.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

uint16_t html_half(float value)
{
    const uint16_t sign = signbit(value) ? 0x8000 : 0;
    const float size = fabsf(value);
    if (isnan(size)) {
        return sign | 0x7e00;
    }
    if (size >= 65520.0f) {
        return sign | 0x7c00;
    }
    int exponent = -24;
    if (size > 0) { // size < 2^exponent
        frexpf(size, &exponent);
    }
    // A half holds multiples of 2^(exponent - 11), at the smallest 2^-24.
    const int unit = exponent - 11 > -24 ? exponent - 11 : -24;
    const uint32_t steps = (uint32_t)lrintf(ldexpf(size, -unit)); // at most 2^11
    // Consecutive halves are consecutive integers: steps beyond 2^10 of one octave, then the next.
    return sign | (uint16_t)(steps + ((uint32_t)(unit + 24) << 10));
}

static char *base64(const uint8_t *bytes, size_t size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    char *text = malloc((size + 2) / 3 * 4 + 1), *end = text;
    for (size_t i = 0; text && i < size; i += 3) {
        const uint32_t b = (uint32_t)bytes[i] << 16 | (i + 1 < size ? bytes[i + 1] << 8 : 0) |
                           (i + 2 < size ? bytes[i + 2] : 0);
        *end++ = digits[b >> 18];
        *end++ = digits[b >> 12 & 63];
        *end++ = i + 1 < size ? digits[b >> 6 & 63] : '=';
        *end++ = i + 2 < size ? digits[b & 63] : '=';
    }
    if (text) {
        *end = '\0';
    }
    return text;
}

// One channel as differences, high bytes before low ones: `bytes` of 2 w h.
static void pack_channel(const float *data, uint32_t width, uint32_t height, int exponent,
                         uint8_t *bytes)
{
    const size_t count = (size_t)width * height;
    uint16_t left = 0, above = 0;
    for (size_t i = 0; i < count; i++) {
        float scaled = ldexpf(data[i], exponent);
        if (isfinite(data[i]) && fabsf(scaled) > 65504) { // the pixel is finite: keep it so
            scaled = copysignf(65504, scaled);
        }
        const uint16_t half = html_half(scaled);
        const bool first = i % width == 0;
        const uint16_t difference = (uint16_t)(half - (first ? above : left));
        above = first ? half : above;
        left = half;
        bytes[i] = (uint8_t)(difference >> 8);
        bytes[count + i] = (uint8_t)difference;
    }
}

static char *pack(const float *const channels[3], uint32_t width, uint32_t height, int exponent)
{
    const size_t plane = 2 * (size_t)width * height;
    uLongf size = compressBound((uLong)(3 * plane));
    uint8_t *bytes = malloc(3 * plane), *packed = malloc(size);
    char *text = NULL;
    if (bytes && packed) {
        for (int c = 0; c < 3; c++) {
            pack_channel(channels[c], width, height, exponent, bytes + c * plane);
        }
        if (compress2(packed, &size, bytes, (uLong)(3 * plane), 9) == Z_OK) {
            text = base64(packed, size);
        }
    }
    free(bytes);
    free(packed);
    return text;
}

bool html_picture_read(app *a, const char *path, html_picture *picture)
{
    tyn_image_file file = {0};
    *picture = (html_picture){0};
    if (tyn_exr_read(&file, path, &a->log) < 0) {
        app_warn(a, "%s: the page goes without this picture", path);
        return false;
    }
    const float *channels[3] = {tyn_image_file_channel(&file, "R"),
                                tyn_image_file_channel(&file, "G"),
                                tyn_image_file_channel(&file, "B")};
    const bool whole = channels[0] && channels[1] && channels[2];
    if (whole) {
        float largest = 0;
        for (size_t i = 0; i < 3 * (size_t)file.width * file.height; i++) {
            const float value = fabsf(channels[i % 3][i / 3]);
            largest = isfinite(value) ? fmaxf(largest, value) : largest;
        }
        int exponent = 0;
        frexpf(largest, &exponent);
        *picture = (html_picture){file.width, file.height, largest > 0 ? 15 - exponent : 0, NULL};
        picture->base64 = pack(channels, file.width, file.height, picture->exponent);
    }
    tyn_image_file_finish(&file);
    if (!picture->base64) {
        app_warn(a, "%s: %s; the page goes without this picture", path,
                 whole ? "out of memory" : "no channels R, G, B");
    }
    return picture->base64 != NULL;
}

void html_picture_finish(html_picture *picture)
{
    free(picture->base64);
    *picture = (html_picture){0};
}
