// environment.c -- latitude-longitude maps from .exr and .hdr.
#include <tyndall/io.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "base/hash.h"
#include "io/hdr.h"

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
    size_t count = (size_t)image.width * image.height;
    if (grey && !rgb[0] && !rgb[1] && !rgb[2]) {
        rgb[0] = rgb[1] = rgb[2] = grey;
    }
    *pixels = malloc(count * 3 * sizeof **pixels);
    if (!rgb[0] || !rgb[1] || !rgb[2]) {
        tyn_log_print(log, TYN_LOG_ERROR, "%s: an environment needs channels R, G, B, or Y alone",
                      path);
        r = TYN_ERR_PARAMS;
    } else if (!*pixels) {
        tyn_log_print(log, TYN_LOG_ERROR, "%s: no memory for its pixels", path);
        r = TYN_ERR_MEMORY;
    } else {
        for (size_t i = 0; i < 3 * count; i++) {
            (*pixels)[i] = rgb[i % 3][i / 3];
        }
    }
    size[0] = image.width;
    size[1] = image.height;
    tyn_image_file_finish(&image);
    if (r) {
        free(*pixels);
        *pixels = NULL;
    }
    return r;
}

tyn_result tyn_environment_load(tyn_environment *env, const char *path, const tyn_log *log)
{
    const char *dot = strrchr(path, '.');
    uint32_t size[2];
    float *pixels = NULL;
    tyn_result r;
    if (dot && strcasecmp(dot, ".hdr") == 0) {
        r = load_hdr(size, &pixels, path, log);
    } else if (dot && strcasecmp(dot, ".exr") == 0) {
        r = load_exr(size, &pixels, path, log);
    } else {
        tyn_log_print(log, TYN_LOG_ERROR, "%s: unknown kind of environment: must be .exr or .hdr",
                      path);
        return TYN_ERR_PARAMS;
    }
    size_t count = r ? 0 : 3 * (size_t)size[0] * size[1];
    for (size_t i = 0; i < count; i++) {
        if (!isfinite(pixels[i])) {
            tyn_log_print(log, TYN_LOG_ERROR, "%s: pixel %zu, %zu is %g: must be finite", path,
                          i / 3 % size[0], i / 3 / size[0], pixels[i]);
            free(pixels);
            return TYN_ERR_PARAMS;
        }
        pixels[i] = fmaxf(pixels[i], 0.0f); // filters leave small negative values beside lamps
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
