// graph.h -- the render graph: declare, compile, record, dump.
//
// A method declares nodes anew for every frame; that is cheap. `tyn_graph_compile` allocates what the
// declared nodes need; `tyn_graph_record` records the dispatches of the nodes that an output needs
// and whose inputs or params changed. If a later frame declares other nodes or shapes than were
// compiled, recording refuses (or yields) and compile must be called again.
//
// Thread-safety: Unsafe.
#pragma once
#include <tyndall/extend/graph.h>

tyn_result tyn_graph_create(tyn_device *dev, uint32_t frames_in_flight, tyn_graph **out);
void tyn_graph_destroy(tyn_graph **graph);

// Bytes of device memory that the graph may have at any time, with staging, what is read back, and what is replaced but may be
// in use by frames under way; 0 = no limit. tyn_graph_compile gives TYN_ERR_MEMORY, with one line, where it would have more, and
// leaves what was compiled before as it is.
void tyn_graph_budget(tyn_graph *g, uint64_t bytes);

// ---- declare (beside what methods call: tyndall/extend/graph.h) -------------------------------

// Writes a value where a pass has a parameter.
void graph_store_param(const tyn_param *p, void *params, double value);

// Starts a new declaration; the compiled state is kept until the next compile.
void tyn_graph_begin(tyn_graph *g);

// A host image, with the state it is in and the state it must be left in. `version` 0 = its content
// may have changed; else it identifies the content.
tyn_ref tyn_graph_import_image(tyn_graph *g, const char *name, tyn_dim dim, const tyn_image *image,
                               uint64_t version);

// How a declaration is compiled and recorded: nothing of this until it is set, after tyn_graph_begin.
typedef struct tyn_record_mode {
    bool
        recompute; // every node that depends on more than the media runs, changed or not (for timing)
    bool setup_only; // only uploads and nodes that depend on the media alone
    // What passes count is read back, as outputs named as the passes: by the next nodes that are added. Else it keeps nothing alive.
    bool counters;
    // What a node of this pass makes, the image at its debug port, is read back as the output "inspect"; of several such nodes
    // the last. NULL: none.
    const char *inspect;
    // Pipelines are compiled beside tyn_graph_compile and tyn_graph_record, which return TYN_PENDING until they are there:
    // compile keeps what was compiled before, and record only takes host images to their `after`.
    bool background;
    bool yields; // a record of what was not compiled does likewise, instead of refusing
    bool
        idle; // the GPU is done with all earlier records: what is replaced is destroyed before others are allocated
} tyn_record_mode;
tyn_record_mode *tyn_graph_mode(tyn_graph *g);

// What was recorded was not executed: all is made anew. The GPU must be done with earlier records.
void tyn_graph_forget(tyn_graph *g);

// ---- compile, record ------------------------------------------------------------------------

// True if the current declaration has the nodes and shapes of the compiled one.
bool tyn_graph_matches(const tyn_graph *g);

// Culls, allocates, makes pipelines. May block. Records before may still be under way: what they use and what is replaced goes once
// the record i + frames_in_flight says that record i is over. What has the name, shape and uses that something had in the
// compilation before keeps its Vulkan object and what is in it, so that unchanged uploads and nodes are not repeated; all
// is made anew when that would take more than 1.5 times the memory and 32 MiB.
tyn_result tyn_graph_compile(tyn_graph *g);

// Pipelines that are still to be compiled before tyn_graph_compile can return something else than TYN_PENDING.
uint32_t tyn_graph_pending(const tyn_graph *g);

// Frees host memory of uploads that are done, and what was replaced and is over.
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
    bool media_only;       // depends on the media alone
    bool aid;              // tyn_graph_aid
    uint64_t bytes;        // memory of the node's OUT and SCRATCH resources
    uint64_t shared_bytes; // of these: where those of other nodes that are needed lie, too
    struct {
        const char *name;
        double amount;
    } work[TYN_MAX_WORK];
    uint32_t num_work;
} tyn_node_stats;
// All aspects of a format: colour, depth, stencil.
VkImageAspectFlags graph_aspect(VkFormat format);
// Collects the timestamps of the last finished record; call after its fence.
uint32_t tyn_graph_stats(tyn_graph *g, const tyn_node_stats **stats);
// Records so far.
uint64_t tyn_graph_records(const tyn_graph *g);
// The newest record that is over, by number from 1 on: the host comes to record i + frames_in_flight once the GPU has finished
// record i. `ms`: its nodes' time, without those of the media alone and aids. 0: there is none, or it has no time.
uint64_t tyn_graph_finished(tyn_graph *g, double *ms);
void tyn_graph_memory(const tyn_graph *g, uint64_t *persistent, uint64_t *transient);

// Text or Graphviz of the compiled graph: nodes, resources, lifetimes, barriers, what is culled and
// why. `passes`: those that could have been declared, to the first NULL, to tell which were left out and what they
// are for; may be NULL. The caller frees the string; NULL: not compiled, or no memory.
char *tyn_graph_dump(tyn_graph *g, bool dot, const tyn_pass_desc *const *passes);
