// vulkan_tap.c -- see vulkan_tap.h.
#include "vulkan_tap.h"
#include <stdatomic.h>
#include <string.h>

static PFN_vkGetInstanceProcAddr real_get;
static PFN_vkGetDeviceProcAddr real_get_device;

enum { CALLS, CREATES, MEMORY, SUBMITS, WAITS, COMMANDS, FREES, NUM_COUNTS };
static atomic_uint counts[NUM_COUNTS];

static struct {
    uint32_t call;
    VkResult error;
    bool from_then_on;
    const char *failed;
} plan;

// Counts a call that may fail; true if it has to.
static bool count_call(const char *name)
{
    const uint32_t number = atomic_fetch_add(&counts[CALLS], 1) + 1;
    const bool fails =
        plan.call && (number == plan.call || (plan.from_then_on && number > plan.call));
    if (fails) {
        plan.failed = name;
    }
    return fails;
}

static void count(int what)
{
    atomic_fetch_add(&counts[what], 1);
}

// Of handles and pointers.
static void leave_rubbish(void *out)
{
    memset(out, 0xdb, sizeof(void *));
}

// A function that may fail. Once it does not, `counted` is run, and the real one.
#define TAP(name, params, args, rubbish, counted)                                                  \
    static PFN_vk##name real_##name;                                                               \
    static VKAPI_ATTR VkResult VKAPI_CALL tap_##name params                                        \
    {                                                                                              \
        if (count_call("vk" #name)) {                                                              \
            rubbish;                                                                               \
            return plan.error;                                                                     \
        }                                                                                          \
        counted;                                                                                   \
        return real_##name args;                                                                   \
    }
// A function that cannot fail.
#define TAP_VOID(name, params, args, what)                                                         \
    static PFN_vk##name real_##name;                                                               \
    static VKAPI_ATTR void VKAPI_CALL tap_##name params                                            \
    {                                                                                              \
        count(what);                                                                               \
        real_##name args;                                                                          \
    }

TAP(CreateSampler,
    (VkDevice d, const VkSamplerCreateInfo *i, const VkAllocationCallbacks *a, VkSampler *out),
    (d, i, a, out), leave_rubbish(out), count(CREATES))
TAP(CreatePipelineCache,
    (VkDevice d, const VkPipelineCacheCreateInfo *i, const VkAllocationCallbacks *a,
     VkPipelineCache *out),
    (d, i, a, out), leave_rubbish(out), count(CREATES))
TAP(CreateDescriptorSetLayout,
    (VkDevice d, const VkDescriptorSetLayoutCreateInfo *i, const VkAllocationCallbacks *a,
     VkDescriptorSetLayout *out),
    (d, i, a, out), leave_rubbish(out), count(CREATES))
TAP(CreatePipelineLayout,
    (VkDevice d, const VkPipelineLayoutCreateInfo *i, const VkAllocationCallbacks *a,
     VkPipelineLayout *out),
    (d, i, a, out), leave_rubbish(out), count(CREATES))
TAP(CreateShaderModule,
    (VkDevice d, const VkShaderModuleCreateInfo *i, const VkAllocationCallbacks *a,
     VkShaderModule *out),
    (d, i, a, out), leave_rubbish(out), count(CREATES))
TAP(CreateComputePipelines,
    (VkDevice d, VkPipelineCache c, uint32_t n, const VkComputePipelineCreateInfo *i,
     const VkAllocationCallbacks *a, VkPipeline *out),
    (d, c, n, i, a, out), *out = VK_NULL_HANDLE, count(CREATES))
TAP(CreateGraphicsPipelines,
    (VkDevice d, VkPipelineCache c, uint32_t n, const VkGraphicsPipelineCreateInfo *i,
     const VkAllocationCallbacks *a, VkPipeline *out),
    (d, c, n, i, a, out), *out = VK_NULL_HANDLE, count(CREATES))
TAP(CreateBuffer,
    (VkDevice d, const VkBufferCreateInfo *i, const VkAllocationCallbacks *a, VkBuffer *out),
    (d, i, a, out), leave_rubbish(out), count(CREATES))
TAP(CreateBufferView,
    (VkDevice d, const VkBufferViewCreateInfo *i, const VkAllocationCallbacks *a,
     VkBufferView *out),
    (d, i, a, out), leave_rubbish(out), count(CREATES))
TAP(CreateImage,
    (VkDevice d, const VkImageCreateInfo *i, const VkAllocationCallbacks *a, VkImage *out),
    (d, i, a, out), leave_rubbish(out), count(CREATES))
TAP(CreateImageView,
    (VkDevice d, const VkImageViewCreateInfo *i, const VkAllocationCallbacks *a, VkImageView *out),
    (d, i, a, out), leave_rubbish(out), count(CREATES))
TAP(AllocateMemory,
    (VkDevice d, const VkMemoryAllocateInfo *i, const VkAllocationCallbacks *a,
     VkDeviceMemory *out),
    (d, i, a, out), leave_rubbish(out), count(MEMORY))
TAP(MapMemory,
    (VkDevice d, VkDeviceMemory m, VkDeviceSize o, VkDeviceSize s, VkMemoryMapFlags f, void **out),
    (d, m, o, s, f, out), leave_rubbish(out), count(MEMORY))
TAP(BindBufferMemory, (VkDevice d, VkBuffer b, VkDeviceMemory m, VkDeviceSize o), (d, b, m, o),
    (void)0, (void)0)
TAP(BindImageMemory, (VkDevice d, VkImage b, VkDeviceMemory m, VkDeviceSize o), (d, b, m, o),
    (void)0, (void)0)
TAP(InvalidateMappedMemoryRanges, (VkDevice d, uint32_t n, const VkMappedMemoryRange *r), (d, n, r),
    (void)0, (void)0)
TAP(CreateDescriptorPool,
    (VkDevice d, const VkDescriptorPoolCreateInfo *i, const VkAllocationCallbacks *a,
     VkDescriptorPool *out),
    (d, i, a, out), leave_rubbish(out), count(CREATES))
TAP(ResetDescriptorPool, (VkDevice d, VkDescriptorPool p, VkDescriptorPoolResetFlags f), (d, p, f),
    (void)0, (void)0)
TAP(AllocateDescriptorSets,
    (VkDevice d, const VkDescriptorSetAllocateInfo *i, VkDescriptorSet *out), (d, i, out),
    leave_rubbish(out), (void)0)
TAP(CreateQueryPool,
    (VkDevice d, const VkQueryPoolCreateInfo *i, const VkAllocationCallbacks *a, VkQueryPool *out),
    (d, i, a, out), leave_rubbish(out), count(CREATES))
TAP(GetQueryPoolResults,
    (VkDevice d, VkQueryPool p, uint32_t f, uint32_t n, size_t s, void *out, VkDeviceSize t,
     VkQueryResultFlags w),
    (d, p, f, n, s, out, t, w), (void)0, w &VK_QUERY_RESULT_WAIT_BIT ? count(WAITS) : (void)0)
TAP(GetPipelineCacheData, (VkDevice d, VkPipelineCache c, size_t *s, void *out), (d, c, s, out),
    (void)0, (void)0)
TAP(CreateCommandPool,
    (VkDevice d, const VkCommandPoolCreateInfo *i, const VkAllocationCallbacks *a,
     VkCommandPool *out),
    (d, i, a, out), leave_rubbish(out), count(CREATES))
TAP(AllocateCommandBuffers,
    (VkDevice d, const VkCommandBufferAllocateInfo *i, VkCommandBuffer *out), (d, i, out),
    leave_rubbish(out), count(CREATES))
TAP(ResetCommandPool, (VkDevice d, VkCommandPool p, VkCommandPoolResetFlags f), (d, p, f), (void)0,
    (void)0)
TAP(BeginCommandBuffer, (VkCommandBuffer c, const VkCommandBufferBeginInfo *i), (c, i), (void)0,
    (void)0)
TAP(EndCommandBuffer, (VkCommandBuffer c), (c), (void)0, (void)0)
TAP(CreateFence,
    (VkDevice d, const VkFenceCreateInfo *i, const VkAllocationCallbacks *a, VkFence *out),
    (d, i, a, out), leave_rubbish(out), count(CREATES))
TAP(ResetFences, (VkDevice d, uint32_t n, const VkFence *f), (d, n, f), (void)0, (void)0)
TAP(WaitForFences, (VkDevice d, uint32_t n, const VkFence *f, VkBool32 a, uint64_t t),
    (d, n, f, a, t), (void)0, count(WAITS))
TAP(QueueWaitIdle, (VkQueue q), (q), (void)0, count(WAITS))
TAP(DeviceWaitIdle, (VkDevice d), (d), (void)0, count(WAITS))
TAP(QueueSubmit2, (VkQueue q, uint32_t n, const VkSubmitInfo2 *s, VkFence f), (q, n, s, f), (void)0,
    count(SUBMITS))

TAP_VOID(DestroySampler, (VkDevice d, VkSampler h, const VkAllocationCallbacks *a), (d, h, a),
         FREES)
TAP_VOID(DestroyPipelineCache, (VkDevice d, VkPipelineCache h, const VkAllocationCallbacks *a),
         (d, h, a), FREES)
TAP_VOID(DestroyDescriptorSetLayout,
         (VkDevice d, VkDescriptorSetLayout h, const VkAllocationCallbacks *a), (d, h, a), FREES)
TAP_VOID(DestroyPipelineLayout, (VkDevice d, VkPipelineLayout h, const VkAllocationCallbacks *a),
         (d, h, a), FREES)
TAP_VOID(DestroyShaderModule, (VkDevice d, VkShaderModule h, const VkAllocationCallbacks *a),
         (d, h, a), FREES)
TAP_VOID(DestroyPipeline, (VkDevice d, VkPipeline h, const VkAllocationCallbacks *a), (d, h, a),
         FREES)
TAP_VOID(DestroyBuffer, (VkDevice d, VkBuffer h, const VkAllocationCallbacks *a), (d, h, a), FREES)
TAP_VOID(DestroyBufferView, (VkDevice d, VkBufferView h, const VkAllocationCallbacks *a), (d, h, a),
         FREES)
TAP_VOID(DestroyImage, (VkDevice d, VkImage h, const VkAllocationCallbacks *a), (d, h, a), FREES)
TAP_VOID(DestroyImageView, (VkDevice d, VkImageView h, const VkAllocationCallbacks *a), (d, h, a),
         FREES)
TAP_VOID(DestroyDescriptorPool, (VkDevice d, VkDescriptorPool h, const VkAllocationCallbacks *a),
         (d, h, a), FREES)
TAP_VOID(DestroyQueryPool, (VkDevice d, VkQueryPool h, const VkAllocationCallbacks *a), (d, h, a),
         FREES)
TAP_VOID(DestroyCommandPool, (VkDevice d, VkCommandPool h, const VkAllocationCallbacks *a),
         (d, h, a), FREES)
TAP_VOID(DestroyFence, (VkDevice d, VkFence h, const VkAllocationCallbacks *a), (d, h, a), FREES)
TAP_VOID(FreeMemory, (VkDevice d, VkDeviceMemory h, const VkAllocationCallbacks *a), (d, h, a),
         FREES)

TAP_VOID(CmdResetQueryPool, (VkCommandBuffer c, VkQueryPool p, uint32_t f, uint32_t n),
         (c, p, f, n), COMMANDS)
TAP_VOID(CmdWriteTimestamp2,
         (VkCommandBuffer c, VkPipelineStageFlags2 s, VkQueryPool p, uint32_t n), (c, s, p, n),
         COMMANDS)
TAP_VOID(CmdPipelineBarrier2, (VkCommandBuffer c, const VkDependencyInfo *i), (c, i), COMMANDS)
TAP_VOID(CmdBindPipeline, (VkCommandBuffer c, VkPipelineBindPoint b, VkPipeline p), (c, b, p),
         COMMANDS)
TAP_VOID(CmdBindDescriptorSets,
         (VkCommandBuffer c, VkPipelineBindPoint b, VkPipelineLayout l, uint32_t f, uint32_t n,
          const VkDescriptorSet *s, uint32_t m, const uint32_t *o),
         (c, b, l, f, n, s, m, o), COMMANDS)
TAP_VOID(CmdPushConstants,
         (VkCommandBuffer c, VkPipelineLayout l, VkShaderStageFlags s, uint32_t o, uint32_t n,
          const void *v),
         (c, l, s, o, n, v), COMMANDS)
TAP_VOID(CmdDispatch, (VkCommandBuffer c, uint32_t x, uint32_t y, uint32_t z), (c, x, y, z),
         COMMANDS)
TAP_VOID(CmdDispatchIndirect, (VkCommandBuffer c, VkBuffer b, VkDeviceSize o), (c, b, o), COMMANDS)
TAP_VOID(CmdBeginRendering, (VkCommandBuffer c, const VkRenderingInfo *i), (c, i), COMMANDS)
TAP_VOID(CmdEndRendering, (VkCommandBuffer c), (c), COMMANDS)
TAP_VOID(CmdSetViewport, (VkCommandBuffer c, uint32_t f, uint32_t n, const VkViewport *v),
         (c, f, n, v), COMMANDS)
TAP_VOID(CmdSetScissor, (VkCommandBuffer c, uint32_t f, uint32_t n, const VkRect2D *v),
         (c, f, n, v), COMMANDS)
TAP_VOID(CmdDraw, (VkCommandBuffer c, uint32_t v, uint32_t i, uint32_t f, uint32_t g),
         (c, v, i, f, g), COMMANDS)
TAP_VOID(CmdCopyBuffer,
         (VkCommandBuffer c, VkBuffer s, VkBuffer t, uint32_t n, const VkBufferCopy *r),
         (c, s, t, n, r), COMMANDS)
TAP_VOID(CmdCopyBufferToImage,
         (VkCommandBuffer c, VkBuffer s, VkImage t, VkImageLayout l, uint32_t n,
          const VkBufferImageCopy *r),
         (c, s, t, l, n, r), COMMANDS)
TAP_VOID(CmdCopyImageToBuffer,
         (VkCommandBuffer c, VkImage s, VkImageLayout l, VkBuffer t, uint32_t n,
          const VkBufferImageCopy *r),
         (c, s, l, t, n, r), COMMANDS)
TAP_VOID(CmdUpdateBuffer,
         (VkCommandBuffer c, VkBuffer b, VkDeviceSize o, VkDeviceSize n, const void *v),
         (c, b, o, n, v), COMMANDS)
TAP_VOID(CmdFillBuffer, (VkCommandBuffer c, VkBuffer b, VkDeviceSize o, VkDeviceSize n, uint32_t v),
         (c, b, o, n, v), COMMANDS)
TAP_VOID(CmdClearColorImage,
         (VkCommandBuffer c, VkImage b, VkImageLayout l, const VkClearColorValue *v, uint32_t n,
          const VkImageSubresourceRange *r),
         (c, b, l, v, n, r), COMMANDS)

// ---- looking functions up ---------------------------------------------------------------------

#define TAPPED(X)                                                                                  \
    X(CreateSampler)                                                                               \
    X(CreatePipelineCache)                                                                         \
    X(CreateDescriptorSetLayout)                                                                   \
    X(CreatePipelineLayout)                                                                        \
    X(CreateShaderModule)                                                                          \
    X(CreateComputePipelines)                                                                      \
    X(CreateGraphicsPipelines)                                                                     \
    X(CreateBuffer)                                                                                \
    X(CreateBufferView)                                                                            \
    X(CreateImage)                                                                                 \
    X(CreateImageView)                                                                             \
    X(AllocateMemory)                                                                              \
    X(MapMemory)                                                                                   \
    X(BindBufferMemory)                                                                            \
    X(BindImageMemory)                                                                             \
    X(InvalidateMappedMemoryRanges)                                                                \
    X(CreateDescriptorPool)                                                                        \
    X(ResetDescriptorPool)                                                                         \
    X(AllocateDescriptorSets)                                                                      \
    X(CreateQueryPool)                                                                             \
    X(GetQueryPoolResults)                                                                         \
    X(GetPipelineCacheData)                                                                        \
    X(CreateCommandPool)                                                                           \
    X(AllocateCommandBuffers)                                                                      \
    X(ResetCommandPool)                                                                            \
    X(BeginCommandBuffer)                                                                          \
    X(EndCommandBuffer)                                                                            \
    X(CreateFence)                                                                                 \
    X(ResetFences)                                                                                 \
    X(WaitForFences)                                                                               \
    X(QueueWaitIdle)                                                                               \
    X(DeviceWaitIdle)                                                                              \
    X(QueueSubmit2)                                                                                \
    X(DestroySampler)                                                                              \
    X(DestroyPipelineCache)                                                                        \
    X(DestroyDescriptorSetLayout)                                                                  \
    X(DestroyPipelineLayout)                                                                       \
    X(DestroyShaderModule)                                                                         \
    X(DestroyPipeline)                                                                             \
    X(DestroyBuffer)                                                                               \
    X(DestroyBufferView)                                                                           \
    X(DestroyImage)                                                                                \
    X(DestroyImageView)                                                                            \
    X(DestroyDescriptorPool)                                                                       \
    X(DestroyQueryPool)                                                                            \
    X(DestroyCommandPool)                                                                          \
    X(DestroyFence)                                                                                \
    X(FreeMemory)                                                                                  \
    X(CmdResetQueryPool)                                                                           \
    X(CmdWriteTimestamp2)                                                                          \
    X(CmdPipelineBarrier2)                                                                         \
    X(CmdBindPipeline)                                                                             \
    X(CmdBindDescriptorSets)                                                                       \
    X(CmdPushConstants)                                                                            \
    X(CmdDispatch)                                                                                 \
    X(CmdDispatchIndirect)                                                                         \
    X(CmdBeginRendering)                                                                           \
    X(CmdEndRendering)                                                                             \
    X(CmdSetViewport)                                                                              \
    X(CmdSetScissor)                                                                               \
    X(CmdDraw)                                                                                     \
    X(CmdCopyBuffer)                                                                               \
    X(CmdCopyBufferToImage)                                                                        \
    X(CmdCopyImageToBuffer)                                                                        \
    X(CmdUpdateBuffer)                                                                             \
    X(CmdFillBuffer)                                                                               \
    X(CmdClearColorImage)

static PFN_vkVoidFunction tap_on(const char *name, PFN_vkVoidFunction real)
{
#define X(function)                                                                                \
    if (real && !strcmp(name, "vk" #function)) {                                                   \
        real_##function = (PFN_vk##function)real;                                                  \
        return (PFN_vkVoidFunction)tap_##function;                                                 \
    }
    TAPPED(X)
#undef X
    return real;
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_device(VkDevice device, const char *name)
{
    return tap_on(name, real_get_device(device, name));
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_instance(VkInstance instance, const char *name)
{
    PFN_vkVoidFunction real = real_get(instance, name);
    if (real && !strcmp(name, "vkGetDeviceProcAddr")) {
        real_get_device = (PFN_vkGetDeviceProcAddr)real;
        return (PFN_vkVoidFunction)get_device;
    }
    return tap_on(name, real);
}

PFN_vkGetInstanceProcAddr tap_open(PFN_vkGetInstanceProcAddr real)
{
    real_get = real;
    tap_clear();
    return get_instance;
}

tap_counts tap_since(void)
{
    return (tap_counts){counts[CALLS], counts[CREATES],  counts[MEMORY], counts[SUBMITS],
                        counts[WAITS], counts[COMMANDS], counts[FREES]};
}

void tap_clear(void)
{
    for (int i = 0; i < NUM_COUNTS; i++) {
        counts[i] = 0;
    }
    plan.call = 0;
    plan.failed = "";
}

void tap_fail(uint32_t call, VkResult error, bool from_then_on)
{
    plan.call = call;
    plan.error = error;
    plan.from_then_on = from_then_on;
    plan.failed = "";
}

const char *tap_failed(void)
{
    return plan.failed;
}
