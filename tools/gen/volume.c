// volume.c -- grids, and the raw and HDR files made of them.
#include "volume.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Binary16 of a value in [0, 65504], to nearest; what is below the smallest normal becomes 0.
static uint16_t half_of(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, 4);
    if (bits < 0x38800000u) {
        return 0;
    }
    const uint32_t half = (bits - 0x38000000u) >> 13, rest = bits & 0x1fffu;
    return (uint16_t)(half + (rest > 0x1000u || (rest == 0x1000u && (half & 1u))));
}

gen_grid gen_grid_new(int nx, int ny, int nz)
{
    gen_grid g = {.n = {nx, ny, nz}};
    g.data = calloc((size_t)nx * (size_t)ny * (size_t)nz, sizeof(float));
    if (!g.data) {
        fprintf(stderr, "out of memory for a grid of %d x %d x %d\n", nx, ny, nz);
        exit(1);
    }
    return g;
}

void gen_grid_free(gen_grid *grid)
{
    free(grid->data);
    *grid = (gen_grid){0};
}

static inline float clamp(float v, float lo, float hi)
{
    return v < lo ? lo : v > hi ? hi : v;
}

bool gen_write_bytes(const char *folder, const char *file, const char *head, const void *bytes,
                     size_t size)
{
    char path[4096];
    snprintf(path, sizeof(path), "%s/%s", folder, file);
    FILE *f = fopen(path, "wb");
    bool ok = f && fwrite(head, 1, strlen(head), f) == strlen(head);
    ok = ok && fwrite(bytes, 1, size, f) == size;
    if (f && fclose(f) != 0) {
        ok = false;
    }
    if (!ok) {
        fprintf(stderr, "%s: cannot be written\n", path);
    }
    return ok;
}

static uint8_t *bytes_new(size_t size)
{
    uint8_t *bytes = malloc(size);
    if (!bytes) {
        fprintf(stderr, "out of memory for %zu bytes\n", size);
        exit(1);
    }
    return bytes;
}

bool gen_write_f16(const char *folder, const char *file, const gen_grid *grid)
{
    const size_t count = (size_t)grid->n[0] * (size_t)grid->n[1] * (size_t)grid->n[2];
    uint8_t *bytes = bytes_new(count * 2);
    for (size_t i = 0; i < count; i++) {
        const uint16_t h = half_of(grid->data[i]);
        bytes[2 * i] = (uint8_t)(h & 0xff);
        bytes[2 * i + 1] = (uint8_t)(h >> 8);
    }
    const bool ok = gen_write_bytes(folder, file, "", bytes, count * 2);
    free(bytes);
    return ok;
}

bool gen_write_u8(const char *folder, const char *file, const gen_grid *grid)
{
    const size_t count = (size_t)grid->n[0] * (size_t)grid->n[1] * (size_t)grid->n[2];
    uint8_t *bytes = bytes_new(count);
    for (size_t i = 0; i < count; i++) {
        bytes[i] = (uint8_t)(clamp(grid->data[i], 0.0f, 1.0f) * 255.0f + 0.5f);
    }
    const bool ok = gen_write_bytes(folder, file, "", bytes, count);
    free(bytes);
    return ok;
}

bool gen_write_hdr(const char *folder, const char *file, int width, int height, const float *rgb)
{
    char head[128];
    snprintf(head, sizeof(head), "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n", height,
             width);
    const size_t count = (size_t)width * (size_t)height;
    uint8_t *bytes = bytes_new(count * 4);
    for (size_t i = 0; i < count; i++) {
        const float *c = rgb + 3 * i;
        const float top = fmaxf(c[0], fmaxf(c[1], c[2]));
        uint8_t *out = bytes + 4 * i;
        memset(out, 0, 4);
        if (top > 1e-32f) {
            int exponent;
            const float scale = frexpf(top, &exponent) * 256.0f / top; // mantissa in [128, 256)
            for (int k = 0; k < 3; k++) {
                out[k] = (uint8_t)(c[k] * scale);
            }
            out[3] = (uint8_t)(exponent + 128);
        }
    }
    const bool ok = gen_write_bytes(folder, file, head, bytes, count * 4);
    free(bytes);
    return ok;
}
