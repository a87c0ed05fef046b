// fake_vulkan.c -- see fake_vulkan.h. Handles are numbers of entries in a table of names.
#include "fake_vulkan.h"
#include "graph/internal.h"
#include "graph/plan.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

enum { MAX_OBJECTS = 4096 };

typedef struct object {
    bool live;
    const char *kind;
    char name[64];
    VkDeviceSize size; // of buffers, images and memory
    void *memory;
} object;

// Vulkan's functions get handles only, so what they talk about has to be global; one device at a time.
static fake_vulkan *fake;
static object objects[MAX_OBJECTS];

static void put(const char *format, ...)
{
    va_list args;
    char line[1024];
    va_start(args, format);
    int n = vsnprintf(line, sizeof line, format, args);
    va_end(args);
    if (fake->used + (size_t)n + 1 > fake->cap) {
        fake->cap = (fake->used + (size_t)n + 1) * 2;
        fake->text = realloc(fake->text, fake->cap);
    }
    memcpy(fake->text + fake->used, line, (size_t)n + 1);
    fake->used += (size_t)n;
}

// ---- objects ----------------------------------------------------------------------------------

static VkResult create(const char *kind, uint64_t *handle)
{
    fake->created++;
    fake->memory += !strcmp(kind, "DeviceMemory");
    fake->kernels += !strcmp(kind, "Pipeline") || !strcmp(kind, "PipelineLayout") ||
                     !strcmp(kind, "ShaderModule") || !strcmp(kind, "DescriptorSetLayout");
    fake->created_while_recording += fake->recording;
    *handle = 0;
    if (fake->created == fake->fail_at) {
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    }
    for (uint64_t i = 1; i < MAX_OBJECTS; i++) {
        if (!objects[i].live) {
            objects[i] = (object){.live = true, .kind = kind};
            fake->live++;
            *handle = i;
            return VK_SUCCESS;
        }
    }
    return VK_ERROR_TOO_MANY_OBJECTS;
}

static void destroy(const char *kind, uint64_t handle)
{
    if (handle) {
        assert_true(handle < MAX_OBJECTS && objects[handle].live);
        assert_string_equal(objects[handle].kind, kind);
        fake->bytes -= !strcmp(kind, "DeviceMemory") ? objects[handle].size : 0;
        free(objects[handle].memory);
        objects[handle].memory = NULL;
        objects[handle].live = false;
        fake->live--;
    }
}

static const char *name_of(uint64_t handle)
{
    assert_true(handle && handle < MAX_OBJECTS && objects[handle].live);
    return objects[handle].name[0] ? objects[handle].name : objects[handle].kind;
}

static void set_size(const char *kind, uint64_t handle, VkDeviceSize size)
{
    objects[handle].size = size;
    if (handle && !strcmp(kind, "DeviceMemory")) {
        fake->bytes += size;
        fake->most_bytes = fake->bytes > fake->most_bytes ? fake->bytes : fake->most_bytes;
    }
}

// `bytes` is an expression of `info`, which tests may leave out.
#define FAKE_OBJECT(Type, Info, bytes)                                                             \
    static VkResult create_##Type(VkDevice dev, const Info *info,                                  \
                                  const VkAllocationCallbacks *callbacks, Vk##Type *out)           \
    {                                                                                              \
        (void)dev, (void)callbacks;                                                                \
        uint64_t handle;                                                                           \
        VkResult result = create(#Type, &handle);                                                  \
        set_size(#Type, handle, info ? (bytes) : 0);                                               \
        *out = (Vk##Type)handle;                                                                   \
        return result;                                                                             \
    }                                                                                              \
    static void destroy_##Type(VkDevice dev, Vk##Type handle,                                      \
                               const VkAllocationCallbacks *callbacks)                             \
    {                                                                                              \
        (void)dev, (void)callbacks;                                                                \
        destroy(#Type, (uint64_t)handle);                                                          \
    }

static VkDeviceSize image_bytes(const VkImageCreateInfo *info)
{
    const VkDeviceSize bytes = (VkDeviceSize)graph_texel_size(info->format) * info->extent.width *
                               info->extent.height * info->extent.depth;
    return info->mipLevels > 1 ? 2 * bytes : bytes;
}

FAKE_OBJECT(Buffer, VkBufferCreateInfo, info->size)
FAKE_OBJECT(Image, VkImageCreateInfo, image_bytes(info))
FAKE_OBJECT(DeviceMemory, VkMemoryAllocateInfo, info->allocationSize)
FAKE_OBJECT(BufferView, VkBufferViewCreateInfo, 0)
FAKE_OBJECT(ImageView, VkImageViewCreateInfo, 0)
FAKE_OBJECT(DescriptorSetLayout, VkDescriptorSetLayoutCreateInfo, 0)
FAKE_OBJECT(PipelineLayout, VkPipelineLayoutCreateInfo, 0)
FAKE_OBJECT(ShaderModule, VkShaderModuleCreateInfo, 0)
FAKE_OBJECT(DescriptorPool, VkDescriptorPoolCreateInfo, 0)
FAKE_OBJECT(QueryPool, VkQueryPoolCreateInfo, 0)

static VkResult create_pipelines(VkDevice dev, VkPipelineCache cache, uint32_t count,
                                 const VkComputePipelineCreateInfo *info,
                                 const VkAllocationCallbacks *callbacks, VkPipeline *out)
{
    (void)dev, (void)cache, (void)info, (void)callbacks;
    assert_int_equal(count, 1);
    uint64_t handle;
    VkResult result = create("Pipeline", &handle);
    *out = (VkPipeline)handle;
    return result;
}

static VkResult create_raster_pipelines(VkDevice dev, VkPipelineCache cache, uint32_t count,
                                        const VkGraphicsPipelineCreateInfo *info,
                                        const VkAllocationCallbacks *callbacks, VkPipeline *out)
{
    (void)info;
    return create_pipelines(dev, cache, count, NULL, callbacks, out);
}

static void destroy_pipeline(VkDevice dev, VkPipeline handle,
                             const VkAllocationCallbacks *callbacks)
{
    (void)dev, (void)callbacks;
    destroy("Pipeline", (uint64_t)handle);
}

static VkResult set_name(VkDevice dev, const VkDebugUtilsObjectNameInfoEXT *info)
{
    (void)dev;
    snprintf(objects[info->objectHandle].name, sizeof objects[0].name, "%s", info->pObjectName);
    return VK_SUCCESS;
}

static void buffer_needs(VkDevice dev, VkBuffer buffer, VkMemoryRequirements *out)
{
    (void)dev;
    *out = (VkMemoryRequirements){objects[(uint64_t)buffer].size, 256, 1};
}

static void image_needs(VkDevice dev, VkImage image, VkMemoryRequirements *out)
{
    (void)dev;
    *out = (VkMemoryRequirements){objects[(uint64_t)image].size, 256, 1};
}

static VkResult bind_buffer(VkDevice dev, VkBuffer buffer, VkDeviceMemory memory,
                            VkDeviceSize offset)
{
    (void)dev, (void)buffer, (void)memory, (void)offset;
    return VK_SUCCESS;
}

static VkResult bind_image(VkDevice dev, VkImage image, VkDeviceMemory memory, VkDeviceSize offset)
{
    (void)dev, (void)image, (void)memory, (void)offset;
    return VK_SUCCESS;
}

static VkResult map(VkDevice dev, VkDeviceMemory memory, VkDeviceSize offset, VkDeviceSize size,
                    VkMemoryMapFlags flags, void **out)
{
    (void)dev, (void)offset, (void)size, (void)flags;
    object *o = &objects[(uint64_t)memory];
    o->memory = calloc(1, o->size);
    *out = o->memory;
    return VK_SUCCESS;
}

static VkResult reset_pool(VkDevice dev, VkDescriptorPool pool, VkDescriptorPoolResetFlags flags)
{
    (void)dev, (void)pool, (void)flags;
    return VK_SUCCESS;
}

static VkResult allocate_sets(VkDevice dev, const VkDescriptorSetAllocateInfo *info,
                              VkDescriptorSet *sets)
{
    (void)dev, (void)info;
    *sets = (VkDescriptorSet)(uint64_t)1;
    return fake->no_sets ? VK_ERROR_OUT_OF_POOL_MEMORY : VK_SUCCESS;
}

static void update_sets(VkDevice dev, uint32_t count, const VkWriteDescriptorSet *writes,
                        uint32_t copies, const VkCopyDescriptorSet *copy)
{
    (void)dev, (void)copies, (void)copy;
    for (uint32_t i = 0; i < count; i++) { // every binding must name something
        assert_true(writes[i].pTexelBufferView ? *writes[i].pTexelBufferView != VK_NULL_HANDLE
                    : writes[i].pBufferInfo    ? writes[i].pBufferInfo->buffer != VK_NULL_HANDLE
                                               : writes[i].pImageInfo->imageView != VK_NULL_HANDLE);
    }
}

// ---- commands ---------------------------------------------------------------------------------

static void put_barrier(uint64_t handle, const tyn_barrier *b)
{
    char src[64], dst[64], src_access[128], dst_access[128];
    tyn_print_stages(src, sizeof src, b->src_stages);
    tyn_print_stages(dst, sizeof dst, b->dst_stages);
    tyn_print_access(src_access, sizeof src_access, b->src_access);
    tyn_print_access(dst_access, sizeof dst_access, b->dst_access);
    put("barrier %s: %s %s -> %s %s", handle ? name_of(handle) : "memory", src, src_access, dst,
        dst_access);
    if (b->old_layout != b->new_layout) {
        put(", %s -> %s", tyn_layout_name(b->old_layout), tyn_layout_name(b->new_layout));
    }
    put("\n");
}

static void barrier(VkCommandBuffer cmd, const VkDependencyInfo *info)
{
    (void)cmd;
    for (uint32_t i = 0; i < info->memoryBarrierCount; i++) {
        const VkMemoryBarrier2 *b = &info->pMemoryBarriers[i];
        put_barrier(0, &(tyn_barrier){b->srcStageMask, b->dstStageMask, b->srcAccessMask,
                                      b->dstAccessMask, 0, 0});
    }
    for (uint32_t i = 0; i < info->bufferMemoryBarrierCount; i++) {
        const VkBufferMemoryBarrier2 *b = &info->pBufferMemoryBarriers[i];
        put_barrier((uint64_t)b->buffer, &(tyn_barrier){b->srcStageMask, b->dstStageMask,
                                                        b->srcAccessMask, b->dstAccessMask, 0, 0});
    }
    for (uint32_t i = 0; i < info->imageMemoryBarrierCount; i++) {
        const VkImageMemoryBarrier2 *b = &info->pImageMemoryBarriers[i];
        put_barrier((uint64_t)b->image,
                    &(tyn_barrier){b->srcStageMask, b->dstStageMask, b->srcAccessMask,
                                   b->dstAccessMask, b->oldLayout, b->newLayout});
    }
}

static uint64_t bound_pipeline;

static void bind_pipeline(VkCommandBuffer cmd, VkPipelineBindPoint point, VkPipeline pipeline)
{
    (void)cmd, (void)point;
    bound_pipeline = (uint64_t)pipeline;
}

static void bind_sets(VkCommandBuffer cmd, VkPipelineBindPoint point, VkPipelineLayout layout,
                      uint32_t first, uint32_t count, const VkDescriptorSet *sets, uint32_t num,
                      const uint32_t *offsets)
{
    (void)cmd, (void)point, (void)layout, (void)first, (void)count, (void)sets, (void)num;
    (void)offsets;
}

static void push_constants(VkCommandBuffer cmd, VkPipelineLayout layout, VkShaderStageFlags stages,
                           uint32_t offset, uint32_t size, const void *values)
{
    (void)cmd, (void)layout, (void)stages, (void)offset, (void)size;
    assert_non_null(values);
}

static void dispatch(VkCommandBuffer cmd, uint32_t x, uint32_t y, uint32_t z)
{
    (void)cmd;
    fake->dispatches++;
    put("dispatch %s %u x %u x %u\n", name_of(bound_pipeline), x, y, z);
}

static void put_attachment(const VkRenderingAttachmentInfo *a)
{
    put(" %s %s", a->loadOp == VK_ATTACHMENT_LOAD_OP_CLEAR ? "clear" : "keep",
        tyn_layout_name(a->imageLayout));
}

static void begin_rendering(VkCommandBuffer cmd, const VkRenderingInfo *info)
{
    (void)cmd;
    put("rendering %u x %u:", info->renderArea.extent.width, info->renderArea.extent.height);
    for (uint32_t i = 0; i < info->colorAttachmentCount; i++) {
        put_attachment(&info->pColorAttachments[i]);
    }
    if (info->pDepthAttachment) {
        put_attachment(info->pDepthAttachment);
    }
    put("\n");
}

static void end_rendering(VkCommandBuffer cmd)
{
    (void)cmd;
    put("end of rendering\n");
}

static void set_viewport(VkCommandBuffer cmd, uint32_t first, uint32_t count, const VkViewport *v)
{
    (void)cmd, (void)first, (void)count;
    put("at %g, %g, %g x %g ", (double)v->x, (double)v->y, (double)v->width, (double)v->height);
}

static void set_scissor(VkCommandBuffer cmd, uint32_t first, uint32_t count, const VkRect2D *s)
{
    (void)cmd, (void)first, (void)count, (void)s;
}

static void draw(VkCommandBuffer cmd, uint32_t vertices, uint32_t instances, uint32_t first,
                 uint32_t first_instance)
{
    (void)cmd, (void)instances, (void)first, (void)first_instance;
    fake->dispatches++;
    put("draw %s %u\n", name_of(bound_pipeline), vertices);
}

static void bind_indices(VkCommandBuffer cmd, VkBuffer buffer, VkDeviceSize offset,
                         VkIndexType type)
{
    (void)cmd, (void)offset, (void)type;
    put("indices %s ", name_of((uint64_t)buffer));
}

static void draw_indexed(VkCommandBuffer cmd, uint32_t indices, uint32_t instances, uint32_t first,
                         int32_t shift, uint32_t first_instance)
{
    (void)shift;
    draw(cmd, indices, instances, first, first_instance);
}

static void dispatch_indirect(VkCommandBuffer cmd, VkBuffer buffer, VkDeviceSize offset)
{
    (void)cmd;
    fake->dispatches++;
    put("dispatch %s as %s + %u says\n", name_of(bound_pipeline), name_of((uint64_t)buffer),
        (uint32_t)offset);
}

static void copy_buffer(VkCommandBuffer cmd, VkBuffer from, VkBuffer to, uint32_t count,
                        const VkBufferCopy *regions)
{
    (void)cmd, (void)count, (void)regions;
    fake->copies++;
    put("copy %s to %s\n", name_of((uint64_t)from), name_of((uint64_t)to));
}

static void copy_to_image(VkCommandBuffer cmd, VkBuffer from, VkImage to, VkImageLayout layout,
                          uint32_t count, const VkBufferImageCopy *regions)
{
    (void)cmd, (void)layout, (void)count, (void)regions;
    fake->copies++;
    put("copy %s to %s\n", name_of((uint64_t)from), name_of((uint64_t)to));
}

static void copy_from_image(VkCommandBuffer cmd, VkImage from, VkImageLayout layout, VkBuffer to,
                            uint32_t count, const VkBufferImageCopy *regions)
{
    (void)cmd, (void)layout, (void)count, (void)regions;
    fake->copies++;
    put("copy %s to %s\n", name_of((uint64_t)from), name_of((uint64_t)to));
}

static void update_buffer(VkCommandBuffer cmd, VkBuffer to, VkDeviceSize offset, VkDeviceSize size,
                          const void *data)
{
    (void)cmd, (void)offset;
    assert_true(data && size % 4 == 0 && size <= 65536);
    put("update %s\n", name_of((uint64_t)to));
}

static void fill_buffer(VkCommandBuffer cmd, VkBuffer to, VkDeviceSize offset, VkDeviceSize size,
                        uint32_t value)
{
    (void)cmd, (void)offset, (void)size, (void)value;
    put("fill %s\n", name_of((uint64_t)to));
}

static void clear_image(VkCommandBuffer cmd, VkImage to, VkImageLayout layout,
                        const VkClearColorValue *color, uint32_t count,
                        const VkImageSubresourceRange *ranges)
{
    (void)cmd, (void)layout, (void)color, (void)count, (void)ranges;
    put("clear %s\n", name_of((uint64_t)to));
}

static void begin_label(VkCommandBuffer cmd, const VkDebugUtilsLabelEXT *label)
{
    (void)cmd;
    put("node %s\n", label->pLabelName);
}

static void end_label(VkCommandBuffer cmd)
{
    (void)cmd;
}

// ---- the device -------------------------------------------------------------------------------

static void on_log(void *user, tyn_log_level level, const char *message)
{
    fake_vulkan *f = user;
    size_t used = strlen(f->log);
    if (level == TYN_LOG_ERROR) {
        snprintf(f->log + used, sizeof f->log - used, "%s\n", message);
    }
}

fake_vulkan *fake_create(void)
{
    fake = calloc(1, sizeof *fake);
    memset(objects, 0, sizeof objects);
    tyn_device *dev = &fake->dev;
    dev->log = (tyn_log){on_log, fake, TYN_LOG_INFO};
    dev->debug_names = true;
    dev->graphics = dev->depth = true;
    dev->properties.limits.maxStorageBufferRange = 128u << 20;
    dev->properties.limits.maxImageDimension2D = 16384;
    dev->properties.limits.maxImageDimension3D = 2048;
    dev->properties.limits.maxTexelBufferElements = 1u << 27;
    for (int a = 0; a < 3; a++) {
        dev->properties.limits.maxComputeWorkGroupCount[a] = 65535;
        dev->properties.limits.maxComputeWorkGroupSize[a] = a < 2 ? 1024 : 64;
    }
    dev->properties.limits.maxComputeWorkGroupInvocations = 1024;
    dev->properties.limits.maxPerStageDescriptorStorageImages = 32;
    dev->properties.limits.maxPerStageDescriptorStorageBuffers = 32;
    dev->properties.limits.maxPerStageDescriptorSampledImages = 32;
    dev->properties.limits.maxPerStageDescriptorSamplers = 32;
    dev->properties.limits.maxPerStageDescriptorUniformBuffers = 12;
    dev->properties.limits.maxPerStageResources = 128;
    dev->properties.limits.maxPushConstantsSize = 128;
    dev->properties.limits.maxFramebufferWidth = 16384;
    dev->properties.limits.maxFramebufferHeight = 16384;
    dev->properties.limits.maxViewportDimensions[0] = 16384;
    dev->properties.limits.maxViewportDimensions[1] = 16384;
    dev->properties.limits.bufferImageGranularity = 1024;
    dev->memory.memoryTypeCount = 1;
    dev->memory.memoryTypes[0].propertyFlags =
        VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT | VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
        VK_MEMORY_PROPERTY_HOST_COHERENT_BIT | VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
    dev->vk = (tyn_procs){
        .CreateBuffer = create_Buffer,
        .DestroyBuffer = destroy_Buffer,
        .CreateImage = create_Image,
        .DestroyImage = destroy_Image,
        .CreateBufferView = create_BufferView,
        .DestroyBufferView = destroy_BufferView,
        .CreateImageView = create_ImageView,
        .DestroyImageView = destroy_ImageView,
        .CreateDescriptorSetLayout = create_DescriptorSetLayout,
        .DestroyDescriptorSetLayout = destroy_DescriptorSetLayout,
        .CreatePipelineLayout = create_PipelineLayout,
        .DestroyPipelineLayout = destroy_PipelineLayout,
        .CreateShaderModule = create_ShaderModule,
        .DestroyShaderModule = destroy_ShaderModule,
        .CreateDescriptorPool = create_DescriptorPool,
        .DestroyDescriptorPool = destroy_DescriptorPool,
        .CreateQueryPool = create_QueryPool,
        .DestroyQueryPool = destroy_QueryPool,
        .AllocateMemory = create_DeviceMemory,
        .FreeMemory = destroy_DeviceMemory,
        .CreateComputePipelines = create_pipelines,
        .CreateGraphicsPipelines = create_raster_pipelines,
        .DestroyPipeline = destroy_pipeline,
        .SetDebugUtilsObjectNameEXT = set_name,
        .GetBufferMemoryRequirements = buffer_needs,
        .GetImageMemoryRequirements = image_needs,
        .BindBufferMemory = bind_buffer,
        .BindImageMemory = bind_image,
        .MapMemory = map,
        .ResetDescriptorPool = reset_pool,
        .AllocateDescriptorSets = allocate_sets,
        .UpdateDescriptorSets = update_sets,
        .CmdPipelineBarrier2 = barrier,
        .CmdBindPipeline = bind_pipeline,
        .CmdBindDescriptorSets = bind_sets,
        .CmdPushConstants = push_constants,
        .CmdDispatch = dispatch,
        .CmdDispatchIndirect = dispatch_indirect,
        .CmdBeginRendering = begin_rendering,
        .CmdEndRendering = end_rendering,
        .CmdSetViewport = set_viewport,
        .CmdSetScissor = set_scissor,
        .CmdDraw = draw,
        .CmdBindIndexBuffer = bind_indices,
        .CmdDrawIndexed = draw_indexed,
        .CmdCopyBuffer = copy_buffer,
        .CmdCopyBufferToImage = copy_to_image,
        .CmdCopyImageToBuffer = copy_from_image,
        .CmdUpdateBuffer = update_buffer,
        .CmdFillBuffer = fill_buffer,
        .CmdClearColorImage = clear_image,
        .CmdBeginDebugUtilsLabelEXT = begin_label,
        .CmdEndDebugUtilsLabelEXT = end_label,
    };
    fake->dev.compiler = tyn_compiler_create(&fake->dev, 0, (tyn_jobs){0});
    fake_clear(fake);
    return fake;
}

void fake_clear(fake_vulkan *f)
{
    f->used = 0;
    f->dispatches = f->copies = 0;
    f->log[0] = 0;
    put("%s", "");
}

tyn_image fake_image(fake_vulkan *f, const char *name, VkExtent3D extent)
{
    tyn_image image = {.format = VK_FORMAT_R32_SFLOAT, .extent = extent};
    create_Image(f->dev.device, NULL, NULL, &image.image);
    create_ImageView(f->dev.device, NULL, NULL, &image.view);
    tyn_device_name_object(&f->dev, VK_OBJECT_TYPE_IMAGE, (uint64_t)image.image, name);
    return image;
}

void fake_free_image(fake_vulkan *f, tyn_image *image)
{
    destroy_ImageView(f->dev.device, image->view, NULL);
    destroy_Image(f->dev.device, image->image, NULL);
}

void fake_destroy(fake_vulkan **f)
{
    tyn_compiler_destroy(&(*f)->dev.compiler);
    tyn_pipelines_destroy(&(*f)->dev);
    for (int i = 1; i < MAX_OBJECTS; i++) {
        if (objects[i].live) {
            print_message("left: %s %s\n", objects[i].kind, objects[i].name);
        }
    }
    assert_int_equal((*f)->live, 0);
    free((*f)->text);
    free(*f);
    *f = fake = NULL;
}
