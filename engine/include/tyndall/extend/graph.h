// graph.h -- what a method calls to declare the nodes of a frame. Tier 4.
//
// A frame is declared anew each time, which is cheap: resources come from the job (job.h) or from the calls below, nodes are
// added in the order in which they run, and what no output needs is left out. A node that reads what it read in the last
// frame, with the same params, is not run again. Allocation, layouts, barriers and recording are the engine's.
//
// Thread-safety: Unsafe. A tyn_graph is lent to a method for the time of its `declare`.
#pragma once
#include "../device.h"
#include "../pass.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct tyn_graph tyn_graph;

// A version of a resource. {0} = nothing. Reading a handle that a later node has overwritten is an
// error when declaring.
typedef struct tyn_ref {
    uint32_t resource; // 1-based
    uint32_t version;
} tyn_ref;

// Data that the host side fills: recorded as a copy when `hash` differs from the last one. The data
// is read during compile (big uploads, staged) or record (<= 64 KiB, inline).
TYN_API tyn_ref tyn_graph_upload_buffer(tyn_graph *g, const char *name, const void *data,
                                        size_t size, uint64_t hash);
typedef void (*tyn_fill_fn)(void *user, void *staging); // writes all texels, tightly packed
TYN_API tyn_ref tyn_graph_upload_image(tyn_graph *g, const char *name, tyn_dim dim, VkFormat format,
                                       tyn_extent extent, tyn_fill_fn fill, void *user,
                                       uint64_t hash);

// Adds a node. `refs` has pass->num_ports elements: IN and INOUT are filled by the caller ({0} for an
// absent optional one), OUT and INOUT are set to their new versions (OUT that does not exist: {0}).
// `params` is copied. An earlier node with the same pass, params and inputs is reused, unless the pass has INOUT ports, settles or
// holds: its outputs are then not to be changed in place while another holder reads them.
TYN_API tyn_result tyn_graph_add(tyn_graph *g, const tyn_pass_desc *pass, const void *params,
                                 tyn_ref *refs);

// What went wrong first in this declaration, TYN_OK if nothing did. Nodes that are added after that are left out, so
// that it is enough to ask once.
TYN_API tyn_result tyn_graph_status(const tyn_graph *g);
// Makes it so, for a fault that the log has said.
TYN_API void tyn_graph_refuse(tyn_graph *g, tyn_result why);

// A persistent image or buffer that starts as zeros and lives across frames: the INOUT of
// accumulating passes. `key` changes = start from zeros again; so does another shape. Compiling
// anew because other nodes or shapes were declared leaves it as it is.
TYN_API tyn_ref tyn_graph_history_image(tyn_graph *g, const char *name, tyn_dim dim,
                                        VkFormat format, tyn_extent extent, uint64_t key);
TYN_API tyn_ref tyn_graph_history_buffer(tyn_graph *g, const char *name, uint64_t bytes,
                                         uint64_t key);

// What is wanted: keeps `ref` and what it needs alive. With `readback` its content is copied to host
// memory when it changes. Methods call tyn_job_output (job.h).
TYN_API void tyn_graph_output(tyn_graph *g, const char *name, tyn_ref ref, bool readback);

// The resource depends on the media alone; nodes that read nothing else are not part of a frame's
// cost.
TYN_API void tyn_graph_mark_media(tyn_graph *g, tyn_ref ref);

// Nodes added from here on help others and are not seen (`on`), until it is said again: what they count is in no report and no
// warning.
TYN_API void tyn_graph_aid(tyn_graph *g, bool on);

TYN_API VkFormat tyn_graph_format(const tyn_graph *g, tyn_ref ref);

// The longest side that a 2D image may have into which a node draws.
TYN_API uint32_t tyn_graph_drawn_side(const tyn_graph *g);

#ifdef __cplusplus
}
#endif
