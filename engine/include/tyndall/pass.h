// pass.h -- how a pass module is written. Tier 2.
//
// A pass is static data plus a few pure functions: which images and buffers it reads and writes
// (ports), its compute and raster kernels and what each of their bindings is (kernels), its parameters
// with units, ranges and defaults (params), the shapes of its outputs (declare), and its dispatches and
// draws (record). Descriptor layouts, pipelines, image usage, layouts and every barrier are derived.
// No pass writes a barrier, allocates, or sees a Vulkan object.
//
// Barriers: the recorder looks at what each dispatch or draw reads and writes and puts the needed
// barrier in front of it, inside a node and between nodes alike. Two dispatches that touch the same
// resource, one of them writing, are ordered; so put independent work in one dispatch (of draws: in the
// tiles of one draw).
#pragma once
#include "base.h"
#include <vulkan/vulkan_core.h> // types only

#ifdef __cplusplus
extern "C" {
#endif

enum {
    TYN_MAX_PORTS = 56,
    TYN_MAX_BINDINGS = 48,
    TYN_MAX_SPEC = 8,
    TYN_MAX_ARGS = 128,
    TYN_MAX_ATTACHMENTS = 5, // four colours and a depth: what every device can draw to at once
};

// ---- shapes ---------------------------------------------------------------------------------

typedef enum tyn_dim { TYN_BUFFER = 0, TYN_IMAGE_2D, TYN_IMAGE_3D } tyn_dim;

typedef struct tyn_extent {
    uint32_t x, y, z; // texels; a 2D image has z = 1; a buffer has x = size in bytes
} tyn_extent;

// ---- ports ----------------------------------------------------------------------------------

typedef enum tyn_port_dir {
    TYN_IN = 0,  // read; comes from an earlier node or from outside
    TYN_OUT,     // written; made by this node
    TYN_INOUT,   // read and changed; goes in as one version and comes out as the next
    TYN_SCRATCH, // private to this node, contents undefined at its start
} tyn_port_dir;

typedef struct tyn_port {
    // "density", "radiance": for dumps, messages and tests, never looked up in a frame.
    const char *name;
    tyn_port_dir dir;
    tyn_dim dim;
    VkFormat format; // of images this pass makes (OUT, SCRATCH) or stores to; 0 for buffers and for
                     // images that are only sampled (any float format)
    bool optional;   // IN only: when nothing is connected a 1x1(x1) zero image or a zeroed
                     // 256-byte buffer is bound
    const char *meaning; // "extinction at cell centres, 1/m": printed by the dumps
} tyn_port;

// ---- kernels --------------------------------------------------------------------------------

typedef enum tyn_use {
    TYN_USE_SAMPLED = 1,   // combined image sampler, linear, clamp to edge (texelFetch works too)
    TYN_USE_STORAGE_READ,  // readonly image or buffer
    TYN_USE_STORAGE_WRITE, // writeonly image or buffer
    TYN_USE_STORAGE_RW,    // read and written in one dispatch (atomics, in-place)
    TYN_USE_UNIFORM,       // uniform buffer (std140 or scalar block layout)
    TYN_USE_COLOR,         // drawn to: only in tyn_raster.attachments
    TYN_USE_DEPTH,         // tested against and drawn to: only there
    // Buffers read as texels, by texelFetch(b, i): samplerBuffer of floats (in .x), of vec4, usamplerBuffer of uints,
    // of uvec4. Where every thread reads another place a CPU device is several times faster at it than at storage
    // buffers.
    TYN_USE_TEXELS_FLOAT,
    TYN_USE_TEXELS_VEC4,
    TYN_USE_TEXELS_UINT,
    TYN_USE_TEXELS_UVEC4,
} tyn_use;

// Binding b of set 0 is element b of this table.
typedef struct tyn_binding {
    uint8_t port; // index into ports; a dispatch may point it at another port of equal kind
    tyn_use use;
    bool repeat; // SAMPLED: wrap instead of clamp (latitude-longitude maps: x wraps, y clamps)
} tyn_binding;

// What makes a kernel draw triangles. Vertices come from storage buffers by gl_VertexIndex; there is no
// vertex input. Front faces run counter-clockwise as they are seen on the screen.
typedef struct tyn_raster {
    const uint32_t *fragment; // SPIR-V of the fragment shader; NULL: depth alone is drawn
    size_t fragment_size;     // bytes
    // COLOR (location 0, 1, ... in this order) and at most one DEPTH, of 2D ports that have the
    // format of the table.
    const tyn_binding *attachments;
    uint32_t num_attachments;
    VkCompareOp depth; // new depth `op` old one = drawn; with a DEPTH attachment only
    float clear_depth; // what a draw that does not keep starts from (colours: 0)
    VkCullModeFlags cull;
} tyn_raster;

typedef struct tyn_kernel {
    const char *name;
    // Embedded at build time (see passes/meson.build); raster: the vertex shader.
    const uint32_t *spirv;
    size_t spirv_size;  // bytes
    uint32_t args_size; // push constants, bytes, <= 128
    uint32_t local_size[3];
    const tyn_binding *bindings;
    uint32_t num_bindings;
    uint32_t num_spec; // specialisation constants 0..n-1, 32 bits each, given per dispatch
    // NULL: a compute kernel. Else both shaders see all bindings (none of them written), constants
    // and args; local_size is 0.
    const tyn_raster *raster;
} tyn_kernel;
#define TYN_COUNT(table) (sizeof(table) / sizeof((table)[0]))
// A compute kernel from the header that the build makes of its shader (tools/kernel.py): words, bindings, size of
// the push constants, workgroup and number of specialisation constants, all read from its SPIR-V.
#define TYN_KERNEL(code)                                                                           \
    {                                                                                              \
        .name = #code, .spirv = code##_spirv, .spirv_size = sizeof code##_spirv,                   \
        .args_size = code##_args_size, .local_size = {code##_x, code##_y, code##_z},               \
        .bindings = code##_bindings, .num_bindings = TYN_COUNT(code##_bindings),                   \
        .num_spec = code##_num_spec                                                                \
    }
// One that draws with the vertex shader `code`, which has the tables of the shader `all`: that of its two shaders
// which declares every binding of both.
#define TYN_DRAW(title, code, all, state)                                                          \
    {                                                                                              \
        .name = title, .spirv = code##_spirv, .spirv_size = sizeof code##_spirv,                   \
        .args_size = all##_args_size, .bindings = all##_bindings,                                  \
        .num_bindings = TYN_COUNT(all##_bindings), .num_spec = all##_num_spec, .raster = state     \
    }

// ---- lists of ports -------------------------------------------------------------------------

// In C, not C++: the ports of a pass are a list of X(PREFIX, PORT, name, direction, dim, meaning...), from which come its
// enum and its table:
//   #define TONEMAP_PORTS(X) X(TONEMAP, RADIANCE, radiance, IN, IMAGE_2D, "W/(m^2 sr)"), X(...)
//   TYN_PASS(TONEMAP, tonemap);                                              TONEMAP_PORT_RADIANCE, ..., tyn_pass_tonemap
//   static const tyn_port ports[] = {TONEMAP_PORTS(TYN_PORT_ROW)};
// direction: IN, OPTIONAL (IN that need not be connected), OUT, INOUT, SCRATCH. dim: BUFFER, IMAGE_2D, IMAGE_3D, and images of
// four floats, RGBA_2D and RGBA_3D. Behind the meaning further fields of tyn_port may stand: .format = VK_FORMAT_R32_SFLOAT.
//
// A bundle is a list of ports that go together from the passes that make them to those that read them,
// TYN_BEAMS(X, PREFIX); it is an element of lists, with X##_OPTIONAL where all of it may be absent and X##_OUT where it is
// made. A struct of refs is
//   struct { tyn_ref TYN_BEAMS(TYN_PORT_NAME, ); }.
#define TYN_PASS(P, name)                                                                          \
    enum { P##_PORTS(TYN_PORT_ENUM), P##_NUM_PORTS };                                              \
    extern const tyn_pass_desc tyn_pass_##name
#define TYN_RGBA_2D TYN_IMAGE_2D, .format = VK_FORMAT_R32G32B32A32_SFLOAT
#define TYN_RGBA_3D TYN_IMAGE_3D, .format = VK_FORMAT_R32G32B32A32_SFLOAT
#define TYN_PORT_ENUM(P, PORT, ...) P##_PORT_##PORT
#define TYN_PORT_ENUM_OPTIONAL(P, PORT, ...) P##_PORT_##PORT
#define TYN_PORT_ENUM_OUT(P, PORT, ...) P##_PORT_##PORT
#define TYN_PORT_NAME(P, PORT, name, ...) name
#define TYN_PORT_ROW(P, PORT, port_name, direction, size, ...)                                     \
    [P##_PORT_##PORT] = {                                                                          \
        .name = #port_name, TYN_PORT_##direction, .dim = TYN_##size, .meaning = __VA_ARGS__}
#define TYN_PORT_ROW_OPTIONAL(P, PORT, port_name, direction, size, ...)                            \
    TYN_PORT_ROW(P, PORT, port_name, OPTIONAL, size, __VA_ARGS__)
#define TYN_PORT_ROW_OUT(P, PORT, port_name, direction, size, ...)                                 \
    TYN_PORT_ROW(P, PORT, port_name, OUT, size, __VA_ARGS__)
#define TYN_PORT_IN .dir = TYN_IN
#define TYN_PORT_OPTIONAL .dir = TYN_IN, .optional = true
#define TYN_PORT_OUT .dir = TYN_OUT
#define TYN_PORT_INOUT .dir = TYN_INOUT
#define TYN_PORT_SCRATCH .dir = TYN_SCRATCH

// ---- parameters -----------------------------------------------------------------------------

typedef enum tyn_param_type {
    TYN_PARAM_FLOAT = 0,
    TYN_PARAM_INT,
    TYN_PARAM_BOOL,
    TYN_PARAM_ENUM
} tyn_param_type;

// One user-visible field of the params struct: float, int32_t (INT, ENUM) or uint32_t 0/1 (BOOL).
typedef struct tyn_param {
    const char *name; // `-D pass.name=value`
    tyn_param_type type;
    size_t offset;
    double def, min, max;     // default and inclusive range; for ENUM min = 0, max = count - 1
    const char *unit;         // "1/m", "cells", "" for none
    const char *doc;          // one line
    const char *const *names; // ENUM: the values' names
    double least; // numbers: `min` has a meaning of its own, others are at least this; 0: none
} tyn_param;

// ---- counters -------------------------------------------------------------------------------

// What a pass's kernels count for the report (tyn_node_report.work), in a buffer that they write; rows end with one
// without a name.
typedef struct tyn_counter {
    const char *name; // "steps", "unsettled"
    size_t offset;    // bytes into the buffer
    bool real;        // a float; else a uint32
    // A struct light_clamp (shaders/common/light_sum.h): what it hid, as a share of what it let through.
    bool clamp;
    uint32_t count;   // numbers that follow each other, of which the largest is told; 0 counts as 1
    const char *unit; // "of the scattered light"; NULL: a number of them
    double limit;     // a share beyond which the report warns
    const char *warning; // printf format of the share in percent, a double; NULL: none
} tyn_counter;

// ---- the pass -------------------------------------------------------------------------------

typedef struct tyn_builder tyn_builder;   // answers and collects shapes while a node is declared
typedef struct tyn_recorder tyn_recorder; // collects the dispatches of a node

// Of a pass whose results may be old: the node keeps what it has made, whatever else changes, until `key` changes or its
// inputs or params have changed in `frames` frames since.
typedef struct tyn_hold {
    uint64_t key;    // not 0
    uint32_t frames; // 0 and 1: it is run whenever something has changed
    uint32_t pad;
} tyn_hold;

typedef struct tyn_pass_desc {
    const char *name, *summary;
    const tyn_port *ports;
    uint32_t num_ports;
    const tyn_kernel *kernels;
    uint32_t num_kernels;
    // User-visible; the struct may hold further fields that the method sets.
    const tyn_param *params;
    uint32_t num_params;
    // The struct must have no uninitialised padding: start from tyn_pass_defaults.
    size_t params_size;
    // Params and inputs depend on the media alone, or on what changes as seldom (which kinds of
    // light there are; no light's strength or direction, no camera): with media-only inputs the
    // node is part of the set-up and not of a frame's cost.
    bool media_only;
    bool
        of_pixels; // its work grows with the picture's pixels and with nothing else: stored times scale it with them
    // Gives every OUT and SCRATCH port its extent (tyn_build_*). Depends only on params and on the
    // extents of the inputs. An OUT port that is given none does not exist in this configuration.
    tyn_result (*declare)(tyn_builder *b, const void *params);
    // Dispatches only. Must use the same kernels, bindings and specialisations whenever the shapes
    // and the params marked by `declare` are the same.
    void (*record)(tyn_recorder *r, const void *params);
    // The debug view: the OUT port whose middle slice `tyndall graph --view` shows, and a word on it.
    uint8_t debug_port;
    const char *debug_meaning;
    // What there must be for a method to declare the node, as `tyndall graph` says of those it left out.
    const char *serves;
    const tyn_counter *counters; // NULL: it counts nothing
    // The OUT port of the buffer in which it counts. With a size in bytes the engine makes the buffer and fills it with zeros
    // before `record`; else the pass does. Of several nodes of a frame the first one's is read.
    uint8_t counter_port;
    uint32_t counter_bytes;
    // Of a pass that renews a history piece by piece: offset into params of a uint32_t, in how many more frames the node
    // runs after the last change of its params or inputs. It does not where the history has just been started from zeros,
    // of which the pass makes all pieces at once. 0: it is not such a pass.
    size_t settles;
    size_t holds; // offset into params of a tyn_hold; 0: its results are never old
} tyn_pass_desc;

// Of a pass whose tables and functions are called ports, kernels, declare and record. More ports than there may be do not compile.
#define TYN_PASS_TABLES(params_type)                                                               \
    .ports = ports,                                                                                \
    .num_ports = TYN_COUNT(ports) + 0 * sizeof(char[TYN_COUNT(ports) <= TYN_MAX_PORTS ? 1 : -1]),  \
    .kernels = kernels, .num_kernels = TYN_COUNT(kernels), .params_size = sizeof(params_type),     \
    .declare = declare, .record = record

#define TYN_SETTINGS(table) .params = table, .num_params = TYN_COUNT(table)
// TYN_COUNTS(PATH_PORT_COUNTERS, struct counters_block, rows...): in a buffer of this struct alone.
#define TYN_COUNTS(port, block, ...)                                                               \
    .counters = (const tyn_counter[]){__VA_ARGS__, {NULL}}, .counter_port = port,                  \
    .counter_bytes = sizeof(block)

// Fills params with zeros, then the defaults of the table.
TYN_API void tyn_pass_defaults(const tyn_pass_desc *pass, void *params);

// ---- declare --------------------------------------------------------------------------------

TYN_API bool tyn_build_has(const tyn_builder *b, uint8_t port); // is the input connected?
// Of an input, or one set before.
TYN_API tyn_extent tyn_build_extent(const tyn_builder *b, uint8_t port);
TYN_API void tyn_build_image(tyn_builder *b, uint8_t port, tyn_extent extent, uint32_t mips);
TYN_API void tyn_build_buffer(tyn_builder *b, uint8_t port, uint64_t bytes);
// Overrides the port's format for this node (a pass with half and float variants whose kernels
// differ by binding tables).
TYN_API void tyn_build_format(tyn_builder *b, uint8_t port, VkFormat format);
// An OUT whose content is kept between frames even if the node is not run (all OUTs are, today).
TYN_API const tyn_log *tyn_build_log(const tyn_builder *b);

// ---- record ---------------------------------------------------------------------------------

TYN_API bool tyn_rec_has(const tyn_recorder *r, uint8_t port);
TYN_API tyn_extent tyn_rec_extent(const tyn_recorder *r, uint8_t port);

// One dispatch: enough workgroups of the kernel's local size to cover `cells` threads.
typedef struct tyn_dispatch {
    uint32_t kernel;      // index into kernels
    tyn_extent cells;     // threads; a component 0 counts as 1
    const void *args;     // args_size bytes of push constants, NULL if args_size is 0
    const uint8_t *ports; // NULL = the table's; else num_bindings port indices (ping-pong)
    const uint8_t *mips;  // NULL = 0; else num_bindings mip levels (storage uses; sampled see all)
    const uint32_t *spec; // num_spec values, NULL = zeros
    const char *label;    // for captures and dumps; NULL = the kernel's name
} tyn_dispatch;
TYN_API void tyn_rec_dispatch(tyn_recorder *r, const tyn_dispatch *d);
// TYN_DISPATCH(r, .kernel = SUM, .cells = {n, 1, 1}, .args = &args)
#define TYN_DISPATCH(r, ...) tyn_rec_dispatch(r, &(tyn_dispatch){__VA_ARGS__})
// For tyn_dispatch.ports: into `out` the ports of the kernel's table, pairs[i][0] replaced by pairs[i][1]. `out` is
// returned.
TYN_API const uint8_t *tyn_ports_exchanged(const tyn_kernel *kernel, const uint8_t (*pairs)[2],
                                           uint32_t num_pairs, uint8_t out[TYN_MAX_BINDINGS]);
// Workgroup counts from `offset` bytes into a buffer port (3 x uint32).
TYN_API void tyn_rec_dispatch_indirect(tyn_recorder *r, const tyn_dispatch *d, uint8_t port,
                                       uint64_t offset);
// A part of the attachments with push constants of its own.
typedef struct tyn_tile {
    uint32_t x, y, width, height; // texels: viewport and scissor
    const void *args;
    uint32_t first, vertices; // of the draw's: from which on, and how many; 0, 0: all of them
} tyn_tile;

// The largest index that all devices draw by (Vulkan: maxDrawIndexedIndexValue without fullDrawIndexUint32).
#define TYN_MOST_INDEX 16777215u

// One draw into each tile; all tiles in one go, in order, without barriers between them. The attachments
// must be of one size. The queue must do graphics: recording fails where it cannot.
typedef struct tyn_draw {
    uint32_t kernel;       // index into kernels, one with `raster`
    uint32_t vertices;     // of every tile; 0: attachments are cleared and nothing is drawn
    const tyn_tile *tiles; // NULL = one that covers the attachments, with `args`
    uint32_t num_tiles;
    const void *args;
    bool keep;            // draw over what is there; else all of the attachments is cleared first
    bool keep_depth;      // ... but for the depth, which an earlier draw has laid down
    bool indexed;         // vertices are elements of the port `indices`, a buffer of uint32_t up
    uint8_t indices;      // to TYN_MOST_INDEX: corners that triangles share are computed once
    const uint8_t *ports; // NULL = the table's; else num_bindings port indices
    const uint32_t *spec; // num_spec values, NULL = zeros
    const char *label;
} tyn_draw;
TYN_API void tyn_rec_draw(tyn_recorder *r, const tyn_draw *d);
// Inline data, <= 65536 bytes, multiple of 4, into a buffer port.
TYN_API void tyn_rec_update(tyn_recorder *r, uint8_t port, uint64_t offset, const void *data,
                            size_t size);
// `record` is called several times a frame, and mostly to see what it would do. False then: the data of
// tyn_rec_update and the amounts of tyn_rec_work are not looked at, so what is costly may be left out.
TYN_API bool tyn_rec_live(const tyn_recorder *r);
TYN_API void tyn_rec_fill(tyn_recorder *r, uint8_t port, uint32_t value); // whole buffer
TYN_API void tyn_rec_clear(tyn_recorder *r, uint8_t port);                // image (mip 0..) to zero
TYN_API void tyn_rec_copy_buffer(tyn_recorder *r, uint8_t src, uint8_t dst, uint64_t bytes);
// Work done, for the stats: "steps", "cells", "flops", "bytes" are known names.
TYN_API void tyn_rec_work(tyn_recorder *r, const char *name, double amount);

#ifdef __cplusplus
}
#endif
