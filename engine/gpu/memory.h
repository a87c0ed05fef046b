// memory.h -- device memory in few large blocks, given out linearly, freed all at once.
//
// A heap is laid out first and allocated then: tyn_heap_place and tyn_heap_add need no memory, so that a layout can be
// counted (`total`) and dropped.
#pragma once
#include "gpu/device.h"

typedef struct tyn_block {
    tyn_allocation allocation; // memory NULL: not allocated yet
    uint32_t type;             // from tyn_memory_type
    bool host;                 // mapped
    VkDeviceSize align, size, used;
} tyn_block;

typedef struct tyn_heap {
    tyn_block *blocks;
    uint32_t num_blocks;
    VkDeviceSize total; // bytes of all blocks
} tyn_heap;

typedef struct tyn_place {
    uint32_t block;
    VkDeviceSize offset; // in it
} tyn_place;

typedef enum tyn_memory_kind {
    TYN_MEMORY_DEVICE = 0,
    TYN_MEMORY_UPLOAD,   // host-visible and coherent
    TYN_MEMORY_READBACK, // host-visible and coherent, cached where there is such a type
} tyn_memory_kind;

// `expected` is what will still be asked for of this kind, this with it: a new block is made that large; 0: this alone.
tyn_result tyn_heap_place(const tyn_device *dev, tyn_heap *heap, const VkMemoryRequirements *need,
                          tyn_memory_kind kind, VkDeviceSize expected, tyn_place *out);
// A block that the caller lays out.
tyn_result tyn_heap_add(tyn_heap *heap, const tyn_block *block);
// Memory for every block that has none.
tyn_result tyn_heap_allocate(tyn_device *dev, tyn_heap *heap);
// `mapped` may be NULL.
tyn_result tyn_heap_bind_buffer(tyn_device *dev, const tyn_heap *heap, VkBuffer buffer,
                                tyn_place place, void **mapped);
tyn_result tyn_heap_bind_image(tyn_device *dev, const tyn_heap *heap, VkImage image,
                               tyn_place place);
// The best of the `allowed` types (bits), or -1.
int tyn_memory_type(const tyn_device *dev, uint32_t allowed, tyn_memory_kind kind);
void tyn_heap_finish(tyn_device *dev, tyn_heap *heap);
