// slice.c -- a picture of the middle slice of what a pass made.
#include "slice.h"
#include <math.h>
#include <stdlib.h>
#include <tyndall/io.h>

enum { SMALLEST = 256 }; // pixels along the longer side

// ---- texels -----------------------------------------------------------------------------------

typedef struct texel_format {
    VkFormat format;
    uint32_t channels, bytes; // bytes of a channel: 4 = float, 2 = half, 1 = 0 to 1, 0 = packed
} texel_format;

static const texel_format formats[] = {
    {VK_FORMAT_R32_SFLOAT, 1, 4},          {VK_FORMAT_R32G32_SFLOAT, 2, 4},
    {VK_FORMAT_R32G32B32A32_SFLOAT, 4, 4}, {VK_FORMAT_R16_SFLOAT, 1, 2},
    {VK_FORMAT_R16G16_SFLOAT, 2, 2},       {VK_FORMAT_R16G16B16A16_SFLOAT, 4, 2},
    {VK_FORMAT_R8G8B8A8_UNORM, 4, 1},      {VK_FORMAT_D32_SFLOAT, 1, 4},
    {VK_FORMAT_R32G32_UINT, 3, 0},
};

static float half_value(uint16_t h)
{
    const int exponent = h >> 10 & 31, mantissa = h & 1023;
    float value = exponent == 0    ? ldexpf((float)mantissa, -24)
                  : exponent == 31 ? (mantissa ? NAN : INFINITY)
                                   : ldexpf((float)(1024 + mantissa), exponent - 25);
    return h & 0x8000 ? -value : value;
}

// Three numbers of 18 bits with a common exponent, in two words: radiance of surfaces.
static float packed_value(const uint32_t words[2], size_t channel)
{
    const uint32_t c[3] = {words[0] & 0x3ffff, words[1] & 0x3ffff,
                           words[0] >> 18 | (words[1] >> 18 & 15) << 14};
    return ldexpf((float)c[channel], (int)(words[1] >> 22 & 255) - 127 - 17);
}

static float channel_value(const texel_format *f, const void *texels, size_t i)
{
    if (!f->bytes) {
        return packed_value((const uint32_t *)texels + i / 3 * 2, i % 3);
    }
    if (f->bytes == 4) {
        return ((const float *)texels)[i];
    }
    return f->bytes == 2 ? half_value(((const uint16_t *)texels)[i])
                         : (float)((const uint8_t *)texels)[i] / 255;
}

// ---- the scale --------------------------------------------------------------------------------

static int by_value(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

// What is shown black and what full. `sorted` is scratch.
static void find_scale(const float *values, size_t count, float *sorted, float *black, float *full)
{
    size_t finite = 0;
    for (size_t i = 0; i < count; i++) {
        if (isfinite(values[i])) {
            sorted[finite++] = values[i];
        }
    }
    qsort(sorted, finite, sizeof *sorted, by_value);
    *black = 0;
    *full = 1;
    if (finite && sorted[0] < 0) {
        *black = sorted[0];
        *full = sorted[finite - 1];
    } else if (finite && sorted[finite - 1] > 0) {
        float high = sorted[(size_t)(0.99 * (double)(finite - 1))];
        *full = high > 0 ? high : sorted[finite - 1];
    }
}

static uint8_t srgb(float linear)
{
    float x = linear < 0 ? 0 : linear > 1 ? 1 : linear;
    float encoded = x <= 0.0031308f ? 12.92f * x : 1.055f * powf(x, 1 / 2.4f) - 0.055f;
    return (uint8_t)lroundf(255 * encoded);
}

// ---- the picture ------------------------------------------------------------------------------

// `shown` of the texel's channels; values which are not finite are magenta.
static void color_of(const float *texel, uint32_t shown, float black, float full, bool encode,
                     uint8_t rgb[3])
{
    for (uint32_t c = 0; c < 3; c++) {
        const float value = shown == 1 ? texel[0] : c < shown ? texel[c] : black;
        const float x = (value - black) / (full - black);
        rgb[c] = encode ? srgb(x) : (uint8_t)lroundf(255 * fminf(fmaxf(x, 0), 1));
    }
    for (uint32_t c = 0; c < shown; c++) {
        if (!isfinite(texel[c])) {
            rgb[0] = rgb[2] = 255;
            rgb[1] = 0;
        }
    }
}

int slice_write(app *a, const tyn_inspection *inspection, const char *path)
{
    const texel_format *f = NULL;
    for (size_t i = 0; i < ARRAY_SIZE(formats); i++) {
        f = formats[i].format == inspection->format ? &formats[i] : f;
    }
    if (!f) {
        app_error(a, "--view: images of format %d cannot be drawn", (int)inspection->format);
        return EXIT_FAILED;
    }
    const uint32_t width = inspection->size[0], height = inspection->size[1];
    const uint32_t shown = f->channels < 3 ? f->channels : 3;
    const bool volume = inspection->size[2] > 1;
    const uint32_t longer = width > height ? width : height;
    const uint32_t zoom = longer >= SMALLEST ? 1 : (SMALLEST + longer - 1) / longer;
    const size_t count = (size_t)width * height, first = count * (inspection->size[2] / 2);
    float *values = malloc(2 * count * shown * sizeof *values);
    uint8_t *pixels = malloc(3 * count * zoom * zoom);
    int code = app_exit_code(a, values && pixels ? TYN_OK : TYN_ERR_MEMORY, false);
    if (code == EXIT_DONE) {
        float black, full;
        for (size_t i = 0; i < count; i++) {
            for (uint32_t c = 0; c < shown; c++) {
                values[i * shown + c] =
                    channel_value(f, inspection->texels, (first + i) * f->channels + c);
            }
        }
        find_scale(values, count * shown, values + count * shown, &black, &full);
        full = f->bytes == 1 ? 1 : full; // is a picture already
        for (uint32_t y = 0; y < height * zoom; y++) {
            for (uint32_t x = 0; x < width * zoom; x++) {
                // The medium's y points up, a picture's down.
                const uint32_t row = volume ? height - 1 - y / zoom : y / zoom;
                const float *texel = values + shown * ((size_t)row * width + x / zoom);
                color_of(texel, shown, black, full, f->bytes != 1,
                         pixels + 3 * ((size_t)y * width * zoom + x));
            }
        }
        app_note(a, "%s: slice %u of %u of '%s' (%s), %g black, %g full", path,
                 inspection->size[2] / 2, inspection->size[2], inspection->port,
                 inspection->meaning, black, full);
        code = app_exit_code(
            a, tyn_png_write(path, width * zoom, height * zoom, 3, pixels, &a->log), false);
    }
    free(values);
    free(pixels);
    return code;
}
