// nvdb.c -- NanoVDB files: the segments, the codecs, and from the sparse tree to a dense grid.
//
// A file is a row of segments; a segment is a header, one record of metadata for each grid, then
// the grids. A grid is one block of memory that is used as it is: PNanoVDB.h knows its layout.
// Every read goes through PNanoVDB's bounds check, and every node is checked to lie inside the
// block.
#include "io/nvdb.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>
#ifdef TYN_HAVE_BLOSC
#include <blosc.h>
#endif
#define PNANOVDB_C
#define PNANOVDB_BUF_BOUNDS_CHECK
#include <nanovdb/PNanoVDB.h>
#include "base/bytes.h"
#include "base/fault.h"
#include "base/half.h"
#include "io/volume.h"

enum { HEADER_BYTES = 16, META_BYTES = 176, CODEC_NONE = 0, CODEC_ZIP = 1, CODEC_BLOSC = 2 };

typedef struct input {
    const uint8_t *begin;
    const char *file;
    const tyn_log *log;
} input;

// ---- the table of contents ------------------------------------------------------------------

// A grid as the file lists it.
typedef struct entry {
    const char *name;    // in the file
    const uint8_t *meta; // its record, in the file
    const uint8_t *data; // in the file
    uint64_t file_size, grid_size;
    uint32_t type, grid_class;
    uint16_t codec;
} entry;

typedef struct contents {
    entry *grids;
    uint32_t count;
} contents;

// Files and grids start with "NanoVDB0" to "NanoVDB2"; the ABI is the major version 32, in the
// upper 11 bits of the version.
static bool known(const uint8_t *magic, uint64_t version)
{
    return memcmp(magic, "NanoVDB", 7) == 0 && magic[7] >= '0' && magic[7] <= '2' &&
           version >> 21 == PNANOVDB_MAJOR_VERSION_NUMBER;
}

// One segment; returns its size, 0 after a fault.
static uint64_t read_segment(contents *list, const uint8_t *p, uint64_t size, const input *in)
{
    if (size < HEADER_BYTES || memcmp(p, "NanoVDB", 7) != 0) {
        return TYN_FAULT(in->log, 0, "%s: not a NanoVDB file (%s): must start with \"NanoVDB\"",
                         in->file,
                         p == in->begin ? "wrong magic number" : "damaged behind a segment");
    }
    if (!known(p, tyn_load(p + 8, 4))) {
        return TYN_FAULT(in->log, 0, "%s: NanoVDB version %llu: only version %d can be read",
                         in->file, (unsigned long long)(tyn_load(p + 8, 4) >> 21),
                         PNANOVDB_MAJOR_VERSION_NUMBER);
    }
    uint32_t count = (uint32_t)tyn_load(p + 12, 2);
    entry *grown = realloc(list->grids, (list->count + count + 1) * sizeof *grown);
    if (!grown) {
        return TYN_FAULT(in->log, 0, "%s: no memory to read it", in->file);
    }
    list->grids = grown;
    uint64_t at = HEADER_BYTES;
    for (uint32_t i = 0; i < count; i++) {
        const uint8_t *meta = p + at;
        uint64_t name_size = size - at < META_BYTES ? 0 : tyn_load(meta + 136, 4);
        if (size - at < META_BYTES || name_size < 1 || name_size > size - at - META_BYTES ||
            meta[META_BYTES + name_size - 1] != 0) {
            return TYN_FAULT(in->log, 0, "%s: cut short or damaged in the metadata of its grids",
                             in->file);
        }
        grown[list->count + i] = (entry){
            .name = (const char *)meta + META_BYTES,
            .meta = meta,
            .grid_size = tyn_load(meta, 8),
            .file_size = tyn_load(meta + 8, 8),
            .type = (uint32_t)tyn_load(meta + 32, 4),
            .grid_class = (uint32_t)tyn_load(meta + 36, 4),
            .codec = (uint16_t)tyn_load(meta + 168, 2),
        };
        at += META_BYTES + name_size;
    }
    for (uint32_t i = 0; i < count; i++) {
        entry *e = &grown[list->count + i];
        if (e->file_size > size - at) {
            return TYN_FAULT(in->log, 0, "%s: grid \"%.100s\" is cut short: has %llu of %llu bytes",
                             in->file, e->name, (unsigned long long)(size - at),
                             (unsigned long long)e->file_size);
        }
        e->data = p + at;
        at += e->file_size;
    }
    list->count += count;
    return at;
}

static const char *type_name(const entry *e)
{
    static const char *const names[PNANOVDB_GRID_TYPE_END] = {
        "unknown", "float", "double", "int16",  "int32", "int64", "vec3f",
        "vec3d",   "mask",  "half",   "uint32", "bool",  "rgba8", "fp4",
        "fp8",     "fp16",  "fpn",    "vec4f",  "vec4d", "index"};
    return e->grid_class == PNANOVDB_GRID_CLASS_LEVEL_SET ? "level set"
           : e->type < PNANOVDB_GRID_TYPE_END             ? names[e->type]
                                                          : "unknown";
}

static bool is_readable(const entry *e)
{
    return e->grid_class != PNANOVDB_GRID_CLASS_LEVEL_SET &&
           (e->type == PNANOVDB_GRID_TYPE_FLOAT || e->type == PNANOVDB_GRID_TYPE_HALF ||
            (e->type >= PNANOVDB_GRID_TYPE_FP4 && e->type <= PNANOVDB_GRID_TYPE_FPN));
}

static bool is_vector(const entry *e)
{
    return e->type == PNANOVDB_GRID_TYPE_VEC3F;
}

static const entry *choose(const contents *list, tyn_grid_job *job, const input *in)
{
    tyn_grid_entry *grids = calloc(list->count + 1, sizeof *grids);
    for (uint32_t i = 0; grids && i < list->count; i++) {
        const entry *e = &list->grids[i];
        grids[i] = (tyn_grid_entry){e->name, type_name(e), is_readable(e), is_vector(e)};
    }
    const int chosen = grids ? tyn_volume_choose(job, grids, list->count, in->file) : -1;
    free(grids);
    return chosen < 0 ? NULL : &list->grids[chosen];
}

// ---- codecs ---------------------------------------------------------------------------------

static bool unzip(uint8_t *out, const entry *e)
{
    uint64_t packed = e->file_size < 8 ? 0 : tyn_load(e->data, 8);
    uLongf size = (uLongf)e->grid_size;
    return packed > 0 && packed <= e->file_size - 8 &&
           uncompress(out, &size, e->data + 8, (uLong)packed) == Z_OK && size == e->grid_size;
}

#ifdef TYN_HAVE_BLOSC
// Blocks of 1 GiB of the grid, each with its packed size before it.
static bool unblosc(uint8_t *out, const entry *e)
{
    uint64_t at = 0, done = 0;
    while (done < e->grid_size) {
        uint64_t left = e->file_size - at, chunk = e->grid_size - done, packed;
        size_t unpacked = 0;
        chunk = chunk < (1ull << 30) ? chunk : 1ull << 30;
        if (left < 8 || (packed = tyn_load(e->data + at, 8)) > left - 8 ||
            blosc_cbuffer_validate(e->data + at + 8, (size_t)packed, &unpacked) != 0 ||
            unpacked != chunk ||
            blosc_decompress_ctx(e->data + at + 8, out + done, (size_t)chunk, 1) != (int)chunk) {
            return false;
        }
        at += 8 + packed;
        done += chunk;
    }
    return true;
}
#endif

// The grid's memory, aligned for PNanoVDB and padded to whole words; NULL after a fault.
static tyn_result unpack(const entry *e, const input *in, uint8_t **out)
{
    // No codec packs better than about 1 : 1030.
    if (e->grid_size < PNANOVDB_GRID_SIZE + PNANOVDB_TREE_SIZE ||
        e->grid_size / 1100 > e->file_size || e->grid_size > TYN_MAX_FILE_BYTES ||
        (e->codec == CODEC_NONE && e->grid_size != e->file_size)) {
        return TYN_FAULT(
            in->log, TYN_ERR_PARAMS, "%s: grid \"%.100s\" of %llu bytes stored in %llu cannot be",
            in->file, e->name, (unsigned long long)e->grid_size, (unsigned long long)e->file_size);
    }
    if (e->codec > CODEC_BLOSC) {
        return TYN_FAULT(in->log, TYN_ERR_PARAMS,
                         "%s: grid \"%.100s\" is packed by the unknown codec %u: must be none, ZIP "
                         "or BLOSC",
                         in->file, e->name, e->codec);
    }
#ifndef TYN_HAVE_BLOSC
    if (e->codec == CODEC_BLOSC) {
        return TYN_FAULT(
            in->log, TYN_ERR_UNSUPPORTED,
            "%s: grid \"%.100s\" is packed by BLOSC: build with -Dblosc=enabled (needs "
            "c-blosc), or save the file with ZIP",
            in->file, e->name);
    }
#endif
    uint8_t *memory = calloc(1, (size_t)e->grid_size + 64);
    if (!memory) {
        return TYN_FAULT(in->log, TYN_ERR_MEMORY, "%s: no memory for a grid of %llu bytes",
                         in->file, (unsigned long long)e->grid_size);
    }
    bool ok = true;
    if (e->codec == CODEC_NONE) {
        memcpy(memory, e->data, (size_t)e->grid_size);
    } else if (e->codec == CODEC_ZIP) {
        ok = unzip(memory, e);
    } else {
#ifdef TYN_HAVE_BLOSC
        ok = unblosc(memory, e);
#endif
    }
    if (!ok) {
        free(memory);
        return TYN_FAULT(in->log, TYN_ERR_PARAMS,
                         "%s: grid \"%.100s\" cannot be unpacked: its data are damaged", in->file,
                         e->name);
    }
    *out = memory;
    return TYN_OK;
}

// ---- from the tree to a dense grid ----------------------------------------------------------

typedef struct extraction {
    pnanovdb_buf_t buf;
    uint64_t size; // bytes of the grid
    uint32_t type;
    const pnanovdb_grid_type_constants_t *layout;
    int64_t lo[3]; // index coordinates of the first voxel of the volume
    tyn_volume *volume;
    uint32_t channels;    // of a voxel
    uint64_t voxels_left; // that no tile or leaf has covered
} extraction;

// The part of a cube of index space that lies in the volume, in voxels of the volume.
typedef struct region {
    uint32_t begin[3], end[3];
} region;

static bool clip(const extraction *x, const int64_t origin[3], int64_t side, region *out)
{
    for (int a = 0; a < 3; a++) {
        int64_t begin = origin[a] - x->lo[a], end = begin + side, size = x->volume->size[a];
        begin = begin < 0 ? 0 : begin;
        end = end > size ? size : end;
        if (begin >= end) {
            return false;
        }
        out->begin[a] = (uint32_t)begin;
        out->end[a] = (uint32_t)end;
    }
    return true;
}

static float *voxel(const extraction *x, uint32_t i, uint32_t j, uint32_t k)
{
    const uint32_t *n = x->volume->size;
    return x->volume->data + (((size_t)k * n[1] + j) * n[0] + i) * x->channels;
}

static void fill(const extraction *x, const region *r, const float value[3])
{
    for (uint32_t k = r->begin[2]; k < r->end[2]; k++) {
        for (uint32_t j = r->begin[1]; j < r->end[1]; j++) {
            float *row = voxel(x, 0, j, k);
            for (uint32_t i = r->begin[0]; i < r->end[0]; i++) {
                memcpy(row + (size_t)i * x->channels, value, x->channels * sizeof *value);
            }
        }
    }
}

// A value of a tile or the background (float for the quantised types).
static void tile_value(const extraction *x, pnanovdb_address_t address, float value[3])
{
    if (x->channels == 3) {
        for (uint32_t c = 0; c < 3; c++) {
            value[c] = pnanovdb_read_float(x->buf, pnanovdb_address_offset(address, 4 * c));
        }
        return;
    }
    value[0] = x->type == PNANOVDB_GRID_TYPE_HALF
                   ? tyn_half_to_float((uint16_t)pnanovdb_read_half(x->buf, address))
                   : pnanovdb_read_float(x->buf, address);
}

static void leaf_value(const extraction *x, pnanovdb_leaf_handle_t leaf, pnanovdb_coord_t ijk,
                       float value[3])
{
    pnanovdb_address_t at = pnanovdb_leaf_get_value_address(x->type, x->buf, leaf, &ijk);
    switch (x->type) {
    case PNANOVDB_GRID_TYPE_FP4:
        value[0] = pnanovdb_leaf_fp4_read_float(x->buf, at, &ijk);
        return;
    case PNANOVDB_GRID_TYPE_FP8:
        value[0] = pnanovdb_leaf_fp8_read_float(x->buf, at, &ijk);
        return;
    case PNANOVDB_GRID_TYPE_FP16:
        value[0] = pnanovdb_leaf_fp16_read_float(x->buf, at, &ijk);
        return;
    case PNANOVDB_GRID_TYPE_FPN:
        value[0] = pnanovdb_leaf_fpn_read_float(x->buf, at, &ijk);
        return;
    default:
        tile_value(x, at, value);
    }
}

// Tiles and leaves cover every voxel at most once; without this a small file with many overlapping
// ones would keep us busy for years.
static bool take(extraction *x, const region *r)
{
    uint64_t count =
        (uint64_t)(r->end[0] - r->begin[0]) * (r->end[1] - r->begin[1]) * (r->end[2] - r->begin[2]);
    bool enough = count <= x->voxels_left;
    x->voxels_left -= enough ? count : 0;
    return enough;
}

static bool copy_tile(extraction *x, const region *r, pnanovdb_address_t value)
{
    if (!take(x, r)) {
        return false;
    }
    float v[3];
    tile_value(x, value, v);
    fill(x, r, v);
    return true;
}

// A node of `bytes` at `address` lies behind the tree header and inside the memory, and is aligned.
static bool node_fits(const extraction *x, pnanovdb_address_t address, uint64_t bytes)
{
    uint64_t at = address.byte_offset;
    return at >= PNANOVDB_GRID_SIZE + PNANOVDB_TREE_SIZE && at % 8 == 0 && at <= x->size &&
           bytes <= x->size - at;
}

static bool copy_leaf(extraction *x, pnanovdb_leaf_handle_t leaf, const int64_t origin[3])
{
    region r;
    uint64_t bytes = x->layout->leaf_size;
    if (!node_fits(x, leaf.address, bytes)) {
        return false;
    }
    if (x->type == PNANOVDB_GRID_TYPE_FPN) {
        // Bits of a value are a power of two, 1 to 16, with the exponent in the upper three flag
        // bits.
        uint32_t log_bits = pnanovdb_leaf_get_bbox_dif_and_flags(x->buf, leaf) >> 29;
        if (log_bits > 4 || bytes + (64ull << log_bits) > x->size - leaf.address.byte_offset) {
            return false;
        }
    }
    if (!clip(x, origin, 8, &r)) {
        return true;
    }
    if (!take(x, &r)) {
        return false;
    }
    for (uint32_t k = r.begin[2]; k < r.end[2]; k++) {
        for (uint32_t j = r.begin[1]; j < r.end[1]; j++) {
            for (uint32_t i = r.begin[0]; i < r.end[0]; i++) {
                pnanovdb_coord_t ijk = {(int32_t)(i + x->lo[0] - origin[0]),
                                        (int32_t)(j + x->lo[1] - origin[1]),
                                        (int32_t)(k + x->lo[2] - origin[2])};
                leaf_value(x, leaf, ijk, voxel(x, i, j, k));
            }
        }
    }
    return true;
}

// A node between root and leaves: an upper one, whose children are lower ones, or a lower one, whose children are leaves.
static bool copy_inner(extraction *x, pnanovdb_address_t node, bool is_upper,
                       const int64_t origin[3])
{
    const pnanovdb_upper_handle_t upper = {node};
    const pnanovdb_lower_handle_t lower = {node};
    const uint32_t bits = is_upper ? 5 : 4, mask = (1u << bits) - 1; // children along an axis
    const int64_t side = is_upper ? 128 : 8;                         // of a child, voxels
    region r;
    if (!node_fits(x, node, is_upper ? x->layout->upper_size : x->layout->lower_size)) {
        return false;
    }
    for (uint32_t n = 0; n < 1u << 3 * bits; n++) {
        const int64_t at[3] = {origin[0] + side * (n >> 2 * bits),
                               origin[1] + side * (n >> bits & mask),
                               origin[2] + side * (n & mask)};
        if (!clip(x, at, side, &r)) {
            continue;
        }
        bool copied;
        if (is_upper ? pnanovdb_upper_get_child_mask(x->buf, upper, n)
                     : pnanovdb_lower_get_child_mask(x->buf, lower, n)) {
            copied =
                is_upper
                    ? copy_inner(x, pnanovdb_upper_get_child(x->type, x->buf, upper, n).address,
                                 false, at)
                    : copy_leaf(x, pnanovdb_lower_get_child(x->type, x->buf, lower, n), at);
        } else {
            copied =
                copy_tile(x, &r,
                          is_upper ? pnanovdb_upper_get_table_address(x->type, x->buf, upper, n)
                                   : pnanovdb_lower_get_table_address(x->type, x->buf, lower, n));
        }
        if (!copied) {
            return false;
        }
    }
    return true;
}

// Origin of a root tile: its key holds the upper 20 bits of each coordinate.
static void tile_origin(uint64_t key, int64_t origin[3])
{
    const int shifts[3] = {42, 21, 0};
    for (int a = 0; a < 3; a++) {
        origin[a] = (int32_t)((uint32_t)(key >> shifts[a]) << 12);
    }
}

static bool copy_root(extraction *x, pnanovdb_root_handle_t root)
{
    uint64_t at = root.address.byte_offset, room = x->size - at - x->layout->root_size;
    uint32_t tiles = pnanovdb_root_get_tile_count(x->buf, root);
    region r;
    if (tiles > room / x->layout->root_tile_size || tiles > 65536) {
        return false;
    }
    pnanovdb_address_t background =
        pnanovdb_address_offset(root.address, x->layout->root_off_background);
    if (clip(x, x->lo, 65536, &r)) {
        float v[3];
        tile_value(x, background, v);
        fill(x, &r, v);
    }
    for (uint32_t n = 0; n < tiles; n++) {
        pnanovdb_root_tile_handle_t tile = pnanovdb_root_get_tile(x->type, root, n);
        int64_t origin[3];
        tile_origin(pnanovdb_root_tile_get_key(x->buf, tile), origin);
        if (!clip(x, origin, 4096, &r)) {
            continue;
        }
        bool child = pnanovdb_root_tile_get_child(x->buf, tile) != 0;
        pnanovdb_address_t value =
            pnanovdb_address_offset(tile.address, x->layout->root_tile_off_value);
        if (!child && !copy_tile(x, &r, value)) {
            return false;
        }
        if (child && !copy_inner(x, pnanovdb_root_get_child(x->type, x->buf, root, tile).address,
                                 true, origin)) {
            return false;
        }
    }
    return true;
}

// Index to world: the file's map is row-major, and the volume starts at lo.
static void copy_map(extraction *x, pnanovdb_grid_handle_t grid)
{
    pnanovdb_map_handle_t map = pnanovdb_grid_get_map(x->buf, grid);
    double *m = x->volume->index_to_world;
    for (uint32_t row = 0; row < 3; row++) {
        m[12 + row] = pnanovdb_map_get_vecd(x->buf, map, row);
        for (uint32_t col = 0; col < 3; col++) {
            m[col * 4 + row] = pnanovdb_map_get_matd(x->buf, map, row * 3 + col);
            m[12 + row] += m[col * 4 + row] * (double)x->lo[col];
        }
    }
}

// The grid in memory, checked as far as its root.
static tyn_result look_at(extraction *x, pnanovdb_root_handle_t *root, uint8_t *memory,
                          const entry *e, const input *in)
{
    const pnanovdb_grid_handle_t grid = {{0}};
    *x = (extraction){
        .buf = pnanovdb_make_buf((uint32_t *)(void *)memory, (e->grid_size + 7) / 8 * 2),
        .size = e->grid_size,
        .type = e->type,
        .layout = &pnanovdb_grid_type_constants[e->type],
        .channels = is_vector(e) ? 3 : 1,
    };
    *root = pnanovdb_tree_get_root(x->buf, pnanovdb_grid_get_tree(x->buf, grid));
    uint64_t at = root->address.byte_offset;
    if (!known(memory, pnanovdb_grid_get_version(x->buf, grid)) ||
        pnanovdb_grid_get_grid_type(x->buf, grid) != e->type || at % 8 != 0 ||
        at < PNANOVDB_GRID_SIZE + PNANOVDB_TREE_SIZE || at > x->size ||
        x->size - at < x->layout->root_size) {
        return TYN_FAULT(in->log, TYN_ERR_PARAMS, "%s: grid \"%.100s\" is damaged in its header",
                         in->file, e->name);
    }
    return TYN_OK;
}

static tyn_result extract(tyn_grid_job *job, uint8_t *memory, const entry *e, const input *in)
{
    const pnanovdb_grid_handle_t grid = {{0}};
    extraction x;
    pnanovdb_root_handle_t root;
    TYN_TRY(look_at(&x, &root, memory, e, in));
    x.volume = &job->volume;
    pnanovdb_coord_t lo = pnanovdb_root_get_bbox_min(x.buf, root);
    pnanovdb_coord_t hi = pnanovdb_root_get_bbox_max(x.buf, root);
    if (lo.x > hi.x || lo.y > hi.y || lo.z > hi.z) {
        return TYN_FAULT(in->log, TYN_ERR_PARAMS, "%s: grid \"%.100s\" has no active voxels",
                         in->file, e->name);
    }
    const int64_t size[3] = {(int64_t)hi.x - lo.x + 1, (int64_t)hi.y - lo.y + 1,
                             (int64_t)hi.z - lo.z + 1};
    job->channels = x.channels;
    TYN_TRY(tyn_volume_alloc(&job->volume, size, x.channels, in->file, in->log));
    x.voxels_left = (uint64_t)(size[0] * size[1] * size[2]);
    x.lo[0] = lo.x, x.lo[1] = lo.y, x.lo[2] = lo.z;
    if (!copy_root(&x, root)) {
        tyn_volume_finish(&job->volume);
        return TYN_FAULT(
            in->log, TYN_ERR_PARAMS,
            "%s: grid \"%.100s\" is damaged: nodes of its tree lie outside of it or overlap",
            in->file, e->name);
    }
    copy_map(&x, grid);
    return TYN_OK;
}

// ---- what is in a file ------------------------------------------------------------------------

// Least and largest value of the box that would be read.
static void find_range(tyn_volume_grid *g, const tyn_grid_job *job)
{
    const uint32_t *n = job->volume.size;
    const size_t count = (size_t)n[0] * n[1] * n[2] * job->channels;
    for (size_t i = 0; i < count; i++) {
        const float v = job->volume.data[i];
        if (!(v - v == 0)) { // not finite
            g->has_range = false;
            return;
        }
        g->least = !g->has_range || v < g->least ? v : g->least;
        g->most = !g->has_range || v > g->most ? v : g->most;
        g->has_range = true;
    }
}

static bool can_unpack(const entry *e)
{
#ifdef TYN_HAVE_BLOSC
    return e->codec <= CODEC_BLOSC;
#else
    return e->codec <= CODEC_ZIP;
#endif
}

// Of grids that can be read all; of others what the table of contents says of them. `left`: values that may still be read for
// their range, as a megabyte can name thousands of large grids.
static tyn_result tell(tyn_volume_grid *g, const entry *e, const input *in, double *left)
{
    static const char *const classes[PNANOVDB_GRID_CLASS_END] = {
        "unknown",    "level set", "fog volume",   "staggered", "point index",
        "point data", "topology",  "voxel volume", "index grid"};
    const uint8_t *meta = e->meta;
    *g = (tyn_volume_grid){.active_voxels = tyn_load(meta + 24, 8)};
    snprintf(g->name, sizeof g->name, "%s", e->name);
    const bool level_set = e->grid_class == PNANOVDB_GRID_CLASS_LEVEL_SET;
    const entry plain = {.type = e->type};
    snprintf(g->type, sizeof g->type, "%s", type_name(&plain));
    snprintf(g->grid_class, sizeof g->grid_class, "%s",
             e->grid_class < PNANOVDB_GRID_CLASS_END ? classes[e->grid_class] : "unknown");
    for (int a = 0; a < 3; a++) {
        const uint64_t bits = tyn_load(meta + 112 + 8 * a, 8);
        double edge;
        memcpy(&edge, &bits, sizeof edge);
        g->lo[a] = (int32_t)tyn_load(meta + 88 + 4 * a, 4);
        g->hi[a] = (int32_t)tyn_load(meta + 100 + 4 * a, 4);
        g->index_to_world[5 * a] = edge;
    }
    g->index_to_world[15] = 1;
    g->affine = true;
    tyn_result r = TYN_OK;
    double values = is_vector(e) ? 3 : 1;
    bool fits = true;
    for (int a = 0; a < 3; a++) {
        const double side = (double)g->hi[a] - g->lo[a] + 1;
        fits = fits && side <= 65536;
        values *= side;
    }
    fits = fits && values <= *left && can_unpack(e);
    if (fits && !level_set && g->active_voxels && (is_readable(e) || is_vector(e))) {
        *left -= values;
        uint8_t *memory = NULL;
        tyn_grid_job job = {.log = in->log};
        r = unpack(e, in, &memory);
        r = r ? r : extract(&job, memory, e, in);
        if (!r) {
            find_range(g, &job);
            memcpy(g->index_to_world, job.volume.index_to_world, sizeof g->index_to_world);
            for (int a = 0; a < 3; a++) { // that of a volume begins at its first voxel
                for (int b = 0; b < 3; b++) {
                    g->index_to_world[12 + a] -= g->index_to_world[4 * b + a] * g->lo[b];
                }
            }
        }
        tyn_volume_finish(&job.volume);
        free(memory);
    }
    tyn_volume_grid_place(g);
    return r;
}

static tyn_result tell_all(tyn_grid_job *job, const contents *list, const input *in)
{
    double left = (double)TYN_MAX_VOXELS;
    tyn_result r = tyn_grid_begin_list(job, list->count, in->file);
    for (uint32_t i = 0; !r && i < list->count; i++) {
        r = tell(&job->list[i], &list->grids[i], in, &left);
    }
    if (r) {
        tyn_grid_drop(job);
    }
    return r;
}

tyn_result tyn_nvdb_read(tyn_grid_job *job, const void *bytes, size_t size, const char *file)
{
    const input in = {bytes, file, job->log};
    contents list = {0};
    uint8_t *memory = NULL;
    tyn_result r = TYN_OK;
    memset(&job->volume, 0, sizeof job->volume);
    uint64_t at = 0;
    do {
        uint64_t length = read_segment(&list, (const uint8_t *)bytes + at, size - at, &in);
        if (length == 0) {
            r = TYN_ERR_PARAMS;
        }
        at += length;
    } while (!r && at < size);
    if (!r && job->use == TYN_GRID_LIST) {
        r = tell_all(job, &list, &in);
        free(list.grids);
        return r;
    }
    const entry *e = r ? NULL : choose(&list, job, &in);
    if (e) {
        r = unpack(e, &in, &memory);
        r = r ? r : extract(job, memory, e, &in);
        r = r ? r : tyn_grid_seal(job, file, e->name);
    } else {
        r = TYN_ERR_PARAMS;
    }
    free(memory);
    free(list.grids);
    return r;
}

tyn_result tyn_nvdb_read_file(tyn_grid_job *job, const char *path)
{
    void *bytes;
    size_t size;
    tyn_result r = tyn_file_read(path, TYN_MAX_FILE_BYTES, &bytes, &size, job->log);
    if (!r) {
        r = tyn_nvdb_read(job, bytes, size, path);
        free(bytes);
    }
    return r;
}
