// maps.c -- what latitude-longitude maps have in common, and their OpenEXR files.
#include "maps.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "portable.h"

gen_map gen_map_new(int width, int height)
{
    gen_map map = {width, height, calloc((size_t)width * (size_t)height * 3, sizeof(float))};
    if (!map.rgb) {
        fprintf(stderr, "out of memory for a map of %d x %d\n", width, height);
        exit(1);
    }
    return map;
}

void gen_map_free(gen_map *map)
{
    free(map->rgb);
    *map = (gen_map){0};
}

void gen_map_direction(const gen_map *map, int x, int y, double direction[3])
{
    const double theta = GEN_PI * (y + 0.5) / map->height;
    const double phi = 2.0 * GEN_PI * ((x + 0.5) / map->width - 0.5);
    direction[0] = gen_sin(theta) * gen_sin(phi);
    direction[1] = gen_cos(theta);
    direction[2] = -gen_sin(theta) * gen_cos(phi);
}

double gen_map_solid_angle(const gen_map *map, int y)
{
    const double step = GEN_PI / map->height;
    return 2.0 * GEN_PI / map->width * (gen_cos(y * step) - gen_cos((y + 1) * step));
}

// ---- OpenEXR ------------------------------------------------------------------------------------

typedef struct bytes {
    uint8_t *data;
    size_t size;
} bytes;

static void put(bytes *b, const void *data, size_t size)
{
    memcpy(b->data + b->size, data, size);
    b->size += size;
}

static void put_u32(bytes *b, uint32_t v)
{
    put(b, (const uint8_t[]){v & 255, v >> 8 & 255, v >> 16 & 255, v >> 24}, 4);
}

static void put_u64(bytes *b, uint64_t v)
{
    put_u32(b, (uint32_t)v);
    put_u32(b, (uint32_t)(v >> 32));
}

static void put_float(bytes *b, float v)
{
    uint32_t bits;
    memcpy(&bits, &v, 4);
    put_u32(b, bits);
}

static void put_attribute(bytes *b, const char *name, const char *type, uint32_t size)
{
    put(b, name, strlen(name) + 1);
    put(b, type, strlen(type) + 1);
    put_u32(b, size);
}

static void put_window(bytes *b, const char *name, const gen_map *map)
{
    put_attribute(b, name, "box2i", 16);
    put_u32(b, 0);
    put_u32(b, 0);
    put_u32(b, (uint32_t)map->width - 1);
    put_u32(b, (uint32_t)map->height - 1);
}

static void put_header(bytes *b, const gen_map *map)
{
    enum { FLOAT = 2 };
    put_u32(b, 20000630); // magic number
    put_u32(b, 2);        // version; one part of lines
    put_attribute(b, "channels", "chlist", 3 * 18 + 1);
    for (int c = 0; c < 3; c++) {
        put(b, &"B\0G\0R"[2 * c], 2);
        put_u32(b, FLOAT);
        put_u32(b, 0); // not perceptually linear
        put_u32(b, 1); // every pixel along x
        put_u32(b, 1); // and y
    }
    put(b, "", 1);
    put_attribute(b, "compression", "compression", 1);
    put(b, "", 1); // none
    put_window(b, "dataWindow", map);
    put_window(b, "displayWindow", map);
    put_attribute(b, "lineOrder", "lineOrder", 1);
    put(b, "", 1); // from the top
    put_attribute(b, "pixelAspectRatio", "float", 4);
    put_float(b, 1.0f);
    put_attribute(b, "screenWindowCenter", "v2f", 8);
    put_float(b, 0.0f);
    put_float(b, 0.0f);
    put_attribute(b, "screenWindowWidth", "float", 4);
    put_float(b, 1.0f);
    put(b, "", 1);
}

bool gen_write_exr(const char *folder, const char *file, const gen_map *map)
{
    const size_t width = (size_t)map->width, height = (size_t)map->height;
    bytes b = {malloc(1024 + height * (16 + 12 * width)), 0};
    if (!b.data) {
        fprintf(stderr, "out of memory for %s\n", file);
        exit(1);
    }
    put_header(&b, map);
    const size_t first = b.size + 8 * height;
    for (size_t y = 0; y < height; y++) {
        put_u64(&b, first + y * (8 + 12 * width));
    }
    for (size_t y = 0; y < height; y++) {
        put_u32(&b, (uint32_t)y);
        put_u32(&b, (uint32_t)(12 * width));
        for (int c = 2; c >= 0; c--) {
            for (size_t x = 0; x < width; x++) {
                put_float(&b, map->rgb[3 * (y * width + x) + (size_t)c]);
            }
        }
    }
    char path[4096];
    snprintf(path, sizeof(path), "%s/%s", folder, file);
    FILE *f = fopen(path, "wb");
    bool ok = f && fwrite(b.data, 1, b.size, f) == b.size;
    if (f && fclose(f) != 0) {
        ok = false;
    }
    free(b.data);
    if (!ok) {
        fprintf(stderr, "%s: cannot be written\n", path);
    }
    return ok;
}
