// vdb_check.c -- walks over the structure of an OpenVDB file before the library reads it.
//
// OpenVDB believes every length and count of a file: a few changed bytes have it read for ever or take all memory, and
// Blosc is not told where its input ends. Here all of them are held against the bytes that are left, and the values of
// inner nodes are unpacked once: where they cannot be, the library forgets the node that it was about to fill, and never
// frees it. The order is that of OpenVDB 10: io/Archive.cc, MetaMap.cc, math/Maps.h, and readTopology and readBuffers
// of tree/RootNode.h, InternalNode.h and LeafNode.h. Trees of other types than are listed here are not read, and not
// walked.
#include "io/vdb_check.h"
#include "base/bytes.h"
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>
#ifdef TYN_HAVE_BLOSC
#include <blosc.h>
#endif

enum {
    OLDEST = 221, // what the library still reads
    NODE_MASK =
        222, // from here on values are compressed by masks, and the flags stand with the grid
    ZIP = 1, // flags of compression
    ACTIVE_MASK = 2,                //
    BLOSC = 4,                      //
    LEAF_BITS = 9,                  // a leaf has 8^3 voxels,
    LOWER_BITS = 12,                // the node above it 16^3 children,
    UPPER_BITS = 15,                // and the one below the root 32^3
    LEAF_MASK = 64,                 // bytes
    MOST_VALUES = 24 << UPPER_BITS, // bytes, of a node
    MAX_NAME = 256,                 // of what is compared
    ALL_VALUES = 6,                 // how the values of a node are stored: all of them
    BLOSC_HEADER = 16,              // bytes
    LEAST_BLOSC = 128,              // bytes, to which the index for delayed loading is filled up
    SMALLEST_DESCRIPTOR = 36        // bytes
};

typedef struct walk {
    const uint8_t *bytes;
    uint64_t size, at;
    uint32_t version, compression;
    bool half;             // the grid's reals are stored as half floats
    const char *fault;     // what is wrong, NULL: nothing yet
    uint64_t fault_at;     // and where
    char detail[MAX_NAME]; // behind it
    uint16_t *leaves;      // active voxels of each leaf, in the order of the file
    uint64_t num_leaves, room;
    uint8_t *values; // where those of inner nodes are unpacked: MOST_VALUES bytes
} walk;

// How the values of a tree are stored.
typedef struct value_type {
    const char *tree;
    uint32_t size, half_size; // bytes; the second under `half`
} value_type;

static const value_type value_types[] = {{"Tree_float_5_4_3", 4, 2},  {"Tree_double_5_4_3", 8, 2},
                                         {"Tree_int32_5_4_3", 4, 4},  {"Tree_int64_5_4_3", 8, 8},
                                         {"Tree_vec3s_5_4_3", 12, 6}, {"Tree_vec3d_5_4_3", 24, 6},
                                         {"Tree_vec3i_5_4_3", 12, 12}};

#define NUM(table) (sizeof(table) / sizeof(table)[0])

// ---- bytes ------------------------------------------------------------------------------------

static void fail(walk *w, const char *fault, const char *detail)
{
    if (!w->fault) {
        w->fault = fault;
        w->fault_at = w->at;
        snprintf(w->detail, sizeof w->detail, "%s", detail);
    }
}

// The next bytes; NULL after a fault, or where they would end beyond the file.
static const uint8_t *take(walk *w, uint64_t count)
{
    if (w->fault || count > w->size - w->at) {
        fail(w, "is cut short or damaged: something would end beyond the file", "");
        return NULL;
    }
    const uint8_t *bytes = w->bytes + w->at;
    w->at += count;
    return bytes;
}

static uint32_t take_u32(walk *w)
{
    const uint8_t *b = take(w, 4);
    return b ? (uint32_t)tyn_load(b, 4) : 0;
}

static int64_t take_i64(walk *w)
{
    const uint8_t *b = take(w, 8);
    return b ? (int64_t)tyn_load(b, 8) : 0;
}

// A text with its length before it. `text` holds as much of it as fits.
static void take_text(walk *w, char text[MAX_NAME])
{
    const uint32_t length = take_u32(w);
    const uint8_t *b = take(w, length);
    const size_t kept = !b ? 0 : length < MAX_NAME ? length : MAX_NAME - 1;
    if (kept) {
        memcpy(text, b, kept);
    }
    text[kept] = '\0';
}

static uint32_t count_bits(const uint8_t *mask, uint32_t bytes)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < bytes; i++) {
        count += (uint32_t)__builtin_popcount(mask[i]);
    }
    return count;
}

// ---- metadata ---------------------------------------------------------------------------------

// What Blosc will believe of a block of `size` bytes: its header's sizes of the block and of what comes out, `out` bytes
// at most (where it is less, the library says so).
static void check_blosc(walk *w, const uint8_t *block, uint64_t size, uint64_t out)
{
    if (size < BLOSC_HEADER || tyn_load(block + 12, 4) != size || tyn_load(block + 4, 4) > out) {
        fail(w, "is damaged: a compressed block has other sizes than its header", "");
    }
}

// The index of leaves for delayed loading, which is read all the same: a count, then two lists of so many values, each
// behind the bytes that it takes if it is compressed.
static void check_delayed(walk *w, const uint8_t *value, uint32_t size)
{
    static const uint32_t element[2] = {1, 8};
    walk in = {.bytes = value, .size = size};
    const uint32_t count = take_u32(&in);
    for (int list = 0; list < 2 && !in.fault; list++) {
        const uint32_t bytes = take_u32(&in);
        if (bytes == UINT32_MAX && list == 1) {
            break; // there is none
        }
        const uint64_t out = (uint64_t)count * element[list];
        const uint8_t *block = take(&in, bytes ? bytes : out);
        if (block && bytes) {
            check_blosc(&in, block, bytes, out < LEAST_BLOSC ? LEAST_BLOSC : out);
        }
    }
    if (size && (in.fault || (uint64_t)count * LEAF_MASK > w->size)) {
        fail(w, "is damaged: its index for delayed loading does not fit", "");
    }
}

// The library reads values of its own types in the size of the type, whatever the file says.
static uint32_t metadata_size(const char *type)
{
    static const struct {
        const char *type;
        uint32_t size;
    } sizes[] = {{"bool", 1},    {"double", 8},  {"float", 4},  {"int32", 4},  {"int64", 8},
                 {"vec2i", 8},   {"vec2s", 8},   {"vec2d", 16}, {"vec3i", 12}, {"vec3s", 12},
                 {"vec3d", 24},  {"vec4i", 16},  {"vec4s", 16}, {"vec4d", 32}, {"mat4s", 64},
                 {"mat4d", 128}, {"ptidx32", 4}, {"ptidx64", 8}};
    for (size_t i = 0; i < NUM(sizes); i++) {
        if (strcmp(type, sizes[i].type) == 0) {
            return sizes[i].size;
        }
    }
    return 0;
}

static void walk_metadata(walk *w)
{
    char name[MAX_NAME], type[MAX_NAME];
    w->half = false;
    for (uint32_t count = take_u32(w); count > 0 && !w->fault; count--) {
        take_text(w, name);
        take_text(w, type);
        const uint32_t size = take_u32(w), right = metadata_size(type);
        const bool half = strcmp(name, "is_saved_as_half_float") == 0;
        if ((right && size != right) || (half && strcmp(type, "bool") != 0)) {
            fail(w, "is damaged: a size or type of metadata is wrong: ", name);
        }
        const uint8_t *value = take(w, size);
        if (value && half) {
            w->half = *value != 0;
        } else if (value && strcmp(type, "__delayedload") == 0) {
            check_delayed(w, value, size);
        }
    }
}

static void walk_transform(walk *w, bool nested)
{
    static const struct {
        const char *type;
        uint32_t size;
    } maps[] = {{"AffineMap", 128},
                {"UnitaryMap", 128},
                {"ScaleMap", 120},
                {"UniformScaleMap", 120},
                {"TranslationMap", 24},
                {"ScaleTranslateMap", 144},
                {"UniformScaleTranslateMap", 144}};
    char type[MAX_NAME];
    take_text(w, type);
    if (strcmp(type, "NonlinearFrustumMap") == 0 && !nested) {
        take(w, 64); // a box, taper, depth
        walk_transform(w, true);
        return;
    }
    for (size_t i = 0; i < NUM(maps); i++) {
        if (strcmp(type, maps[i].type) == 0) {
            take(w, maps[i].size);
            return;
        }
    }
    fail(w, "has a transform of an unknown kind: ", type);
}

// ---- trees ------------------------------------------------------------------------------------

// Whether a block becomes `bytes` of values. Without Blosc here it is the library that will say so.
static bool unpacks(walk *w, const uint8_t *block, uint64_t size, uint64_t bytes)
{
    if (!(w->compression & BLOSC)) {
        uLongf length = bytes;
        return uncompress(w->values, &length, block, size) == Z_OK && length == bytes;
    }
#ifdef TYN_HAVE_BLOSC
    return blosc_decompress_ctx(block, w->values, bytes, 1) == (int)bytes;
#else
    return true;
#endif
}

// readData: as they are, or behind the bytes that they take, negative if they are not compressed.
static void walk_data(walk *w, uint64_t bytes, bool unpack)
{
    if (!(w->compression & (ZIP | BLOSC))) {
        take(w, bytes);
        return;
    }
    const int64_t stored = take_i64(w);
    if (stored <= 0) {
        if (stored != -(int64_t)bytes) {
            fail(w, "is damaged: a block of values has another size than its node", "");
        }
        take(w, bytes);
        return;
    }
    const uint8_t *block = take(w, (uint64_t)stored);
    if (block && w->compression & BLOSC) {
        check_blosc(w, block, (uint64_t)stored, bytes);
    }
    if (unpack && !w->fault && !unpacks(w, block, (uint64_t)stored, bytes)) {
        fail(w, "is damaged: the values of a node cannot be unpacked", "");
    }
}

// readCompressedValues: of a node with `count` values, `active` of which are.
static void walk_values(walk *w, const value_type *t, uint32_t count, uint32_t active, bool inner)
{
    static const uint32_t inactive[] = {0, 0, 1, 0, 1, 2}; // values of their own, by the kind
    uint8_t kind = ALL_VALUES;
    if (w->version >= NODE_MASK) {
        const uint8_t *b = take(w, 1);
        kind = b ? *b : ALL_VALUES;
    }
    if (kind > ALL_VALUES) {
        fail(w, "is damaged: values of a node are stored in an unknown way", "");
        return;
    }
    if (kind < ALL_VALUES) {
        take(w, (uint64_t)inactive[kind] * t->size);
        take(w, kind >= 3 ? count / 8 : 0); // which of two
        if (w->compression & ACTIVE_MASK) {
            count = active;
        }
    }
    const uint32_t size = w->half ? t->half_size : t->size;
    if (count > 0 || size == t->size) { // of half floats not even the length of nothing is stored
        walk_data(w, (uint64_t)count * size, inner);
    }
}

static void walk_leaf(walk *w)
{
    const uint8_t *mask = take(w, LEAF_MASK);
    if (!mask) {
        return;
    }
    if (w->num_leaves == w->room) {
        const uint64_t room = w->room ? 2 * w->room : 1024;
        uint16_t *leaves = realloc(w->leaves, (size_t)room * sizeof *leaves);
        if (!leaves) {
            fail(w, "no memory to check it", "");
            return;
        }
        w->leaves = leaves;
        w->room = room;
    }
    w->leaves[w->num_leaves++] = (uint16_t)count_bits(mask, LEAF_MASK);
}

static void walk_node(walk *w, const value_type *t, uint32_t bits)
{
    const uint32_t count = 1u << bits, bytes = count / 8;
    const uint8_t *children = take(w, bytes), *active = take(w, bytes);
    if (!active) {
        return;
    }
    walk_values(w, t, w->version < NODE_MASK ? count - count_bits(children, bytes) : count,
                count_bits(active, bytes), true);
    for (uint32_t i = 0; i < count && !w->fault; i++) {
        if (!(children[i / 8] >> i % 8 & 1)) {
            continue;
        }
        if (bits == UPPER_BITS) {
            walk_node(w, t, LOWER_BITS);
        } else {
            walk_leaf(w);
        }
    }
}

static void walk_tree(walk *w, const value_type *t)
{
    w->num_leaves = 0;
    if (take_u32(w) != 1) {
        fail(w, "is damaged, or of a kind that is not read: its tree has not one buffer", "");
    }
    take(w, t->size); // background
    const uint32_t tiles = take_u32(w), children = take_u32(w);
    take(w, (uint64_t)tiles * (12 + t->size + 1)); // where, what, whether it is active
    for (uint32_t i = 0; i < children && !w->fault; i++) {
        take(w, 12);
        walk_node(w, t, UPPER_BITS);
    }
    for (uint64_t i = 0; i < w->num_leaves && !w->fault; i++) {
        take(w, LEAF_MASK);
        if (w->version < NODE_MASK) {
            const uint8_t *b = take(w, 13); // where it is, and how many buffers it has
            if (b && b[12] > 1) {
                fail(w, "has leaves of several buffers, which are not read", "");
            }
        }
        walk_values(w, t, 1u << LEAF_BITS, w->leaves[i], false);
    }
}

// ---- the file ---------------------------------------------------------------------------------

// The file's UUID: 32 hexadecimal digits and four dashes. OpenVDB reads it by characters and leaves out blanks: of other text
// it would take more than these 36 bytes, and all that follows would be read from the wrong place.
static void walk_uuid(walk *w)
{
    const uint8_t *b = take(w, 36);
    for (int i = 0; b && i < 36 && !w->fault; i++) {
        const bool dash = i == 8 || i == 13 || i == 18 || i == 23;
        if (dash ? b[i] != '-' : !isxdigit(b[i])) {
            fail(w, "is damaged: its UUID is not 32 hexadecimal digits and 4 dashes", "");
        }
    }
}

static void walk_header(walk *w, uint32_t newest, bool *has_offsets)
{
    static const uint8_t magic[8] = {0x20, 0x42, 0x44, 0x56};
    const uint8_t *b = take(w, 8);
    if (b && memcmp(b, magic, sizeof magic) != 0) {
        w->at = 0;
        fail(w, "is not an OpenVDB file", "");
    }
    w->version = take_u32(w);
    if (!w->fault && (w->version < OLDEST || w->version > newest)) {
        char versions[MAX_NAME];
        snprintf(versions, sizeof versions, "%u, must be %d to %u", w->version, OLDEST, newest);
        fail(w, "has the file format's version ", versions);
    }
    take(w, 8); // the library that wrote it
    b = take(w, 1);
    *has_offsets = b && *b;
    if (w->version < NODE_MASK) {
        b = take(w, 1);
        w->compression = b && *b ? ZIP : 0;
    }
    walk_uuid(w);
}

static const value_type *find_type(char *name)
{
    static const char suffix[] = "_HalfFloat";
    const size_t length = strlen(name), tail = sizeof suffix - 1;
    if (length > tail && strcmp(name + length - tail, suffix) == 0) {
        name[length - tail] = '\0';
    }
    for (size_t i = 0; i < NUM(value_types); i++) {
        if (strcmp(name, value_types[i].tree) == 0) {
            return &value_types[i];
        }
    }
    return NULL;
}

// A descriptor and its grid, up to the next descriptor.
static void walk_grid(walk *w, bool has_offsets)
{
    char name[MAX_NAME], type[MAX_NAME], parent[MAX_NAME];
    take_text(w, name);
    take_text(w, type);
    take_text(w, parent);
    const int64_t grid = take_i64(w);
    take_i64(w); // its buffers, which nobody looks for
    const int64_t end = take_i64(w);
    if (w->fault) {
        return;
    }
    if (has_offsets) {
        if (end < (int64_t)w->at || end > (int64_t)w->size) {
            fail(w, "is cut short or damaged: a grid ends beyond the file: ", name);
            return;
        }
        if (grid < 0 || grid > end) {
            fail(w, "is damaged: a grid begins behind its end: ", name);
            return;
        }
        w->at = (uint64_t)grid;
    }
    if (w->version >= NODE_MASK) {
        w->compression = take_u32(w);
    }
    walk_metadata(w);
    walk_transform(w, false);
    const value_type *t = find_type(type);
    if (!parent[0] && t) {
        walk_tree(w, t);
    } else if (!parent[0] && !t && !has_offsets) {
        fail(w, "has a grid that nothing says the end of, of a type that is not read: ", type);
    }
    if (has_offsets && !w->fault) {
        w->at = (uint64_t)end;
    }
}

bool tyn_vdb_check(const void *bytes, size_t size, uint32_t newest, const char *file,
                   const tyn_log *log)
{
    walk w = {.bytes = bytes, .size = size, .values = malloc(MOST_VALUES)};
    if (!w.values) {
        fail(&w, "no memory to check it", "");
    }
    bool has_offsets = false;
    walk_header(&w, newest, &has_offsets);
    walk_metadata(&w);
    const uint32_t count = take_u32(&w);
    if (!w.fault && count > size / SMALLEST_DESCRIPTOR) {
        fail(&w, "is damaged: it cannot hold so many grids", "");
    }
    for (uint32_t i = 0; i < count && !w.fault; i++) {
        walk_grid(&w, has_offsets);
    }
    free(w.leaves);
    free(w.values);
    if (w.fault) {
        for (char *c = w.detail; *c; c++) {
            *c = (unsigned char)*c < ' ' ? '?' : *c;
        }
        tyn_log_print(log, TYN_LOG_ERROR, "%s: %s%.100s (byte %llu of %zu)", file, w.fault,
                      w.detail, (unsigned long long)w.fault_at, size);
    }
    return !w.fault;
}
