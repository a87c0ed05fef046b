// vulkan_tap.c -- see vulkan_tap.h.
#include "vulkan_tap.h"
#include "gpu/procs.h"
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

static PFN_vkGetInstanceProcAddr real_get;

enum { CALLS, CREATES, MEMORY, SUBMITS, WAITS, COMMANDS, FREES, OTHERS, NUM_COUNTS };
static atomic_uint counts[NUM_COUNTS];
static atomic_int live;

// Memory that is allocated.
static struct {
    pthread_mutex_t lock;
    struct {
        VkDeviceMemory memory;
        VkDeviceSize bytes;
    } items[256];
    VkDeviceSize bytes, most;
} memory = {.lock = PTHREAD_MUTEX_INITIALIZER};

static void note_memory(VkDeviceMemory from, VkDeviceMemory to, VkDeviceSize bytes)
{
    const size_t num = sizeof memory.items / sizeof *memory.items;
    pthread_mutex_lock(&memory.lock);
    size_t i = 0;
    while (i < num && memory.items[i].memory != from) {
        i++;
    }
    if (i < num) {
        memory.bytes = memory.bytes - memory.items[i].bytes + bytes;
        memory.most = memory.bytes > memory.most ? memory.bytes : memory.most;
        memory.items[i].memory = to;
        memory.items[i].bytes = bytes;
    } else { // more blocks than a test makes
        abort();
    }
    pthread_mutex_unlock(&memory.lock);
}

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
// One that makes an object at `out`.
#define TAP_MAKES(name, params, args, what)                                                        \
    static PFN_vk##name real_##name;                                                               \
    static VKAPI_ATTR VkResult VKAPI_CALL tap_##name params                                        \
    {                                                                                              \
        if (count_call("vk" #name)) {                                                              \
            leave_rubbish(out);                                                                    \
            return plan.error;                                                                     \
        }                                                                                          \
        count(what);                                                                               \
        const VkResult result = real_##name args;                                                  \
        live += result == VK_SUCCESS;                                                              \
        return result;                                                                             \
    }
// One that waits. What the device was doing is over by the time it is lost.
#define TAP_WAITS(name, params, args)                                                              \
    static PFN_vk##name real_##name;                                                               \
    static VKAPI_ATTR VkResult VKAPI_CALL tap_##name params                                        \
    {                                                                                              \
        const bool fails = count_call("vk" #name);                                                 \
        if (fails && plan.error != VK_ERROR_DEVICE_LOST) {                                         \
            return plan.error;                                                                     \
        }                                                                                          \
        count(WAITS);                                                                              \
        const VkResult result = real_##name args;                                                  \
        return fails ? plan.error : result;                                                        \
    }
// A function that ends an object.
#define TAP_ENDS(name, type)                                                                       \
    static PFN_vk##name real_##name;                                                               \
    static VKAPI_ATTR void VKAPI_CALL tap_##name(VkDevice d, type h,                               \
                                                 const VkAllocationCallbacks *a)                   \
    {                                                                                              \
        count(FREES);                                                                              \
        live -= h != VK_NULL_HANDLE;                                                               \
        real_##name(d, h, a);                                                                      \
    }
// A function that cannot fail.
#define TAP_VOID(name, params, args, what)                                                         \
    static PFN_vk##name real_##name;                                                               \
    static VKAPI_ATTR void VKAPI_CALL tap_##name params                                            \
    {                                                                                              \
        count(what);                                                                               \
        real_##name args;                                                                          \
    }

TAP_MAKES(CreateSampler,
          (VkDevice d, const VkSamplerCreateInfo *i, const VkAllocationCallbacks *a,
           VkSampler *out),
          (d, i, a, out), CREATES)
TAP_MAKES(CreatePipelineCache,
          (VkDevice d, const VkPipelineCacheCreateInfo *i, const VkAllocationCallbacks *a,
           VkPipelineCache *out),
          (d, i, a, out), CREATES)
TAP_MAKES(CreateDescriptorSetLayout,
          (VkDevice d, const VkDescriptorSetLayoutCreateInfo *i, const VkAllocationCallbacks *a,
           VkDescriptorSetLayout *out),
          (d, i, a, out), CREATES)
TAP_MAKES(CreatePipelineLayout,
          (VkDevice d, const VkPipelineLayoutCreateInfo *i, const VkAllocationCallbacks *a,
           VkPipelineLayout *out),
          (d, i, a, out), CREATES)
TAP_MAKES(CreateShaderModule,
          (VkDevice d, const VkShaderModuleCreateInfo *i, const VkAllocationCallbacks *a,
           VkShaderModule *out),
          (d, i, a, out), CREATES)
TAP_MAKES(CreateComputePipelines,
          (VkDevice d, VkPipelineCache c, uint32_t n, const VkComputePipelineCreateInfo *i,
           const VkAllocationCallbacks *a, VkPipeline *out),
          (d, c, n, i, a, out), CREATES)
TAP_MAKES(CreateGraphicsPipelines,
          (VkDevice d, VkPipelineCache c, uint32_t n, const VkGraphicsPipelineCreateInfo *i,
           const VkAllocationCallbacks *a, VkPipeline *out),
          (d, c, n, i, a, out), CREATES)
TAP_MAKES(CreateBuffer,
          (VkDevice d, const VkBufferCreateInfo *i, const VkAllocationCallbacks *a, VkBuffer *out),
          (d, i, a, out), CREATES)
TAP_MAKES(CreateBufferView,
          (VkDevice d, const VkBufferViewCreateInfo *i, const VkAllocationCallbacks *a,
           VkBufferView *out),
          (d, i, a, out), CREATES)
TAP_MAKES(CreateImage,
          (VkDevice d, const VkImageCreateInfo *i, const VkAllocationCallbacks *a, VkImage *out),
          (d, i, a, out), CREATES)
TAP_MAKES(CreateImageView,
          (VkDevice d, const VkImageViewCreateInfo *i, const VkAllocationCallbacks *a,
           VkImageView *out),
          (d, i, a, out), CREATES)
static PFN_vkAllocateMemory real_AllocateMemory;
static VKAPI_ATTR VkResult VKAPI_CALL tap_AllocateMemory(VkDevice d, const VkMemoryAllocateInfo *i,
                                                         const VkAllocationCallbacks *a,
                                                         VkDeviceMemory *out)
{
    if (count_call("vkAllocateMemory")) {
        leave_rubbish(out);
        return plan.error;
    }
    count(MEMORY);
    const VkResult result = real_AllocateMemory(d, i, a, out);
    if (result == VK_SUCCESS) {
        live++;
        note_memory(VK_NULL_HANDLE, *out, i->allocationSize);
    }
    return result;
}
TAP(MapMemory,
    (VkDevice d, VkDeviceMemory m, VkDeviceSize o, VkDeviceSize s, VkMemoryMapFlags f, void **out),
    (d, m, o, s, f, out), leave_rubbish(out), count(MEMORY))
TAP(BindBufferMemory, (VkDevice d, VkBuffer b, VkDeviceMemory m, VkDeviceSize o), (d, b, m, o),
    (void)0, (void)0)
TAP(BindImageMemory, (VkDevice d, VkImage b, VkDeviceMemory m, VkDeviceSize o), (d, b, m, o),
    (void)0, (void)0)
TAP_MAKES(CreateDescriptorPool,
          (VkDevice d, const VkDescriptorPoolCreateInfo *i, const VkAllocationCallbacks *a,
           VkDescriptorPool *out),
          (d, i, a, out), CREATES)
TAP(ResetDescriptorPool, (VkDevice d, VkDescriptorPool p, VkDescriptorPoolResetFlags f), (d, p, f),
    (void)0, (void)0)
TAP(AllocateDescriptorSets,
    (VkDevice d, const VkDescriptorSetAllocateInfo *i, VkDescriptorSet *out), (d, i, out),
    leave_rubbish(out), (void)0)
TAP_MAKES(CreateQueryPool,
          (VkDevice d, const VkQueryPoolCreateInfo *i, const VkAllocationCallbacks *a,
           VkQueryPool *out),
          (d, i, a, out), CREATES)
TAP(GetQueryPoolResults,
    (VkDevice d, VkQueryPool p, uint32_t f, uint32_t n, size_t s, void *out, VkDeviceSize t,
     VkQueryResultFlags w),
    (d, p, f, n, s, out, t, w), (void)0, w &VK_QUERY_RESULT_WAIT_BIT ? count(WAITS) : (void)0)
TAP(GetPipelineCacheData, (VkDevice d, VkPipelineCache c, size_t *s, void *out), (d, c, s, out),
    (void)0, (void)0)
TAP_MAKES(CreateCommandPool,
          (VkDevice d, const VkCommandPoolCreateInfo *i, const VkAllocationCallbacks *a,
           VkCommandPool *out),
          (d, i, a, out), CREATES)
TAP(AllocateCommandBuffers,
    (VkDevice d, const VkCommandBufferAllocateInfo *i, VkCommandBuffer *out), (d, i, out),
    leave_rubbish(out), count(CREATES))
TAP(ResetCommandPool, (VkDevice d, VkCommandPool p, VkCommandPoolResetFlags f), (d, p, f), (void)0,
    (void)0)
TAP(BeginCommandBuffer, (VkCommandBuffer c, const VkCommandBufferBeginInfo *i), (c, i), (void)0,
    (void)0)
TAP(EndCommandBuffer, (VkCommandBuffer c), (c), (void)0, (void)0)
TAP_MAKES(CreateFence,
          (VkDevice d, const VkFenceCreateInfo *i, const VkAllocationCallbacks *a, VkFence *out),
          (d, i, a, out), CREATES)
TAP(ResetFences, (VkDevice d, uint32_t n, const VkFence *f), (d, n, f), (void)0, (void)0)
TAP_WAITS(WaitForFences, (VkDevice d, uint32_t n, const VkFence *f, VkBool32 a, uint64_t t),
          (d, n, f, a, t))
TAP_WAITS(QueueWaitIdle, (VkQueue q), (q))
TAP_WAITS(DeviceWaitIdle, (VkDevice d), (d))
TAP(QueueSubmit2, (VkQueue q, uint32_t n, const VkSubmitInfo2 *s, VkFence f), (q, n, s, f), (void)0,
    count(SUBMITS))

TAP(EnumeratePhysicalDevices, (VkInstance i, uint32_t *n, VkPhysicalDevice *out), (i, n, out),
    (void)0, (void)0)
TAP_MAKES(CreateInstance,
          (const VkInstanceCreateInfo *i, const VkAllocationCallbacks *a, VkInstance *out),
          (i, a, out), CREATES)
TAP_MAKES(CreateDebugUtilsMessengerEXT,
          (VkInstance s, const VkDebugUtilsMessengerCreateInfoEXT *i,
           const VkAllocationCallbacks *a, VkDebugUtilsMessengerEXT *out),
          (s, i, a, out), CREATES)
TAP_MAKES(CreateDevice,
          (VkPhysicalDevice p, const VkDeviceCreateInfo *i, const VkAllocationCallbacks *a,
           VkDevice *out),
          (p, i, a, out), CREATES)

// Of instances and devices: they themselves.
#define TAP_ENDS_OWNER(name, type)                                                                 \
    static PFN_vk##name real_##name;                                                               \
    static VKAPI_ATTR void VKAPI_CALL tap_##name(type h, const VkAllocationCallbacks *a)           \
    {                                                                                              \
        count(FREES);                                                                              \
        live -= h != VK_NULL_HANDLE;                                                               \
        real_##name(h, a);                                                                         \
    }
TAP_ENDS_OWNER(DestroyInstance, VkInstance)
TAP_ENDS_OWNER(DestroyDevice, VkDevice)
static PFN_vkDestroyDebugUtilsMessengerEXT real_DestroyDebugUtilsMessengerEXT;
static VKAPI_ATTR void VKAPI_CALL tap_DestroyDebugUtilsMessengerEXT(VkInstance s,
                                                                    VkDebugUtilsMessengerEXT h,
                                                                    const VkAllocationCallbacks *a)
{
    count(FREES);
    live -= h != VK_NULL_HANDLE;
    real_DestroyDebugUtilsMessengerEXT(s, h, a);
}
TAP_ENDS(DestroySampler, VkSampler)
TAP_ENDS(DestroyPipelineCache, VkPipelineCache)
TAP_ENDS(DestroyDescriptorSetLayout, VkDescriptorSetLayout)
TAP_ENDS(DestroyPipelineLayout, VkPipelineLayout)
TAP_ENDS(DestroyShaderModule, VkShaderModule)
TAP_ENDS(DestroyPipeline, VkPipeline)
TAP_ENDS(DestroyBuffer, VkBuffer)
TAP_ENDS(DestroyBufferView, VkBufferView)
TAP_ENDS(DestroyImage, VkImage)
TAP_ENDS(DestroyImageView, VkImageView)
TAP_ENDS(DestroyDescriptorPool, VkDescriptorPool)
TAP_ENDS(DestroyQueryPool, VkQueryPool)
TAP_ENDS(DestroyCommandPool, VkCommandPool)
TAP_ENDS(DestroyFence, VkFence)
static PFN_vkFreeMemory real_FreeMemory;
static VKAPI_ATTR void VKAPI_CALL tap_FreeMemory(VkDevice d, VkDeviceMemory h,
                                                 const VkAllocationCallbacks *a)
{
    count(FREES);
    if (h) {
        live--;
        note_memory(h, VK_NULL_HANDLE, 0);
    }
    real_FreeMemory(d, h, a);
}

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
TAP_VOID(CmdBindIndexBuffer, (VkCommandBuffer c, VkBuffer b, VkDeviceSize o, VkIndexType t),
         (c, b, o, t), COMMANDS)
TAP_VOID(CmdDrawIndexed,
         (VkCommandBuffer c, uint32_t n, uint32_t i, uint32_t f, int32_t v, uint32_t g),
         (c, n, i, f, v, g), COMMANDS)
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

TAP_VOID(GetPhysicalDeviceProperties2, (VkPhysicalDevice p, VkPhysicalDeviceProperties2 *out),
         (p, out), OTHERS)
TAP_VOID(GetPhysicalDeviceFeatures2, (VkPhysicalDevice p, VkPhysicalDeviceFeatures2 *out), (p, out),
         OTHERS)
TAP_VOID(GetPhysicalDeviceMemoryProperties,
         (VkPhysicalDevice p, VkPhysicalDeviceMemoryProperties *out), (p, out), OTHERS)
TAP_VOID(GetPhysicalDeviceQueueFamilyProperties,
         (VkPhysicalDevice p, uint32_t *n, VkQueueFamilyProperties *out), (p, n, out), OTHERS)
TAP(EnumerateDeviceExtensionProperties,
    (VkPhysicalDevice p, const char *layer, uint32_t *n, VkExtensionProperties *out),
    (p, layer, n, out), *n = 0x7fffffff, (void)0)
TAP_VOID(GetPhysicalDeviceFormatProperties,
         (VkPhysicalDevice p, VkFormat f, VkFormatProperties *out), (p, f, out), OTHERS)
TAP(GetPhysicalDeviceImageFormatProperties,
    (VkPhysicalDevice p, VkFormat f, VkImageType t, VkImageTiling l, VkImageUsageFlags u,
     VkImageCreateFlags c, VkImageFormatProperties *out),
    (p, f, t, l, u, c, out), (void)0, (void)0)
TAP_VOID(GetDeviceQueue, (VkDevice d, uint32_t f, uint32_t i, VkQueue *out), (d, f, i, out), OTHERS)
TAP_VOID(GetBufferMemoryRequirements, (VkDevice d, VkBuffer b, VkMemoryRequirements *out),
         (d, b, out), OTHERS)
TAP_VOID(GetImageMemoryRequirements, (VkDevice d, VkImage i, VkMemoryRequirements *out),
         (d, i, out), OTHERS)
TAP_VOID(UpdateDescriptorSets,
         (VkDevice d, uint32_t n, const VkWriteDescriptorSet *w, uint32_t m,
          const VkCopyDescriptorSet *c),
         (d, n, w, m, c), OTHERS)

// ---- looking functions up ---------------------------------------------------------------------

static PFN_vkGetDeviceProcAddr real_GetDeviceProcAddr;
static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL tap_GetDeviceProcAddr(VkDevice device,
                                                                      const char *name);

static PFN_vkVoidFunction tap_on(const char *name, PFN_vkVoidFunction real)
{
#define X(function)                                                                                \
    if (real && !strcmp(name, "vk" #function)) {                                                   \
        real_##function = (PFN_vk##function)real;                                                  \
        return (PFN_vkVoidFunction)tap_##function;                                                 \
    }
    TYN_INSTANCE_PROCS(X)
    TYN_DEVICE_PROCS(X)
    X(CreateInstance)
    X(CreateDebugUtilsMessengerEXT)
    X(DestroyDebugUtilsMessengerEXT)
#undef X
    return real;
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL tap_GetDeviceProcAddr(VkDevice device,
                                                                      const char *name)
{
    return tap_on(name, real_GetDeviceProcAddr(device, name));
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_instance(VkInstance instance, const char *name)
{
    return tap_on(name, real_get(instance, name));
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

int tap_live(void)
{
    return live;
}

uint64_t tap_most_memory(void)
{
    pthread_mutex_lock(&memory.lock);
    const VkDeviceSize most = memory.most;
    memory.most = memory.bytes;
    pthread_mutex_unlock(&memory.lock);
    return most;
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
