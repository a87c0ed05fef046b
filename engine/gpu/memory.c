// memory.c -- see memory.h.
#include "gpu/memory.h"
#include "base/fault.h"
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

// Memory for a block that has none yet.
static tyn_result fill_block(tyn_device *dev, tyn_block *block)
{
    const tyn_memory_request request = {{block->size, block->align, 1u << block->type},
                                        block->host};
    VkResult made;
    if (dev->allocator.allocate) {
        made = dev->allocator.allocate(dev->allocator.user, &request, &block->allocation);
        made = made == VK_SUCCESS ? check_given(dev, &request, &block->allocation) : made;
    } else {
        made = allocate_from_device(dev, &request, block->type, &block->allocation);
    }
    if (made != VK_SUCCESS) {
        block->allocation = (tyn_allocation){0};
    }
    if (made == VK_ERROR_OUT_OF_DEVICE_MEMORY || made == VK_ERROR_OUT_OF_HOST_MEMORY) {
        return TYN_FAULT(&dev->log, TYN_ERR_MEMORY,
                         "out of device memory: %.1f MiB more were needed",
                         (double)block->size / (1 << 20));
    }
    return tyn_vk_check(dev, made, "allocating device memory");
}

tyn_result tyn_heap_allocate(tyn_device *dev, tyn_heap *heap)
{
    for (uint32_t i = 0; i < heap->num_blocks; i++) {
        if (!heap->blocks[i].allocation.memory) {
            TYN_TRY(fill_block(dev, &heap->blocks[i]));
        }
    }
    return TYN_OK;
}

tyn_result tyn_heap_add(tyn_heap *heap, const tyn_block *block)
{
    tyn_block *grown = realloc(heap->blocks, (heap->num_blocks + 1) * sizeof *heap->blocks);
    if (!grown) {
        return TYN_ERR_MEMORY;
    }
    heap->blocks = grown;
    heap->blocks[heap->num_blocks++] = *block;
    heap->total += block->size;
    return TYN_OK;
}

static VkDeviceSize align_up(VkDeviceSize x, VkDeviceSize align)
{
    return (x + align - 1) / align * align;
}

tyn_result tyn_heap_place(const tyn_device *dev, tyn_heap *heap, const VkMemoryRequirements *need,
                          tyn_memory_kind kind, VkDeviceSize expected, tyn_place *out)
{
    const int type = tyn_memory_type(dev, need->memoryTypeBits, kind);
    if (type < 0) {
        return TYN_FAULT(&dev->log, TYN_ERR_DEVICE, "the device has no memory type of kind %d",
                         kind);
    }
    // Buffers and images may share a block: keep them a granularity page apart.
    const VkDeviceSize page = dev->properties.limits.bufferImageGranularity;
    const VkDeviceSize align = need->alignment > page ? need->alignment : page;
    const bool host = kind != TYN_MEMORY_DEVICE;
    for (uint32_t i = 0; i < heap->num_blocks; i++) {
        tyn_block *b = &heap->blocks[i];
        const VkDeviceSize at = align_up(b->used, align);
        if (b->type == (uint32_t)type && b->host == host && at + need->size <= b->size) {
            b->used = at + need->size;
            b->align = align > b->align ? align : b->align;
            *out = (tyn_place){i, at};
            return TYN_OK;
        }
    }
    const VkDeviceSize likely = !expected              ? 0
                                : expected < MIN_BLOCK ? MIN_BLOCK
                                : expected > MAX_BLOCK ? MAX_BLOCK
                                                       : expected;
    *out = (tyn_place){heap->num_blocks, 0};
    return tyn_heap_add(heap, &(tyn_block){.type = (uint32_t)type,
                                           .host = host,
                                           .align = align,
                                           .size = likely < need->size ? need->size : likely,
                                           .used = need->size});
}

tyn_result tyn_heap_bind_buffer(tyn_device *dev, const tyn_heap *heap, VkBuffer buffer,
                                tyn_place place, void **mapped)
{
    const tyn_allocation *a = &heap->blocks[place.block].allocation;
    if (mapped) {
        *mapped = a->mapped ? (char *)a->mapped + place.offset : NULL;
    }
    return tyn_vk_check(
        dev, dev->vk.BindBufferMemory(dev->device, buffer, a->memory, a->offset + place.offset),
        "vkBindBufferMemory");
}

tyn_result tyn_heap_bind_image(tyn_device *dev, const tyn_heap *heap, VkImage image,
                               tyn_place place)
{
    const tyn_allocation *a = &heap->blocks[place.block].allocation;
    return tyn_vk_check(
        dev, dev->vk.BindImageMemory(dev->device, image, a->memory, a->offset + place.offset),
        "vkBindImageMemory");
}

void tyn_heap_finish(tyn_device *dev, tyn_heap *heap)
{
    for (uint32_t i = 0; i < heap->num_blocks; i++) {
        if (heap->blocks[i].allocation.memory) {
            release(dev, &heap->blocks[i].allocation);
        }
    }
    free(heap->blocks);
    *heap = (tyn_heap){0};
}
