// internal.h -- the inside of the render graph, shared by the files of this folder.
//
// A declaration is two lists, resources and nodes, rebuilt for every frame. What was compiled is kept
// beside it, index by index: `phys` belongs to `resources`, `runs` to `nodes`. Both agree as long as
// the structure hash of the declaration equals the one that was compiled.
#pragma once
#include "graph/graph.h"
#include "graph/plan.h"
#include "gpu/compiler.h"
#include "gpu/memory.h"

enum { MAX_VERSIONS = 8, MAX_MIPS = 14, MAX_SLOTS = 8, INLINE_UPLOAD = 65536 };
enum { NUM_TEXEL_FORMATS = 4, NUM_DESCRIPTORS = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER + 1 };
// The first resources of every declaration, by tyn_dim: histories that nobody writes, bound where an optional input is
// absent. ZERO_WORDS has two words a texel, for what is stored packed.
enum { ZERO_BYTES = 256, ZERO_WORDS = TYN_IMAGE_3D + 1, NUM_ZEROS };

typedef enum resource_kind {
    RESOURCE_OUT = 0, // made by a node, kept between frames
    RESOURCE_SCRATCH, // private to a node
    RESOURCE_IMPORT,  // the host's
    RESOURCE_UPLOAD,  // filled from host memory
    RESOURCE_HISTORY, // lives across frames, starts as zeros
} resource_kind;

typedef struct resource {
    const char *name;
    const char *owner; // pass that made it, or ""
    resource_kind kind;
    tyn_dim dim;
    VkFormat format;
    tyn_extent extent; // buffers: x = bytes
    uint32_t mips;
    uint32_t version;               // newest
    uint32_t writers[MAX_VERSIONS]; // node index + 1 that wrote the version; 0 = from outside
    uint64_t content;               // identifies the newest version's content
    uint64_t key;                   // HISTORY: other key = start from zeros; UPLOAD: content hash
    bool media_only;                // depends on nothing but the media: not part of a frame's cost
    // UPLOAD: one of them
    const void *data;
    tyn_fill_fn fill;
    void *user;
    tyn_image image; // IMPORT
} resource;

typedef struct node {
    const tyn_pass_desc *pass;
    void *params; // in the arena of params
    size_t params_offset;
    uint32_t res[TYN_MAX_PORTS];      // resource index + 1; 0 = none
    uint32_t versions[TYN_MAX_PORTS]; // IN, INOUT: version read
    uint64_t hash;
    uint64_t asked;   // of pass, params and inputs; `hash` is the same but for passes that settle
    uint32_t settled; // of these: frames with nothing new, at most as many as it takes
    uint64_t hold;    // key of a pass whose results may be old
    uint32_t held;    // ... frames with something new, in which it was not run
    bool media_only, needed;
    bool aid; // tyn_graph_aid
} node;

typedef struct output {
    const char *name;
    tyn_ref ref;
    bool readback;
} output;

typedef struct host_buffer { // that the host sees
    VkBuffer buffer;
    tyn_place place;
    void *mapped; // NULL: not bound yet
} host_buffer;

// The Vulkan side of a resource.
typedef struct phys {
    VkImage image;
    bool borrowed;    // the image is the host's
    VkImageView view; // all mips
    VkImageView mip_views[MAX_MIPS];
    VkBuffer buffer;
    VkDeviceSize bytes;
    bool shared;    // lies in a block with others, some of them in the same place (share.h)
    uint32_t block; // its id
    VkDeviceSize size;
    VkImageUsageFlags image_usage;
    VkBufferUsageFlags buffer_usage;
    uint32_t texel_uses; // bit i: it is read as texels in graph_texel_formats[i]
    VkBufferView texels[NUM_TEXEL_FORMATS];
    tyn_track track;
    uint64_t content;  // what is in it; 0 = nothing
    uint64_t key;      // HISTORY
    bool started;      // HISTORY: from zeros, and no node has run on it since
    uint64_t identity; // its name, kind and shape, if a later compilation may take it over; else 0
    uint64_t age;      // which heap it lies in: graph.age when it was made; 0 = its own
    tyn_heap heap;     // HISTORY: its own, so that it outlives the others
    uint64_t made;     // graph.frame when it was made
    bool kept;         // taken over from the compilation before
    tyn_place place;   // in its heap
    host_buffer staging; // UPLOAD, big: waits to be copied
    uint64_t staged;     // content hash in staging; 0 = none
    host_buffer readback;
    uint64_t read; // content in readback
} phys;

typedef struct shared_block { // one block of memory that lasts as long as something lies in it
    tyn_heap heap;            // this block alone
    VkDeviceSize size, align;
    uint32_t id, type;
    uint64_t made; // graph.frame then
} shared_block;

typedef struct aged_heap { // of an earlier compilation, with something in it that is still used
    tyn_heap heap;
    uint64_t age, made; // graph.frame then
} aged_heap;

typedef struct node_run { // of a node
    uint64_t hash;        // when it last ran; 0 = never
    uint64_t asked;       // likewise, of a pass that settles
    uint32_t settled;     // ... UINT32_MAX: it has settled
    uint64_t hold;        // likewise, of a pass whose results may be old
    uint32_t held;        // ... frames since in which it would have run
    tyn_node_stats stats;
} node_run;

typedef struct frame_slot { // one per frame in flight
    VkDescriptorPool pool;
    VkQueryPool queries;
    bool pending;    // timestamps were written
    uint8_t *timed;  // per node: it ran in this slot's last record
    double frame_ms; // of the nodes that ran in it for the frame's sake; 0: not known (yet)
    uint64_t made;   // graph.frame when the pools were made
} frame_slot;

typedef struct retire_list {
    struct retired *items;
    uint32_t count, cap;
} retire_list;

// Pipelines that a declaration needs, each once.
typedef struct pipeline_list {
    tyn_variant **items;
    uint32_t count, cap;
} pipeline_list;

// What a dry run of the recorder learns.
typedef struct survey {
    uint64_t hash; // of all kernels, bindings and specialisations: the structure of the dispatches
    uint32_t sets, descriptors[NUM_DESCRIPTORS]; // by VkDescriptorType
} survey;

// Resources of the last compilation that this one does not use.
typedef struct heritage {
    phys *items;
    uint32_t count;
} heritage;

typedef enum arrangement {
    ARRANGE_KEEPING = 0, // what is there already and fits
    ARRANGE_ANEW,        // but histories
    ARRANGE_UPLOADS,     // all is there: staging alone
} arrangement;

typedef struct set_key {
    uint64_t hash;
    VkDescriptorSet set;
} set_key;

// Descriptor sets of a record: one per launch in their order, equal ones made once.
typedef struct launch_sets {
    VkDescriptorSet *items;
    uint32_t count, cap, next; // next: of the launch that is recorded next
    set_key made[256];
} launch_sets;

struct tyn_graph {
    tyn_device *dev;
    uint32_t num_slots;
    // declaration
    tyn_result status;
    resource *resources;
    uint32_t num_resources, cap_resources;
    node *nodes;
    uint32_t num_nodes, cap_nodes;
    uint8_t *params; // bytes of all nodes' params
    uint32_t params_used, params_cap;
    output outputs[32];
    uint32_t num_outputs;
    uint64_t unique; // ever-changing content
    tyn_record_mode mode;
    bool aid;    // nodes that are added now are
    bool poison; // tests: what a node has not written is NaN
    // compiled
    uint64_t structure; // 0 = nothing compiled
    bool current;       // the declaration is the one that was compiled or recorded last
    bool *run_node;     // per node: runs in the record under way
    phys *phys;
    uint32_t num_phys;
    node_run *runs;
    uint32_t num_runs;
    tyn_heap heap, staging_heap;
    uint64_t age;                     // of `heap`: compilations so far
    uint64_t heap_made, staging_made; // graph.frame when things were put there
    aged_heap *aged;
    uint32_t num_aged;
    bool reused; // memory of what is gone: the next record waits for all before it
    shared_block *blocks;
    uint32_t num_blocks, block_ids; // ids are never given twice
    VkDeviceSize persistent_bytes, transient_bytes;
    VkDeviceSize budget; // of all device memory; 0 = no limit
    frame_slot slots[MAX_SLOTS];
    survey room;         // of their pools
    uint32_t num_timed;  // nodes that they have timestamps for
    uint64_t frame;      // records so far
    retire_list retired; // what they may still use
    launch_sets sets;    // of the current record
    tyn_node_stats *stats;
    pipeline_list wanted; // that are being compiled in the background
};

typedef struct draft {
    arrangement how;
    survey survey;    // not set by ARRANGE_UPLOADS
    tyn_graph before; // restored if the draft is undone
    heritage old;     // resources of `before` that the draft does not use
} draft;

typedef enum recorder_mode {
    RECORD_SURVEY = 0,
    RECORD_PIPELINES,
    RECORD_SETS, // descriptor sets of what RECORD_LIVE will launch: all that can fail, before anything is appended
    RECORD_PLAN,
    RECORD_LIVE
} recorder_mode;

struct tyn_recorder {
    tyn_graph *g;
    uint32_t node;
    recorder_mode mode;
    tyn_result result;
    VkCommandBuffer cmd;                         // LIVE
    survey *survey;                              // SURVEY
    phys *usage;                                 // SURVEY: collects usage flags; may be NULL
    tyn_track *tracks;                           // PLAN: per resource
    void (*print)(void *user, const char *line); // PLAN
    void *print_user;
    uint32_t dispatches, barriers;
    struct {
        const char *name;
        double amount;
    } work[TYN_MAX_WORK];
    uint32_t num_work;
};

typedef struct touch { // one resource in one dispatch or draw
    uint32_t resource;
    tyn_access access;
} touch;

// One dispatch or draw under way.
typedef struct launch {
    uint32_t kernel;
    const uint32_t *spec;
    const uint8_t *mips;
    uint8_t ports[TYN_MAX_BINDINGS];
    touch touches[TYN_MAX_BINDINGS + TYN_MAX_ATTACHMENTS + 1];
    uint32_t num_touches;
} launch;

// Directions of ports, as sets.
enum {
    DIR_READ = 1 << TYN_IN | 1 << TYN_INOUT,
    DIR_WRITTEN = 1 << TYN_OUT | 1 << TYN_INOUT,
    DIR_MADE = 1 << TYN_OUT | 1 << TYN_SCRATCH,
};
// Resource index + 1 at a port that has one of these directions; else 0.
static inline uint32_t graph_port(const node *n, uint32_t port, unsigned dirs)
{
    return dirs >> n->pass->ports[port].dir & 1 ? n->res[port] : 0;
}

tyn_result graph_fail(tyn_graph *g, tyn_result result, const char *format, ...) TYN_PRINTF(3, 4);
void graph_cull(tyn_graph *g);
tyn_result graph_survey(tyn_graph *g, survey *s, phys *usage);
uint64_t graph_structure(const tyn_graph *g, const survey *s);
// Is the declaration what was compiled?
bool graph_same_structure(tyn_graph *g);
// arrange.c: drafts objects for the declaration, without memory, in place of the compiled ones, which stay in d->before.
// Fails as if it had not been called.
tyn_result graph_draft(tyn_graph *g, arrangement how, draft *d);
// The most device memory that there would be if it were committed.
VkDeviceSize graph_draft_bytes(const tyn_graph *g, const draft *d);
void graph_undo(tyn_graph *g, draft *d);
// Gives up what the draft does not use, and allocates. If that fails the graph is to be finished.
tyn_result graph_commit(tyn_graph *g, draft *d);
// budget.c: as asked, or anew if only that keeps to the budget; else it is refused with a line.
tyn_result graph_draft_in_budget(tyn_graph *g, arrangement how, draft *d);
bool graph_fits_budget(const tyn_graph *g, const draft *d);
// allocate.c: objects of a draft, with their places in heaps.
tyn_result graph_draft_resources(tyn_graph *g);
tyn_result graph_draft_readbacks(tyn_graph *g);
tyn_result graph_draft_staging(tyn_graph *g); // uploads in host memory
tyn_result graph_bind_objects(tyn_graph *g);  // once there is memory; and their views
void graph_fill_staging(tyn_graph *g);
VkMemoryRequirements graph_requirements(const tyn_graph *g, const phys *p);
// What a later compilation may take a resource over by; 0: nothing.
uint64_t graph_identity(const tyn_graph *g, const resource *r);
void graph_inherit(tyn_graph *g, heritage *old, bool only_histories); // into g->phys
// Does anything lie in the heap that compilation `age` made?
bool graph_heap_used(const tyn_graph *g, uint64_t age);
void graph_retire_aged(tyn_graph *g, bool all); // heaps in which nothing lies, or all
// More memory than a fresh compilation would need by half, and not for the size of blocks alone.
bool graph_is_wasteful(const tyn_graph *g);
// A node all of whose results were kept has nothing to do.
bool graph_is_done(const tyn_graph *g, uint32_t index);
// A node whose results are kept reports its last run, and goes on settling where it was.
void graph_inherit_run(const tyn_graph *g, uint32_t index, node_run *run);
// Pools; those of a compilation before serve again where they have room.
tyn_result graph_create_slots(tyn_graph *g, const survey *s);
tyn_result graph_reserve_sets(tyn_graph *g, uint32_t count);
void graph_destroy_slot(tyn_graph *g, frame_slot *slot);
void graph_finish(tyn_graph *g); // everything compiled
// All pipelines of the declaration, whatever was compiled before; in the background: TYN_PENDING until they are there.
tyn_result graph_make_pipelines(tyn_graph *g);
tyn_result graph_want_pipeline(tyn_graph *g, tyn_variant *v); // by RECORD_PIPELINES
void graph_forget_pipelines(tyn_graph *g); // those that are being compiled for it
// In place of a record: asks for pipelines, and takes the host's images to their `after`.
tyn_result graph_postpone(tyn_graph *g, VkCommandBuffer cmd);
// Makes room for `count` calls of graph_retire and graph_retire_heap. False: out of memory.
bool graph_retire_reserve(tyn_graph *g, uint32_t count);
// Destroys it when the frames recorded so far are over. `made`: g->frame when it was made. `handle` may be NULL, `heap` empty.
void graph_retire(tyn_graph *g, VkObjectType type, uint64_t handle, uint64_t made);
void graph_retire_heap(tyn_graph *g, tyn_heap *heap, uint64_t made);
void graph_retire_over(tyn_graph *g);                // those whose frames are over
void graph_retire_finish(tyn_graph *g);              // all: the GPU is done
bool graph_waits(const tyn_graph *g, uint64_t made); // would it, if it were retired now?
VkDeviceSize graph_retired_bytes(const tyn_graph *g);
// Of what is kept from the compilation before, gives back to `old` whatever lies in one place and may not do so any more.
tyn_result graph_keep_places(tyn_graph *g, heritage *old);
// Places for the resources that are `shared`, in blocks of before unless `anew`; counts into g->transient_bytes the bytes
// that none would have for good if all were placed anew.
tyn_result graph_draft_shared(tyn_graph *g, bool anew);
shared_block *graph_find_block(const tyn_graph *g, uint32_t id); // NULL: there is none
bool graph_block_used(const tyn_graph *g, const shared_block *block);
// Of what a node makes and works in: in all, and how much of it lies where what other nodes make or work in does.
void graph_node_bytes(const tyn_graph *g, uint32_t index, uint64_t *bytes, uint64_t *shared);
void graph_retire_blocks(tyn_graph *g, bool all); // those in which nothing lies, or all
void graph_destroy_phys(tyn_graph *g, phys *p);
bool graph_overlap(const phys *a, const phys *b);
void graph_free_staging(tyn_graph *g);
bool graph_uploads_staged(const tyn_graph *g);
uint32_t graph_texel_size(VkFormat format);
const char *graph_format_name(VkFormat format);   // for dumps
uint64_t graph_resource_bytes(const resource *r); // of its texels, without padding
extern const VkFormat graph_texel_formats[NUM_TEXEL_FORMATS];
int graph_texel_index(tyn_use use); // into them; < 0: not a use as texels

tyn_access graph_transfer(const resource *r, bool write);
VkImageMemoryBarrier2 graph_image_barrier(const resource *r, VkImage image, const tyn_barrier *b);
void graph_memory_barrier(const tyn_graph *g, VkCommandBuffer cmd, const tyn_barrier *b);
// What a node does, in the recorder's mode.
void recorder_run(tyn_recorder *r);
// Of each node in turn, without a command buffer: those of `run_node`, or of NULL all that are needed. Up to a failure.
tyn_result recorder_run_all(const tyn_recorder *like, const bool *run_node);
// Records a barrier for one access outside any node (uploads, readback, host images).
void recorder_access(tyn_recorder *r, uint32_t resource_index, tyn_access access);
// Before a node: marks what it makes where others lie, so that its first access waits for all commands and their writes.
void recorder_enter(tyn_recorder *r);
void recorder_fail(tyn_recorder *r, tyn_result result, const char *what, const char *which);

// Starts with what the kernel's bindings touch; `ports`, `spec` and `mips` may be NULL.
launch launch_begin(tyn_recorder *r, uint32_t kernel, const uint8_t *ports, const uint8_t *mips,
                    const uint32_t *spec);
void launch_touch(launch *l, uint32_t resource_index, tyn_access access);
// Surveys, or makes the pipeline, or puts the barriers into the stream. True if the command itself is
// to be printed (PLAN) or recorded (LIVE).
bool launch_prepare(tyn_recorder *r, const launch *l);
// Binds pipeline and descriptors; its pipeline, or NULL if that failed.
const tyn_pipeline *launch_bind(tyn_recorder *r, const launch *l);
