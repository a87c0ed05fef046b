// graph.h -- the render graph: declare, compile, record, dump.
//
// A method declares nodes anew for every frame; that is cheap. `tyn_graph_compile` allocates what the
// declared nodes need; `tyn_graph_record` records the dispatches of the nodes that an output needs
// and whose inputs or params changed. If a later frame declares other nodes or shapes than were
// compiled, recording refuses and compile must be called again.
//
// Thread-safety: Unsafe.
#pragma once
#include <tyndall/pass.h>
#include <tyndall/device.h>

typedef struct tyn_graph tyn_graph;

// A version of a resource. {0} = nothing. Reading a handle that a later node has overwritten is an
// error when declaring.
typedef struct tyn_ref {
    uint32_t resource; // 1-based
    uint32_t version;
} tyn_ref;

tyn_result tyn_graph_create(tyn_device *dev, uint32_t frames_in_flight, tyn_graph **out);
void tyn_graph_destroy(tyn_graph **graph);

// ---- declare --------------------------------------------------------------------------------

// Starts a new declaration; the compiled state is kept until the next compile.
void tyn_graph_begin(tyn_graph *g);

// A host image, with the state it is in and the state it must be left in. `version` 0 = its content
// may have changed; else it identifies the content.
tyn_ref tyn_graph_import_image(tyn_graph *g, const char *name, tyn_dim dim, const tyn_image *image,
                               uint64_t version);

// Data that the host side fills: recorded as a copy when `hash` differs from the last one. The data
// is read during compile (big uploads, staged) or record (<= 64 KiB, inline).
tyn_ref tyn_graph_upload_buffer(tyn_graph *g, const char *name, const void *data, size_t size,
                                uint64_t hash);
typedef void (*tyn_fill_fn)(void *user, void *staging); // writes all texels, tightly packed
tyn_ref tyn_graph_upload_image(tyn_graph *g, const char *name, tyn_dim dim, VkFormat format,
                               tyn_extent extent, tyn_fill_fn fill, void *user, uint64_t hash);

// Adds a node. `refs` has pass->num_ports elements: IN and INOUT are filled by the caller ({0} for an
// absent optional one), OUT and INOUT are set to their new versions (OUT that does not exist: {0}).
// `params` is copied.
tyn_result tyn_graph_add(tyn_graph *g, const tyn_pass_desc *pass, const void *params,
                         tyn_ref *refs);

// What went wrong first since tyn_graph_begin, TYN_OK if nothing did. Nodes that are added after that are left out, so
// that it is enough to ask once.
tyn_result tyn_graph_status(const tyn_graph *g);
// Makes it so, for a fault that the log has said.
void tyn_graph_refuse(tyn_graph *g, tyn_result why);

// A persistent image or buffer that starts as zeros and lives across frames: the INOUT of
// accumulating passes. `key` changes = start from zeros again; so does another shape. Compiling
// anew because other nodes or shapes were declared leaves it as it is.
tyn_ref tyn_graph_history_image(tyn_graph *g, const char *name, tyn_dim dim, VkFormat format,
                                tyn_extent extent, uint64_t key);
tyn_ref tyn_graph_history_buffer(tyn_graph *g, const char *name, uint64_t bytes, uint64_t key);

// What is wanted: keeps `ref` and what it needs alive. With `readback` its content is copied to host
// memory when it changes (tyn_graph_map).
void tyn_graph_output(tyn_graph *g, const char *name, tyn_ref ref, bool readback);

// The resource depends on the media alone; nodes that read nothing else are not part of a frame's
// cost and are spared by tyn_graph_recompute.
void tyn_graph_mark_media(tyn_graph *g, tyn_ref ref);

// This frame runs every node that depends on more than the media, changed or not (for timing).
void tyn_graph_recompute(tyn_graph *g);

// This frame records only uploads and nodes that depend on the media alone.
void tyn_graph_setup_only(tyn_graph *g);

// Has what a node of this pass makes, the image at its debug port, read back as the output "inspect";
// of several such nodes the last. Counts until the next tyn_graph_begin.
void tyn_graph_inspect(tyn_graph *g, const char *pass);

VkFormat tyn_graph_format(const tyn_graph *g, tyn_ref ref);

// The longest side that a 2D image may have into which a node draws.
uint32_t tyn_graph_drawn_side(const tyn_graph *g);

// ---- compile, record ------------------------------------------------------------------------

// True if the current declaration has the nodes and shapes of the compiled one.
bool tyn_graph_matches(const tyn_graph *g);

// Culls, allocates, makes pipelines. The GPU must be done with earlier records. May block.
tyn_result tyn_graph_compile(tyn_graph *g);

// Frees host memory of uploads that are done. The GPU must be done with earlier records.
void tyn_graph_trim(tyn_graph *g);

// Appends this frame's work. Never submits, waits or allocates memory.
tyn_result tyn_graph_record(tyn_graph *g, VkCommandBuffer cmd);

// After the GPU finished the last record: host pointer to an output with readback, its extent and
// bytes per texel (buffers: 1). NULL if there is no such output.
const void *tyn_graph_map(tyn_graph *g, const char *name, tyn_extent *extent, VkFormat *format);

// ---- what happened --------------------------------------------------------------------------

typedef enum tyn_node_state {
    TYN_NODE_RAN = 0,
    TYN_NODE_UNCHANGED,
    TYN_NODE_CULLED,
    TYN_NODE_EMPTY,
} tyn_node_state;

enum { TYN_MAX_WORK = 6 };
typedef struct tyn_node_stats {
    const char *name;
    tyn_node_state state;
    double gpu_ms; // of the last finished record that ran it; 0 where timestamps are missing
    double cpu_ms; // recording
    uint32_t dispatches, barriers;
    bool media_only; // depends on the media alone
    uint64_t bytes;  // memory of the node's OUT and SCRATCH resources
    struct {
        const char *name;
        double amount;
    } work[TYN_MAX_WORK];
    uint32_t num_work;
} tyn_node_stats;
// Collects the timestamps of the last finished record; call after its fence.
uint32_t tyn_graph_stats(tyn_graph *g, const tyn_node_stats **stats);
void tyn_graph_memory(const tyn_graph *g, uint64_t *persistent, uint64_t *transient);

// Text or Graphviz of the compiled graph: nodes, resources, lifetimes, barriers, what is culled and
// why. `passes`: those that could have been declared, to the first NULL, to tell which were left out and what they
// are for; may be NULL. The caller frees the string.
char *tyn_graph_dump(tyn_graph *g, bool dot, const tyn_pass_desc *const *passes);
