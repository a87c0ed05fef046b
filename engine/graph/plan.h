// plan.h -- the barrier planner: accesses in, barriers out. A pure function over small structs, tested
// without a GPU.
//
// Every resource has a track: what was last written, to whom that write has been made visible, who
// read it since, and (images) in which layout it is. An access to it needs
//   read after write        a memory dependency, once per (stage, access) it becomes visible to
//   read after read         nothing
//   write after read        an execution dependency only
//   write after write, and read-modify-write after a write    a full memory dependency
//   another layout          a transition, which is a write
// unless a barrier for all memory that others needed has already made it (tyn_track_barrier).
// Tracks live across frames, so the first accesses of a frame depend on the last ones of the frame
// before it.
#pragma once
#include <stdbool.h>
#include <stdint.h>
#include <vulkan/vulkan_core.h>

typedef struct tyn_track {
    VkPipelineStageFlags2 write_stages; // of the last write; 0 = never written
    VkAccessFlags2 write_access;        // 0 once it is available (flushed)
    VkPipelineStageFlags2 visible_stages;
    VkAccessFlags2 visible_access;
    VkPipelineStageFlags2 read_stages; // reads since the last write
    VkPipelineStageFlags2 after_reads; // stages that these reads are ordered before
    VkImageLayout layout;              // images
} tyn_track;

typedef struct tyn_access {
    VkPipelineStageFlags2 stages;
    VkAccessFlags2 access;
    bool read, write;
    VkImageLayout layout; // VK_IMAGE_LAYOUT_UNDEFINED for buffers
} tyn_access;

typedef struct tyn_barrier {
    VkPipelineStageFlags2 src_stages, dst_stages;
    VkAccessFlags2 src_access, dst_access;
    VkImageLayout old_layout, new_layout; // equal: no transition
} tyn_barrier;

// Joins two accesses of one dispatch to one resource (two bindings). Images that are asked for in two
// layouts go to GENERAL.
tyn_access tyn_access_join(tyn_access a, tyn_access b);

// Advances the track over the access. True if `out` must come first.
bool tyn_plan(tyn_track *track, tyn_access access, tyn_barrier *out);

// Joins `b`, without its transition, to a barrier for all memory; {0}: to none yet.
void tyn_barrier_join(tyn_barrier *all, const tyn_barrier *b);

// Lets a barrier for all memory make visible to compute shaders, and to transfers, what it makes visible to one kind of accesses of
// compute shaders: it costs as much, and those that come next need none.
void tyn_barrier_widen(tyn_barrier *all);

// Notes a barrier for all memory in a track: what it orders and makes visible needs no barrier of its own.
void tyn_track_barrier(tyn_track *track, const tyn_barrier *all);

// "COMPUTE|TRANSFER", "SHADER_SAMPLED_READ", "GENERAL": for dumps and tests. Writes at most size bytes.
void tyn_print_stages(char *text, size_t size, VkPipelineStageFlags2 stages);
void tyn_print_access(char *text, size_t size, VkAccessFlags2 access);
const char *tyn_layout_name(VkImageLayout layout);
