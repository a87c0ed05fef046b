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

static VkResult allocate_from_device(const tyn_device *dev, const tyn_memory_request *request,
                                     uint32_t type, tyn_allocation *out)
{
    const VkResult made = TYN_VK_MADE(
        &out->memory, dev->vk.AllocateMemory(
                          dev->device,
                          &(VkMemoryAllocateInfo){.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                                  .allocationSize = request->requirements.size,
                                                  .memoryTypeIndex = type},
                          NULL, &out->memory));
    if (made != VK_SUCCESS || !request->mapped) {
        return made;
    }
    const VkResult mapped =
        dev->vk.MapMemory(dev->device, out->memory, 0, VK_WHOLE_SIZE, 0, &out->mapped);
    if (mapped != VK_SUCCESS) {
        dev->vk.FreeMemory(dev->device, out->memory, NULL);
    }
    return mapped;
}

static void release(const tyn_device *dev, const tyn_allocation *allocation)
{
    if (dev->allocator.free) {
        dev->allocator.free(dev->allocator.user, allocation);
    } else {
        dev->vk.FreeMemory(dev->device, allocation->memory, NULL);
    }
}

// What the host gave, if it can be used.
static VkResult check_given(const tyn_device *dev, const tyn_memory_request *request,
                            const tyn_allocation *given)
{
    const VkDeviceSize align = request->requirements.alignment;
    const char *fault = !given->memory                      ? "memory is NULL"
                        : given->offset % align             ? "offset is not aligned"
                        : request->mapped && !given->mapped ? "mapped is NULL"
                                                            : NULL;
    if (!fault) {
        return VK_SUCCESS;
    }
    tyn_log_print(&dev->log, TYN_LOG_ERROR,
                  "allocator.allocate: %s (%llu bytes, aligned to %llu, of memory type bits %#x%s)",
                  fault, (unsigned long long)request->requirements.size, (unsigned long long)align,
                  request->requirements.memoryTypeBits, request->mapped ? ", mapped" : "");
    release(dev, given);
    return VK_ERROR_UNKNOWN;
}

static tyn_result add_block(tyn_device *dev, tyn_heap *heap, uint32_t type, VkDeviceSize size,
                            VkDeviceSize align, bool map, tyn_block **out)
{
    tyn_block *grown = realloc(heap->blocks, (heap->num_blocks + 1) * sizeof *heap->blocks);
    if (!grown) {
        return TYN_ERR_MEMORY;
    }
    heap->blocks = grown;
    tyn_block block = {.type = type, .size = size};
    const tyn_memory_request request = {{size, align, 1u << type}, map};
    VkResult made;
    if (dev->allocator.allocate) {
        made = dev->allocator.allocate(dev->allocator.user, &request, &block.allocation);
        made = made == VK_SUCCESS ? check_given(dev, &request, &block.allocation) : made;
    } else {
        made = allocate_from_device(dev, &request, type, &block.allocation);
    }
    if (made == VK_ERROR_OUT_OF_DEVICE_MEMORY || made == VK_ERROR_OUT_OF_HOST_MEMORY) {
        tyn_log_print(&dev->log, TYN_LOG_ERROR, "out of device memory: %.1f MiB more were needed",
                      (double)size / (1 << 20));
        return TYN_ERR_MEMORY;
    }
    if (made != VK_SUCCESS) {
        return tyn_vk_check(dev, made, "allocating device memory");
    }
    heap->total += size;
    heap->blocks[heap->num_blocks] = block;
    *out = &heap->blocks[heap->num_blocks++];
    return TYN_OK;
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
        const VkDeviceSize base = b->allocation.offset;
        const VkDeviceSize at = (base + b->used + align - 1) / align * align - base;
        bool host = kind != TYN_MEMORY_DEVICE;
        if (b->type == (uint32_t)type && host == (b->allocation.mapped != NULL) &&
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
    const tyn_result result =
        add_block(dev, heap, (uint32_t)type, size, align, kind != TYN_MEMORY_DEVICE, out);
    if (result == TYN_OK) {
        (*out)->used = need->size;
        *offset = 0;
    }
    return result;
}

tyn_result tyn_heap_add(tyn_device *dev, tyn_heap *heap, uint32_t type, VkDeviceSize size,
                        VkDeviceSize align, tyn_allocation *out)
{
    tyn_block *block = NULL;
    const tyn_result result = add_block(dev, heap, type, size, align, false, &block);
    if (result == TYN_OK) {
        block->used = size;
        *out = block->allocation;
    }
    return result;
}

tyn_result tyn_heap_bind_buffer(tyn_device *dev, tyn_heap *heap, VkBuffer buffer,
                                tyn_memory_kind kind, VkDeviceSize expected, void **mapped)
{
    VkMemoryRequirements need;
    dev->vk.GetBufferMemoryRequirements(dev->device, buffer, &need);
    tyn_block *block = NULL;
    VkDeviceSize offset;
    tyn_result result = allocate(dev, heap, &need, kind, expected, &block, &offset);
    if (result != TYN_OK) {
        return result;
    }
    if (mapped) {
        *mapped = block->allocation.mapped ? (char *)block->allocation.mapped + offset : NULL;
    }
    const tyn_allocation *a = &block->allocation;
    return tyn_vk_check(
        dev, dev->vk.BindBufferMemory(dev->device, buffer, a->memory, a->offset + offset),
        "vkBindBufferMemory");
}

tyn_result tyn_heap_bind_image(tyn_device *dev, tyn_heap *heap, VkImage image,
                               VkDeviceSize expected)
{
    VkMemoryRequirements need;
    dev->vk.GetImageMemoryRequirements(dev->device, image, &need);
    tyn_block *block = NULL;
    VkDeviceSize offset;
    tyn_result result = allocate(dev, heap, &need, TYN_MEMORY_DEVICE, expected, &block, &offset);
    if (result != TYN_OK) {
        return result;
    }
    const tyn_allocation *a = &block->allocation;
    return tyn_vk_check(dev,
                        dev->vk.BindImageMemory(dev->device, image, a->memory, a->offset + offset),
                        "vkBindImageMemory");
}

void tyn_heap_finish(tyn_device *dev, tyn_heap *heap)
{
    for (uint32_t i = 0; i < heap->num_blocks; i++) {
        release(dev, &heap->blocks[i].allocation);
    }
    free(heap->blocks);
    *heap = (tyn_heap){0};
}
