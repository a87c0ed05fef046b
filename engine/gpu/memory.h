// memory.h -- device memory in few large blocks, given out linearly, freed all at once.
#pragma once
#include "gpu/device.h"

typedef struct tyn_block {
    tyn_allocation allocation; // mapped: host-visible blocks
    uint32_t type;
    VkDeviceSize size, used;
} tyn_block;

typedef struct tyn_heap {
    tyn_block *blocks;
    uint32_t num_blocks;
    VkDeviceSize total;
} tyn_heap;

typedef enum tyn_memory_kind {
    TYN_MEMORY_DEVICE = 0,
    TYN_MEMORY_UPLOAD,   // host-visible and coherent
    TYN_MEMORY_READBACK, // host-visible and coherent, cached where there is such a type
} tyn_memory_kind;

// `expected` is what will still be asked for of this kind: the next block is made that large.
tyn_result tyn_heap_bind_buffer(tyn_device *dev, tyn_heap *heap, VkBuffer buffer,
                                tyn_memory_kind kind, VkDeviceSize expected, void **mapped);
tyn_result tyn_heap_bind_image(tyn_device *dev, tyn_heap *heap, VkImage image,
                               VkDeviceSize expected);
// A block that the caller binds things to, of a memory type from tyn_memory_type. It begins at a multiple of `align`, at
// `out->offset` of `out->memory`.
tyn_result tyn_heap_add(tyn_device *dev, tyn_heap *heap, uint32_t type, VkDeviceSize size,
                        VkDeviceSize align, tyn_allocation *out);
// The best of the `allowed` types (bits), or -1.
int tyn_memory_type(const tyn_device *dev, uint32_t allowed, tyn_memory_kind kind);
void tyn_heap_finish(tyn_device *dev, tyn_heap *heap);
