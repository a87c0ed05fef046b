// memory.c -- device memory in few large blocks, given out linearly, freed all at once.
#include "gpu/memory.h"
#include <stdlib.h>

static const VkDeviceSize MIN_BLOCK = 1u << 20, MAX_BLOCK = 256u << 20;

int tyn_memory_type(const tyn_device *dev, uint32_t allowed, tyn_memory_kind kind)
{
    const VkMemoryPropertyFlags host =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    // From best to acceptable; a zero accepts anything allowed.
    const VkMemoryPropertyFlags wishes[3][2] = {
        {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0},
        {host, host},
        {host | VK_MEMORY_PROPERTY_HOST_CACHED_BIT, host},
    };
    for (int w = 0; w < 2; w++) {
        VkMemoryPropertyFlags want = wishes[kind][w];
        for (uint32_t i = 0; i < dev->memory.memoryTypeCount; i++) {
            if ((allowed >> i & 1u) && (dev->memory.memoryTypes[i].propertyFlags & want) == want) {
                return (int)i;
            }
        }
    }
    return -1;
}

static tyn_block *add_block(tyn_device *dev, tyn_heap *heap, uint32_t type, VkDeviceSize size,
                            bool map)
{
    tyn_block *grown = realloc(heap->blocks, (heap->num_blocks + 1) * sizeof *heap->blocks);
    if (!grown) {
        return NULL;
    }
    heap->blocks = grown;
    tyn_block block = {.type = type, .size = size};
    VkResult made = dev->vk.AllocateMemory(
        dev->device,
        &(VkMemoryAllocateInfo){.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                .allocationSize = size,
                                .memoryTypeIndex = type},
        NULL, &block.memory);
    if (made != VK_SUCCESS) {
        tyn_log_print(&dev->log, TYN_LOG_ERROR, "out of device memory: %.1f MiB more were needed",
                      (double)size / (1 << 20));
        return NULL;
    }
    if (map && dev->vk.MapMemory(dev->device, block.memory, 0, VK_WHOLE_SIZE, 0, &block.mapped) !=
                   VK_SUCCESS) {
        dev->vk.FreeMemory(dev->device, block.memory, NULL);
        return NULL;
    }
    heap->total += size;
    heap->blocks[heap->num_blocks] = block;
    return &heap->blocks[heap->num_blocks++];
}

static tyn_result allocate(tyn_device *dev, tyn_heap *heap, const VkMemoryRequirements *need,
                           tyn_memory_kind kind, VkDeviceSize expected, tyn_block **out,
                           VkDeviceSize *offset)
{
    int type = tyn_memory_type(dev, need->memoryTypeBits, kind);
    if (type < 0) {
        tyn_log_print(&dev->log, TYN_LOG_ERROR, "the device has no memory type of kind %d", kind);
        return TYN_ERR_DEVICE;
    }
    // Buffers and images may share a block: keep them a granularity page apart.
    VkDeviceSize align = need->alignment > dev->properties.limits.bufferImageGranularity
                             ? need->alignment
                             : dev->properties.limits.bufferImageGranularity;
    for (uint32_t i = 0; i < heap->num_blocks; i++) {
        tyn_block *b = &heap->blocks[i];
        VkDeviceSize at = (b->used + align - 1) / align * align;
        bool host = kind != TYN_MEMORY_DEVICE;
        if (b->type == (uint32_t)type && host == (b->mapped != NULL) &&
            at + need->size <= b->size) {
            b->used = at + need->size;
            *out = b;
            *offset = at;
            return TYN_OK;
        }
    }
    VkDeviceSize size = expected < MIN_BLOCK   ? MIN_BLOCK
                        : expected > MAX_BLOCK ? MAX_BLOCK
                                               : expected;
    size = size < need->size ? need->size : size;
    tyn_block *b = add_block(dev, heap, (uint32_t)type, size, kind != TYN_MEMORY_DEVICE);
    if (!b) {
        return TYN_ERR_MEMORY;
    }
    b->used = need->size;
    *out = b;
    *offset = 0;
    return TYN_OK;
}

tyn_result tyn_heap_add(tyn_device *dev, tyn_heap *heap, uint32_t type, VkDeviceSize size,
                        VkDeviceMemory *memory)
{
    tyn_block *b = add_block(dev, heap, type, size, false);
    if (!b) {
        return TYN_ERR_MEMORY;
    }
    b->used = size;
    *memory = b->memory;
    return TYN_OK;
}

tyn_result tyn_heap_bind_buffer(tyn_device *dev, tyn_heap *heap, VkBuffer buffer,
                                tyn_memory_kind kind, VkDeviceSize expected, void **mapped)
{
    VkMemoryRequirements need;
    dev->vk.GetBufferMemoryRequirements(dev->device, buffer, &need);
    tyn_block *block;
    VkDeviceSize offset;
    tyn_result result = allocate(dev, heap, &need, kind, expected, &block, &offset);
    if (result != TYN_OK) {
        return result;
    }
    if (mapped) {
        *mapped = block->mapped ? (char *)block->mapped + offset : NULL;
    }
    return tyn_vk_check(dev, dev->vk.BindBufferMemory(dev->device, buffer, block->memory, offset),
                        "vkBindBufferMemory");
}

tyn_result tyn_heap_bind_image(tyn_device *dev, tyn_heap *heap, VkImage image,
                               VkDeviceSize expected)
{
    VkMemoryRequirements need;
    dev->vk.GetImageMemoryRequirements(dev->device, image, &need);
    tyn_block *block;
    VkDeviceSize offset;
    tyn_result result = allocate(dev, heap, &need, TYN_MEMORY_DEVICE, expected, &block, &offset);
    if (result != TYN_OK) {
        return result;
    }
    return tyn_vk_check(dev, dev->vk.BindImageMemory(dev->device, image, block->memory, offset),
                        "vkBindImageMemory");
}

void tyn_heap_finish(tyn_device *dev, tyn_heap *heap)
{
    for (uint32_t i = 0; i < heap->num_blocks; i++) {
        dev->vk.FreeMemory(dev->device, heap->blocks[i].memory, NULL);
    }
    free(heap->blocks);
    *heap = (tyn_heap){0};
}
