// environment.c -- latitude-longitude maps from .exr and .hdr.
#include <tyndall/io.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "base/given.h"
#include <tyndall/extend/hash.h>
#include "io/hdr.h"
#include "io/image.h"
#include "io/primaries.h"

static tyn_result load_hdr(uint32_t size[2], float **pixels, const char *path, const tyn_log *log)
{
    void *bytes;
    size_t num_bytes;
    tyn_result r = tyn_file_read(path, 1ull << 32, &bytes, &num_bytes, log);
    if (!r) {
        r = tyn_hdr_parse(size, pixels, bytes, num_bytes, path, log);
        free(bytes);
    }
    return r;
}

// What the file has of the sphere: its data window in its display window, black where it has nothing.
static tyn_result paste(uint32_t size[2], float **pixels, const tyn_image_file *image,
                        const float *const rgb[3], const char *path, const tyn_log *log)
{
    const bool part = image->whole_width > 0;
    const uint32_t w = part ? image->whole_width : image->width;
    const uint32_t h = part ? image->whole_height : image->height;
    const int64_t x0 = part ? image->x : 0, y0 = part ? image->y : 0;
    if (h < 1 || w > TYN_MAX_IMAGE_SIDE || h > TYN_MAX_IMAGE_SIDE ||
        (uint64_t)w * h > TYN_MAX_PIXELS) {
        return TYN_FAULT(log, TYN_ERR_PARAMS, "%s: a display window of %u x %u pixels is too large",
                         path, w, h);
    }
    *pixels = calloc((size_t)w * h, 3 * sizeof **pixels);
    if (!*pixels) {
        return TYN_FAULT(log, TYN_ERR_MEMORY, "%s: no memory for its pixels", path);
    }
    size_t pasted = 0;
    for (uint32_t y = 0; y < image->height; y++) {
        for (uint32_t x = 0; x < image->width; x++) {
            const int64_t to_x = x0 + x, to_y = y0 + y;
            if (to_x < 0 || to_y < 0 || to_x >= w || to_y >= h) {
                continue;
            }
            float *to = *pixels + 3 * ((size_t)to_y * w + (size_t)to_x);
            for (int c = 0; c < 3; c++) {
                to[c] = rgb[c][(size_t)y * image->width + x];
            }
            pasted++;
        }
    }
    if (pasted < (size_t)w * h) {
        tyn_log_print(log, TYN_LOG_WARN,
                      "%s: has %.3g %% of its %u x %u pixels: the others are black", path,
                      100 * (double)pasted / ((double)w * h), w, h);
    }
    size[0] = w;
    size[1] = h;
    return TYN_OK;
}

static tyn_result load_exr(uint32_t size[2], float **pixels, const char *path, const tyn_log *log)
{
    tyn_image_file image;
    tyn_result r = tyn_exr_read(&image, path, log);
    if (r) {
        return r;
    }
    const float *rgb[3] = {tyn_image_file_channel(&image, "R"), tyn_image_file_channel(&image, "G"),
                           tyn_image_file_channel(&image, "B")};
    const float *grey = tyn_image_file_channel(&image, "Y");
    const tyn_attribute *kind = tyn_image_file_attribute(&image, "envmap");
    if (grey && !rgb[0] && !rgb[1] && !rgb[2]) {
        rgb[0] = rgb[1] = rgb[2] = grey;
    }
    if (!rgb[0] || !rgb[1] || !rgb[2]) {
        r = TYN_FAULT(log, TYN_ERR_PARAMS, "%s: an environment needs channels R, G, B, or Y alone",
                      path);
    } else if (kind && kind->kind == TYN_ATTRIBUTE_INTEGER && kind->values[0] != 0) {
        r = TYN_FAULT(log, TYN_ERR_PARAMS,
                      "%s: is a map of a cube's faces: must be one of latitude and longitude "
                      "(exrenvmap of OpenEXR makes one)",
                      path);
    } else {
        r = paste(size, pixels, &image, rgb, path, log);
    }
    const tyn_attribute *c = tyn_image_file_attribute(&image, "chromaticities");
    if (!r && rgb[0] != grey && c && c->kind == TYN_ATTRIBUTE_CHROMATICITIES) {
        tyn_pixels_to_rec709(*pixels, (size_t)size[0] * size[1], c->values);
    }
    tyn_image_file_finish(&image);
    return r;
}

// Maps of a few texels get more of them, an odd number of times as many: the bilinear map stays what it
// was, and methods that take texels for boxes see it too.
static tyn_result refine_small(uint32_t size[2], float **pixels, const tyn_log *log)
{
    uint32_t times[2] = {1, 1};
    for (int a = 0; a < 2; a++) {
        while (times[a] * size[a] < (a == 0 ? 64u : 32u)) {
            times[a] += 2;
        }
    }
    const uint32_t w = times[0] * size[0], h = times[1] * size[1];
    if (w == size[0] && h == size[1]) {
        return TYN_OK;
    }
    float *fine = malloc(3 * sizeof(float) * w * h);
    if (!fine) {
        return TYN_FAULT(log, TYN_ERR_MEMORY, "no memory for an environment of %u x %u texels", w,
                         h);
    }
    for (uint32_t y = 0; y < h; y++) {
        const float v = ((float)y + 0.5f) / (float)times[1] - 0.5f; // clamped
        const float fy = fminf(fmaxf(v, 0), (float)(size[1] - 1));
        const uint32_t y0 = (uint32_t)fy, y1 = y0 + 1 < size[1] ? y0 + 1 : y0;
        for (uint32_t x = 0; x < w; x++) {
            const float fx = ((float)x + 0.5f) / (float)times[0] - 0.5f + (float)size[0]; // wraps
            const uint32_t x0 = (uint32_t)fx % size[0], x1 = (x0 + 1) % size[0];
            const float tx = fx - floorf(fx), ty = fy - (float)y0;
            const float *p = *pixels, *rows[2] = {p + 3 * y0 * size[0], p + 3 * y1 * size[0]};
            for (int c = 0; c < 3; c++) {
                const float top = rows[0][3 * x0 + c] * (1 - tx) + rows[0][3 * x1 + c] * tx;
                const float low = rows[1][3 * x0 + c] * (1 - tx) + rows[1][3 * x1 + c] * tx;
                fine[3 * ((size_t)y * w + x) + c] = top * (1 - ty) + low * ty;
            }
        }
    }
    free(*pixels);
    *pixels = fine;
    size[0] = w;
    size[1] = h;
    return TYN_OK;
}

tyn_result tyn_environment_load(tyn_environment *env, const char *path, const tyn_log *log)
{
    if (!TYN_GIVEN(log, env, path)) {
        return TYN_ERR_PARAMS;
    }
    const char *dot = strrchr(path, '.');
    uint32_t size[2];
    float *pixels = NULL;
    tyn_result r;
    if (dot && strcasecmp(dot, ".hdr") == 0) {
        r = load_hdr(size, &pixels, path, log);
    } else if (dot && strcasecmp(dot, ".exr") == 0) {
        r = load_exr(size, &pixels, path, log);
    } else {
        return TYN_FAULT(log, TYN_ERR_PARAMS,
                         "%s: unknown kind of environment: must be .exr or .hdr", path);
    }
    size_t count = r ? 0 : 3 * (size_t)size[0] * size[1], negative = 0;
    for (size_t i = 0; i < count; i++) {
        if (!isfinite(pixels[i])) {
            tyn_log_print(log, TYN_LOG_ERROR, "%s: pixel %zu, %zu is %g: must be finite", path,
                          i / 3 % size[0], i / 3 / size[0], pixels[i]);
            free(pixels);
            return TYN_ERR_PARAMS;
        }
        negative += pixels[i] < 0;
        pixels[i] = fmaxf(pixels[i], 0.0f); // filters leave small negative values beside lamps
    }
    if (negative) {
        tyn_log_print(log, TYN_LOG_WARN, "%s: %zu negative values were set to 0", path, negative);
    }
    if (!r) {
        r = refine_small(size, &pixels, log);
        count = 3 * (size_t)size[0] * size[1];
    }
    if (!r) {
        free(env->data);
        env->present = true;
        env->data = pixels;
        env->size[0] = size[0];
        env->size[1] = size[1];
        env->hash = tyn_hash_bytes(tyn_hash_bytes(TYN_HASH_SEED, size, sizeof size), pixels,
                                   count * sizeof *pixels);
    }
    return r;
}
