// nvdb_write.c -- a NanoVDB file with one grid: header, metadata, then grid, tree, root, tiles,
// upper, lower and leaf nodes in this order. Offsets and sizes are those of the format's version
// 32.4; nothing is taken from the reader under test.
#include "nvdb_write.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>
#ifdef TYN_HAVE_BLOSC
#include <blosc.h>
#endif
#include "base/half.h"

enum { GRID = 672, TREE = 64, TILE = 32, VERSION = 32 << 21 | 4 << 10 };

// Sizes of nodes, and where their tables begin and how far apart the entries of these are.
typedef struct layout {
    uint32_t root, upper, upper_table, lower, lower_table, stride, leaf_table;
} layout;

static layout layout_of(const nvdb_spec *s)
{
    return s->type == NVDB_VEC3F ? (layout){96, 532544, 8256, 66624, 1088, 16, 128}
                                 : (layout){64, 270400, 8256, 33856, 1088, 8, 96};
}

static void put(uint8_t *at, uint64_t v, int bytes)
{
    for (int i = 0; i < bytes; i++) {
        at[i] = (uint8_t)(v >> (8 * i));
    }
}

static void put_float(uint8_t *at, float v)
{
    uint32_t u;
    memcpy(&u, &v, 4);
    put(at, u, 4);
}

static void put_double(uint8_t *at, double v)
{
    uint64_t u;
    memcpy(&u, &v, 8);
    put(at, u, 8);
}

static void set_bit(uint8_t *mask, uint32_t n)
{
    mask[n >> 3] |= (uint8_t)(1u << (n & 7));
}

// A value as the tables of tiles hold it.
static void put_value(const nvdb_spec *s, uint8_t *at, float v)
{
    if (s->type == NVDB_HALF) {
        put(at, tyn_half_from_float(v), 2);
        return;
    }
    for (int c = 0; c < (s->type == NVDB_VEC3F ? 3 : 1); c++) {
        put_float(at + 4 * c, v / (float)(1 << c));
    }
}

static int fpn_log_bits(const nvdb_spec *s)
{
    return s->type == NVDB_FP4 ? 2 : s->type == NVDB_FP8 ? 3 : s->type == NVDB_FP16 ? 4 : 3;
}

static size_t leaf_size(const nvdb_spec *s)
{
    return s->type == NVDB_VEC3F   ? 6272
           : s->type == NVDB_FLOAT ? 2144
           : s->type == NVDB_HALF  ? 1120
                                   : 96 + (64u << fpn_log_bits(s));
}

// Distinct nodes of one level that cover the active box.
typedef struct level {
    int bits; // log2 of the node's side
    int32_t lo[3], count[3];
    uint64_t offset, size;
} level;

static level make_level(const nvdb_spec *s, int bits, uint64_t size)
{
    level l = {.bits = bits, .size = size};
    for (int a = 0; a < 3; a++) {
        l.lo[a] = s->lo[a] >> bits;
        l.count[a] = (s->hi[a] >> bits) - l.lo[a] + 1;
    }
    return l;
}

static uint64_t num_nodes(const level *l)
{
    return (uint64_t)l->count[0] * (uint64_t)l->count[1] * (uint64_t)l->count[2];
}

static uint64_t node_at(const level *l, int32_t i, int32_t j, int32_t k)
{
    uint64_t n = ((uint64_t)((i >> l->bits) - l->lo[0]) * (uint64_t)l->count[1] +
                  (uint64_t)((j >> l->bits) - l->lo[1])) *
                     (uint64_t)l->count[2] +
                 (uint64_t)((k >> l->bits) - l->lo[2]);
    return l->offset + n * l->size;
}

static void put_box(const nvdb_spec *s, uint8_t *at)
{
    for (int a = 0; a < 3; a++) {
        put(at + 4 * a, (uint32_t)s->lo[a], 4);
        put(at + 12 + 4 * a, (uint32_t)s->hi[a], 4);
    }
}

static void write_leaf(const nvdb_spec *s, uint8_t *leaf, int32_t x, int32_t y, int32_t z)
{
    int log_bits = fpn_log_bits(s);
    uint32_t steps = (1u << (1 << log_bits)) - 1;
    put(leaf, (uint32_t)x, 4), put(leaf + 4, (uint32_t)y, 4), put(leaf + 8, (uint32_t)z, 4);
    if (s->type == NVDB_FPN) {
        put(leaf + 12, (uint32_t)log_bits << 29, 4);
    }
    if (s->type >= NVDB_FP4) { // minimum and quantum of the values in [0, 1]
        put_float(leaf + 80, 0.0f);
        put_float(leaf + 84, 1.0f / (float)steps);
    }
    for (int n = 0; n < 512; n++) {
        int32_t p[3] = {x + (n >> 6), y + (n >> 3 & 7), z + (n & 7)};
        float v = s->value ? s->value(p[0], p[1], p[2]) : 1.0f;
        if (p[0] >= s->lo[0] && p[0] <= s->hi[0] && p[1] >= s->lo[1] && p[1] <= s->hi[1] &&
            p[2] >= s->lo[2] && p[2] <= s->hi[2]) {
            set_bit(leaf + 16, (uint32_t)n);
        }
        if (s->type == NVDB_VEC3F) {
            put_value(s, leaf + layout_of(s).leaf_table + 12 * n, v);
        } else if (s->type == NVDB_FLOAT) {
            put_float(leaf + 96 + 4 * n, v);
        } else if (s->type == NVDB_HALF) {
            put(leaf + 96 + 2 * n, tyn_half_from_float(v), 2);
        } else {
            uint32_t code = (uint32_t)lrintf(v * (float)steps);
            uint32_t bit = (uint32_t)n << log_bits;
            uint8_t *at = leaf + 96 + bit / 8;
            if (log_bits == 4) {
                put(at, code, 2);
            } else {
                *at |= (uint8_t)(code << (bit & 7));
            }
        }
    }
}

static void write_grid(const nvdb_spec *s, uint8_t *g, const level *upper, const level *lower,
                       const level *leaf, uint64_t size)
{
    uint8_t *tree = g + GRID, *root = tree + TREE;
    memcpy(g, "NanoVDB0", 8);
    put(g + 16, VERSION, 4);
    put(g + 28, 1, 4);
    put(g + 32, size, 8);
    strncpy((char *)g + 40, s->name, 255);
    for (int a = 0; a < 3; a++) {
        put_float(g + 296 + 16 * a, (float)s->voxel);
        put_float(g + 296 + 36 + 16 * a, (float)(1.0 / s->voxel));
        put_double(g + 296 + 88 + 32 * a, s->voxel);
        put_double(g + 296 + 160 + 32 * a, 1.0 / s->voxel);
        put_double(g + 608 + 8 * a, s->voxel);
    }
    put(g + 632, s->grid_class, 4);
    put(g + 636, s->type, 4);
    put(tree + 0, leaf->offset - GRID, 8);
    put(tree + 8, lower->offset - GRID, 8);
    put(tree + 16, upper->offset - GRID, 8);
    put(tree + 24, TREE, 8);
    put_box(s, root);
    put(root + 24, num_nodes(upper), 4);
    put_value(s, root + 28, s->background);
}

// All nodes above the leaves get children or, for the one tile, a value.
static void write_nodes(const nvdb_spec *s, uint8_t *g, const level *upper, const level *lower,
                        const level *leaf)
{
    const layout at = layout_of(s);
    uint64_t n = 0;
    for (int32_t x = upper->lo[0]; x < upper->lo[0] + upper->count[0]; x++) {
        for (int32_t y = upper->lo[1]; y < upper->lo[1] + upper->count[1]; y++) {
            for (int32_t z = upper->lo[2]; z < upper->lo[2] + upper->count[2]; z++, n++) {
                uint8_t *tile = g + GRID + TREE + at.root + n * TILE;
                uint64_t key = ((uint32_t)z & 0xfffff) | (uint64_t)((uint32_t)y & 0xfffff) << 21 |
                               (uint64_t)((uint32_t)x & 0xfffff) << 42;
                put(tile, key, 8);
                put(tile + 8, upper->offset + n * at.upper - (GRID + TREE), 8);
            }
        }
    }
    for (int32_t x = s->lo[0] & ~7; x <= s->hi[0]; x += 8) {
        for (int32_t y = s->lo[1] & ~7; y <= s->hi[1]; y += 8) {
            for (int32_t z = s->lo[2] & ~7; z <= s->hi[2]; z += 8) {
                uint64_t u = node_at(upper, x, y, z), w = node_at(lower, x, y, z);
                uint32_t in_u =
                    (uint32_t)((x & 4095) >> 7 << 10 | (y & 4095) >> 7 << 5 | (z & 4095) >> 7);
                uint32_t in_w =
                    (uint32_t)((x & 127) >> 3 << 8 | (y & 127) >> 3 << 4 | (z & 127) >> 3);
                set_bit(g + u + 4128, in_u);
                put(g + u + at.upper_table + at.stride * in_u, w - u, 8);
                if (s->tile_value != 0.0f && x == s->tile[0] && y == s->tile[1] &&
                    z == s->tile[2]) {
                    set_bit(g + w + 32, in_w);
                    put_value(s, g + w + at.lower_table + at.stride * in_w, s->tile_value);
                    continue;
                }
                uint64_t l = node_at(leaf, x, y, z);
                set_bit(g + w + 544, in_w);
                put(g + w + at.lower_table + at.stride * in_w, l - w, 8);
                write_leaf(s, g + l, x, y, z);
            }
        }
    }
}

uint8_t *nvdb_write(const nvdb_spec *s, size_t *size, size_t *grid_offset)
{
    const layout at = layout_of(s);
    level upper = make_level(s, 12, at.upper), lower = make_level(s, 7, at.lower);
    level leaf = make_level(s, 3, leaf_size(s));
    upper.offset = GRID + TREE + at.root + num_nodes(&upper) * TILE;
    lower.offset = upper.offset + num_nodes(&upper) * at.upper;
    leaf.offset = lower.offset + num_nodes(&lower) * at.lower;
    uint64_t grid_size = leaf.offset + num_nodes(&leaf) * leaf.size, packed = grid_size;
    uint8_t *grid = calloc(1, grid_size), *data = grid;
    write_grid(s, grid, &upper, &lower, &leaf, grid_size);
    write_nodes(s, grid, &upper, &lower, &leaf);
    if (s->codec == NVDB_ZIP) {
        uLongf room = compressBound(grid_size);
        data = malloc(8 + room);
        compress(data + 8, &room, grid, grid_size);
        put(data, room, 8);
        packed = 8 + room;
    }
#ifdef TYN_HAVE_BLOSC
    if (s->codec == NVDB_BLOSC) {
        data = malloc(8 + grid_size + BLOSC_MAX_OVERHEAD);
        int n = blosc_compress_ctx(9, 1, 4, grid_size, grid, data + 8,
                                   grid_size + BLOSC_MAX_OVERHEAD, "lz4", 1 << 18, 1);
        put(data, (uint64_t)n, 8);
        packed = 8 + (uint64_t)n;
    }
#endif
    size_t name_size = strlen(s->name) + 1, head = 16 + 176 + name_size;
    uint8_t *file = calloc(1, head + packed);
    memcpy(file, "NanoVDB0", 8);
    put(file + 8, VERSION, 4);
    put(file + 12, 1, 2);
    put(file + 14, s->codec, 2);
    put(file + 16, grid_size, 8);
    put(file + 24, packed, 8);
    uint64_t active = 1;
    for (int a = 0; a < 3; a++) {
        active *= (uint64_t)(s->hi[a] - s->lo[a] + 1);
        put_double(file + 16 + 112 + 8 * a, s->voxel);
    }
    put(file + 16 + 24, active, 8);
    put(file + 16 + 32, s->type, 4);
    put(file + 16 + 36, s->grid_class, 4);
    put_box(s, file + 16 + 88);
    put(file + 16 + 136, name_size, 4);
    put(file + 16 + 168, s->codec, 2);
    memcpy(file + 16 + 176, s->name, name_size);
    memcpy(file + head, data, packed);
    if (data != grid) {
        free(data);
    }
    free(grid);
    *size = head + packed;
    if (grid_offset) {
        *grid_offset = head;
    }
    return file;
}
