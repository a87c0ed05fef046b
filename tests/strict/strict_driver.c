// strict_driver.c -- a Vulkan driver over the software one that has least limits, no optional feature, and memory of its own as cards have.
//
// The loader finds it by VK_DRIVER_FILES or VK_ADD_DRIVER_FILES=strict_driver.json. It is below the validation layer, which therefore
// refuses calls beyond what it reports; the few things that validation does not look at are refused here. STRICT_DRIVER=LIST says
// what more it does otherwise than the software device (rounding.h), for example STRICT_DRIVER=weights,denormals; "wide" leaves out limits.
#include "rounding.h"
#include <vulkan/vk_icd.h>
#include <vulkan/vulkan_core.h>
#include <dlfcn.h>
#include <pthread.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#if defined __SSE__
#include <xmmintrin.h>
#endif

#define EXPORT __attribute__((visibility("default")))

static struct {
    pthread_once_t once;
    void *library;
    PFN_vkGetInstanceProcAddr get;
    PFN_vkGetInstanceProcAddr get_physical;
    PFN_vkNegotiateLoaderICDInterfaceVersion negotiate;
    rounding_kinds kinds;
    bool wide; // limits are those of the driver below
} below = {.once = PTHREAD_ONCE_INIT};

// A word that is none would leave tests as they are on the driver below.
static void check_words(const char *list)
{
    static const char *const words[] = {
        "wide",
        "weights",
        "order",
        "fused",
        "functions",
#if defined __SSE__
        "denormals"
#endif
    };
    while (*list) {
        const size_t length = strcspn(list, ",");
        bool known = false;
        for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
            known = known || (strlen(words[i]) == length && !strncmp(words[i], list, length));
        }
        if (!known) {
            fprintf(stderr,
                    "strict driver: STRICT_DRIVER has '%.*s', which is no word for this machine\n",
                    (int)length, list);
            exit(2);
        }
        list += length + (list[length] == ',');
    }
}

static void open_below(void)
{
    const char *file = getenv("STRICT_DRIVER_BELOW");
    below.library = dlopen(file ? file : "libvulkan_lvp.so", RTLD_NOW | RTLD_LOCAL);
    if (below.library) {
        *(void **)&below.get = dlsym(below.library, "vk_icdGetInstanceProcAddr");
        *(void **)&below.get_physical = dlsym(below.library, "vk_icdGetPhysicalDeviceProcAddr");
        *(void **)&below.negotiate =
            dlsym(below.library, "vk_icdNegotiateLoaderICDInterfaceVersion");
    }
    const char *list = getenv("STRICT_DRIVER");
    check_words(list ? list : "");
    below.wide = list && strstr(list, "wide");
    below.kinds = (rounding_kinds){
        .weights = list && strstr(list, "weights"),
        .order = list && strstr(list, "order"),
        .fused = list && strstr(list, "fused"),
        .functions = list && strstr(list, "functions"),
        .denormals = list && strstr(list, "denormals"),
    };
}

static void refuse(const char *what, unsigned long long got, unsigned long long most)
{
    fprintf(stderr, "strict driver: %s is %llu; at most %llu\n", what, got, most);
}

// ---- limits -------------------------------------------------------------------------------------

// The least that Vulkan 1.3 asks of a device (specification, "Required Limits"); of alignments the most. Three are wider, as
// no device that draws and computes with Vulkan 1.3 on a desktop has less (profile VP_KHR_roadmap_2022), and no pass has a fallback.
static void narrow_limits(VkPhysicalDeviceLimits *l)
{
    const VkPhysicalDeviceLimits real = *l;
    *l = (VkPhysicalDeviceLimits){
        .maxImageDimension1D = 4096,
        .maxImageDimension2D = 4096,
        .maxImageDimension3D = 256,
        .maxImageDimensionCube = 4096,
        .maxImageArrayLayers = 256,
        .maxTexelBufferElements = 1u << 25, // wider: 65536; all words of the largest storage buffer
        .maxUniformBufferRange = 65536,     // wider: 16384; lists of lights take 42 KiB
        .maxStorageBufferRange = 1u << 27,
        .maxPushConstantsSize = 128,
        .maxMemoryAllocationCount = 4096,
        .maxSamplerAllocationCount = 4000,
        .bufferImageGranularity = 131072,
        .maxBoundDescriptorSets = 4,
        .maxPerStageDescriptorSamplers = 64, // wider, as the next ones: 16
        .maxPerStageDescriptorUniformBuffers = 12,
        .maxPerStageDescriptorStorageBuffers = 30, // 4
        .maxPerStageDescriptorSampledImages = 200, // 16
        .maxPerStageDescriptorStorageImages = 16,  // 4
        .maxPerStageDescriptorInputAttachments = 4,
        .maxPerStageResources = 128,
        .maxDescriptorSetSamplers = 96,
        .maxDescriptorSetUniformBuffers = 72,
        .maxDescriptorSetUniformBuffersDynamic = 8,
        .maxDescriptorSetStorageBuffers = 24,
        .maxDescriptorSetStorageBuffersDynamic = 4,
        .maxDescriptorSetSampledImages = 96,
        .maxDescriptorSetStorageImages = 24,
        .maxDescriptorSetInputAttachments = 4,
        .maxVertexInputAttributes = 16,
        .maxVertexInputBindings = 16,
        .maxVertexInputAttributeOffset = 2047,
        .maxVertexInputBindingStride = 2048,
        .maxVertexOutputComponents = 64,
        .maxFragmentInputComponents = 64,
        .maxFragmentOutputAttachments = 4,
        .maxFragmentCombinedOutputResources = 4,
        .maxComputeSharedMemorySize = 16384,
        .maxComputeWorkGroupCount = {65535, 65535, 65535},
        .maxComputeWorkGroupInvocations = 256,
        .maxComputeWorkGroupSize = {256, 128, 64},
        .subPixelPrecisionBits = 4,
        .subTexelPrecisionBits = ROUNDING_TEXEL_BITS,
        .mipmapPrecisionBits = 4,
        .maxDrawIndexedIndexValue = (1u << 24) - 1,
        .maxDrawIndirectCount = 1,
        .maxSamplerLodBias = 2,
        .maxSamplerAnisotropy = 1,
        .maxViewports = 1,
        .maxViewportDimensions = {4096, 4096},
        .viewportBoundsRange = {-8192, 8191},
        .minMemoryMapAlignment = 64,
        .minTexelBufferOffsetAlignment = 256,
        .minUniformBufferOffsetAlignment = 256,
        .minStorageBufferOffsetAlignment = 256,
        .minTexelOffset = -8,
        .maxTexelOffset = 7,
        .maxFramebufferWidth = 4096,
        .maxFramebufferHeight = 4096,
        .maxFramebufferLayers = 256,
        .framebufferColorSampleCounts = VK_SAMPLE_COUNT_1_BIT | VK_SAMPLE_COUNT_4_BIT,
        .framebufferDepthSampleCounts = VK_SAMPLE_COUNT_1_BIT | VK_SAMPLE_COUNT_4_BIT,
        .framebufferStencilSampleCounts = VK_SAMPLE_COUNT_1_BIT | VK_SAMPLE_COUNT_4_BIT,
        .framebufferNoAttachmentsSampleCounts = VK_SAMPLE_COUNT_1_BIT | VK_SAMPLE_COUNT_4_BIT,
        .maxColorAttachments = 4,
        .sampledImageColorSampleCounts = VK_SAMPLE_COUNT_1_BIT | VK_SAMPLE_COUNT_4_BIT,
        .sampledImageIntegerSampleCounts = VK_SAMPLE_COUNT_1_BIT,
        .sampledImageDepthSampleCounts = VK_SAMPLE_COUNT_1_BIT | VK_SAMPLE_COUNT_4_BIT,
        .sampledImageStencilSampleCounts = VK_SAMPLE_COUNT_1_BIT | VK_SAMPLE_COUNT_4_BIT,
        .storageImageSampleCounts = VK_SAMPLE_COUNT_1_BIT,
        .maxSampleMaskWords = 1,
        .timestampComputeAndGraphics = VK_FALSE,
        .timestampPeriod = real.timestampPeriod,
        .discreteQueuePriorities = 2,
        .pointSizeRange = {1, 1},
        .lineWidthRange = {1, 1},
        .optimalBufferCopyOffsetAlignment = 256,
        .optimalBufferCopyRowPitchAlignment = 256,
        .nonCoherentAtomSize = 256,
    };
}

static void narrow_properties(VkPhysicalDeviceProperties *p)
{
    snprintf(p->deviceName, sizeof p->deviceName, "%s device", below.wide ? "rounding" : "strict");
    p->deviceType = VK_PHYSICAL_DEVICE_TYPE_OTHER; // bounds of tests are not judged by it
    p->pipelineCacheUUID[0] ^= 0xff;
    if (below.wide) {
        p->limits.subTexelPrecisionBits = ROUNDING_TEXEL_BITS;
    } else {
        narrow_limits(&p->limits);
    }
}

// ---- features -----------------------------------------------------------------------------------

// Vulkan 1.3 promises these (specification, "Feature Requirements"), but for those that the library requires besides.
static const VkPhysicalDeviceFeatures features10 = {
    .robustBufferAccess = VK_TRUE,
    .shaderStorageImageExtendedFormats = VK_TRUE, // tyn_requirements_get
};
static const VkPhysicalDeviceVulkan11Features features11 = {.multiview = VK_TRUE};
static const VkPhysicalDeviceVulkan12Features features12 = {
    .scalarBlockLayout = VK_TRUE, // tyn_requirements_get
    .imagelessFramebuffer = VK_TRUE,
    .uniformBufferStandardLayout = VK_TRUE,
    .shaderSubgroupExtendedTypes = VK_TRUE,
    .separateDepthStencilLayouts = VK_TRUE,
    .hostQueryReset = VK_TRUE,
    .timelineSemaphore = VK_TRUE,
    .bufferDeviceAddress = VK_TRUE,
    .vulkanMemoryModel = VK_TRUE,
    .vulkanMemoryModelDeviceScope = VK_TRUE,
    .subgroupBroadcastDynamicId = VK_TRUE,
};
static const VkPhysicalDeviceVulkan13Features features13 = {
    .robustImageAccess = VK_TRUE,
    .inlineUniformBlock = VK_TRUE,
    .pipelineCreationCacheControl = VK_TRUE,
    .privateData = VK_TRUE,
    .shaderDemoteToHelperInvocation = VK_TRUE,
    .shaderTerminateInvocation = VK_TRUE,
    .subgroupSizeControl = VK_TRUE,
    .computeFullSubgroups = VK_TRUE,
    .synchronization2 = VK_TRUE,
    .shaderZeroInitializeWorkgroupMemory = VK_TRUE,
    .dynamicRendering = VK_TRUE,
    .shaderIntegerDotProduct = VK_TRUE,
    .maintenance4 = VK_TRUE,
};

// Where a struct's switches begin, how many there are, and which stay.
typedef struct switches {
    const char *name;
    VkStructureType type;
    size_t at, bytes;
    const void *kept;
} switches;

#define SWITCHES(structure, enumerator, first, last, kept)                                         \
    {                                                                                              \
#structure, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_##enumerator, offsetof(structure, first),    \
            offsetof(structure, last) + sizeof(VkBool32) - offsetof(structure, first), kept        \
    }
static const switches all_switches[] = {
    SWITCHES(VkPhysicalDeviceFeatures2, FEATURES_2, features, features.inheritedQueries,
             &features10),
    SWITCHES(VkPhysicalDeviceVulkan11Features, VULKAN_1_1_FEATURES, storageBuffer16BitAccess,
             shaderDrawParameters, &features11.storageBuffer16BitAccess),
    SWITCHES(VkPhysicalDeviceVulkan12Features, VULKAN_1_2_FEATURES, samplerMirrorClampToEdge,
             subgroupBroadcastDynamicId, &features12.samplerMirrorClampToEdge),
    SWITCHES(VkPhysicalDeviceVulkan13Features, VULKAN_1_3_FEATURES, robustImageAccess, maintenance4,
             &features13.robustImageAccess),
};
enum { NUM_SWITCHES = sizeof all_switches / sizeof *all_switches };

static const switches *find_switches(VkStructureType type)
{
    for (size_t i = 0; i < NUM_SWITCHES; i++) {
        if (all_switches[i].type == type) {
            return &all_switches[i];
        }
    }
    return NULL;
}

static void narrow_switches(VkBool32 *at, const VkBool32 *kept, size_t bytes)
{
    for (size_t i = 0; i < bytes / sizeof *at; i++) {
        at[i] = at[i] && kept[i];
    }
}

// False, and said, where a feature is asked for that was not reported.
static bool check_switches(const char *name, const VkBool32 *at, const VkBool32 *kept, size_t bytes)
{
    for (size_t i = 0; i < bytes / sizeof *at; i++) {
        if (at[i] && !kept[i]) {
            fprintf(
                stderr,
                "strict driver: vkCreateDevice enables feature %zu of %s; it was not reported\n", i,
                name);
            return false;
        }
    }
    return true;
}

static bool check_features(const VkDeviceCreateInfo *info)
{
    bool good = !info->pEnabledFeatures ||
                check_switches("VkPhysicalDeviceFeatures", (const VkBool32 *)info->pEnabledFeatures,
                               (const VkBool32 *)&features10, sizeof features10);
    for (const VkBaseInStructure *s = info->pNext; s; s = s->pNext) {
        const switches *known = find_switches(s->sType);
        good = good && (!known ||
                        check_switches(known->name, (const VkBool32 *)((const char *)s + known->at),
                                       known->kept, known->bytes));
    }
    return good;
}

// ---- memory: the first type as a card's own, the second as the host's -------------------------------

enum { OWN, HOST, NUM_TYPES };

static VkDeviceMemory own[4096]; // which must not be mapped
static pthread_mutex_t own_lock = PTHREAD_MUTEX_INITIALIZER;

static bool note_own(VkDeviceMemory from, VkDeviceMemory to)
{
    pthread_mutex_lock(&own_lock);
    size_t i = 0;
    while (i < sizeof own / sizeof *own && own[i] != from) {
        i++;
    }
    const bool found = i < sizeof own / sizeof *own;
    if (found) {
        own[i] = to;
    }
    pthread_mutex_unlock(&own_lock);
    return found;
}

static void split_memory(VkPhysicalDeviceMemoryProperties *m)
{
    const VkDeviceSize bytes = m->memoryHeaps[0].size;
    *m = (VkPhysicalDeviceMemoryProperties){
        .memoryTypeCount = NUM_TYPES,
        .memoryTypes = {{VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0},
                        {VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT,
                         1}},
        .memoryHeapCount = 2,
        .memoryHeaps = {{bytes, VK_MEMORY_HEAP_DEVICE_LOCAL_BIT}, {bytes, 0}},
    };
}

// Buffers are allowed in both, images in the card's own. Alignments are as large as cards' are.
static void split_requirements(VkMemoryRequirements *r, bool buffer)
{
    const VkDeviceSize least = buffer ? 256 : 65536;
    r->memoryTypeBits = buffer ? 1u << OWN | 1u << HOST : 1u << OWN;
    r->alignment = r->alignment > least ? r->alignment : least;
    r->size = (r->size + r->alignment - 1) / r->alignment * r->alignment;
}

// ---- functions ----------------------------------------------------------------------------------

#define BELOW(name) static PFN_vk##name real_##name

// Threads begin with their maker's arithmetic: the driver's are made with denormals flushed, the caller keeps its own.
static unsigned flush_begin(void)
{
    unsigned before = 0;
#if defined __SSE__
    before = _mm_getcsr();
    _mm_setcsr(below.kinds.denormals ? before | 0x8040u
                                     : before); // flush to zero, denormals are zero
#endif
    return before;
}

static void flush_end(unsigned before)
{
#if defined __SSE__
    _mm_setcsr(before);
#else
    (void)before;
#endif
}

BELOW(CreateInstance);
static VKAPI_ATTR VkResult VKAPI_CALL create_instance(const VkInstanceCreateInfo *info,
                                                      const VkAllocationCallbacks *a,
                                                      VkInstance *out)
{
    const unsigned before = flush_begin();
    const VkResult result = real_CreateInstance(info, a, out);
    flush_end(before);
    return result;
}

BELOW(EnumeratePhysicalDevices);
static VKAPI_ATTR VkResult VKAPI_CALL enumerate_physical_devices(VkInstance instance,
                                                                 uint32_t *count,
                                                                 VkPhysicalDevice *out)
{
    const unsigned before = flush_begin();
    const VkResult result = real_EnumeratePhysicalDevices(instance, count, out);
    flush_end(before);
    return result;
}

BELOW(GetPhysicalDeviceProperties);
static VKAPI_ATTR void VKAPI_CALL get_properties(VkPhysicalDevice d, VkPhysicalDeviceProperties *p)
{
    real_GetPhysicalDeviceProperties(d, p);
    narrow_properties(p);
}

BELOW(GetPhysicalDeviceProperties2);
static VKAPI_ATTR void VKAPI_CALL get_properties2(VkPhysicalDevice d,
                                                  VkPhysicalDeviceProperties2 *p)
{
    real_GetPhysicalDeviceProperties2(d, p);
    narrow_properties(&p->properties);
}

BELOW(GetPhysicalDeviceFeatures);
static VKAPI_ATTR void VKAPI_CALL get_features(VkPhysicalDevice d, VkPhysicalDeviceFeatures *f)
{
    real_GetPhysicalDeviceFeatures(d, f);
    narrow_switches((VkBool32 *)f, (const VkBool32 *)&features10, sizeof *f);
}

BELOW(GetPhysicalDeviceFeatures2);
static VKAPI_ATTR void VKAPI_CALL get_features2(VkPhysicalDevice d, VkPhysicalDeviceFeatures2 *f)
{
    real_GetPhysicalDeviceFeatures2(d, f);
    for (VkBaseOutStructure *s = (VkBaseOutStructure *)f; s; s = s->pNext) {
        const switches *known = find_switches(s->sType);
        if (known) {
            narrow_switches((VkBool32 *)((char *)s + known->at), known->kept, known->bytes);
        }
    }
}

BELOW(GetPhysicalDeviceMemoryProperties);
static VKAPI_ATTR void VKAPI_CALL get_memory(VkPhysicalDevice d,
                                             VkPhysicalDeviceMemoryProperties *m)
{
    real_GetPhysicalDeviceMemoryProperties(d, m);
    split_memory(m);
}

BELOW(GetPhysicalDeviceMemoryProperties2);
static VKAPI_ATTR void VKAPI_CALL get_memory2(VkPhysicalDevice d,
                                              VkPhysicalDeviceMemoryProperties2 *m)
{
    real_GetPhysicalDeviceMemoryProperties2(d, m);
    split_memory(&m->memoryProperties);
}

BELOW(GetPhysicalDeviceQueueFamilyProperties);
static VKAPI_ATTR void VKAPI_CALL get_families(VkPhysicalDevice d, uint32_t *count,
                                               VkQueueFamilyProperties *f)
{
    real_GetPhysicalDeviceQueueFamilyProperties(d, count, f);
    for (uint32_t i = 0; f && i < *count; i++) {
        f[i].timestampValidBits = 0;
    }
}

BELOW(GetPhysicalDeviceQueueFamilyProperties2);
static VKAPI_ATTR void VKAPI_CALL get_families2(VkPhysicalDevice d, uint32_t *count,
                                                VkQueueFamilyProperties2 *f)
{
    real_GetPhysicalDeviceQueueFamilyProperties2(d, count, f);
    for (uint32_t i = 0; f && i < *count; i++) {
        f[i].queueFamilyProperties.timestampValidBits = 0;
    }
}

// The loader refuses a device that is to have others.
static VKAPI_ATTR VkResult VKAPI_CALL list_extensions(VkPhysicalDevice d, const char *layer,
                                                      uint32_t *count, VkExtensionProperties *out)
{
    (void)d, (void)layer, (void)out;
    *count = 0;
    return VK_SUCCESS;
}

BELOW(CreateDevice);
static VKAPI_ATTR VkResult VKAPI_CALL create_device(VkPhysicalDevice d,
                                                    const VkDeviceCreateInfo *info,
                                                    const VkAllocationCallbacks *a, VkDevice *out)
{
    if (!check_features(info)) {
        return VK_ERROR_FEATURE_NOT_PRESENT;
    }
    const unsigned before = flush_begin();
    const VkResult result = real_CreateDevice(d, info, a, out);
    flush_end(before);
    return result;
}

BELOW(AllocateMemory);
static VKAPI_ATTR VkResult VKAPI_CALL allocate(VkDevice d, const VkMemoryAllocateInfo *info,
                                               const VkAllocationCallbacks *a, VkDeviceMemory *out)
{
    if (info->memoryTypeIndex >= NUM_TYPES) {
        refuse("vkAllocateMemory: memoryTypeIndex", info->memoryTypeIndex, NUM_TYPES - 1);
        return VK_ERROR_UNKNOWN;
    }
    VkMemoryAllocateInfo one = *info;
    one.memoryTypeIndex = 0; // the only type of the software device
    const VkResult result = real_AllocateMemory(d, &one, a, out);
    if (result == VK_SUCCESS && info->memoryTypeIndex == OWN && !note_own(VK_NULL_HANDLE, *out)) {
        refuse("vkAllocateMemory: number of allocations", sizeof own / sizeof *own + 1,
               sizeof own / sizeof *own);
        return VK_ERROR_TOO_MANY_OBJECTS;
    }
    return result;
}

BELOW(FreeMemory);
static VKAPI_ATTR void VKAPI_CALL free_memory(VkDevice d, VkDeviceMemory m,
                                              const VkAllocationCallbacks *a)
{
    if (m) {
        note_own(m, VK_NULL_HANDLE);
    }
    real_FreeMemory(d, m, a);
}

BELOW(MapMemory);
static VKAPI_ATTR VkResult VKAPI_CALL map(VkDevice d, VkDeviceMemory m, VkDeviceSize at,
                                          VkDeviceSize size, VkMemoryMapFlags flags, void **out)
{
    if (note_own(m, m)) {
        fprintf(stderr,
                "strict driver: vkMapMemory: memory is of a type that is not HOST_VISIBLE\n");
        return VK_ERROR_MEMORY_MAP_FAILED;
    }
    return real_MapMemory(d, m, at, size, flags, out);
}

BELOW(GetBufferMemoryRequirements);
static VKAPI_ATTR void VKAPI_CALL buffer_needs(VkDevice d, VkBuffer b, VkMemoryRequirements *r)
{
    real_GetBufferMemoryRequirements(d, b, r);
    split_requirements(r, true);
}

BELOW(GetBufferMemoryRequirements2);
static VKAPI_ATTR void VKAPI_CALL buffer_needs2(VkDevice d,
                                                const VkBufferMemoryRequirementsInfo2 *i,
                                                VkMemoryRequirements2 *r)
{
    real_GetBufferMemoryRequirements2(d, i, r);
    split_requirements(&r->memoryRequirements, true);
}

BELOW(GetDeviceBufferMemoryRequirements);
static VKAPI_ATTR void VKAPI_CALL buffer_would_need(VkDevice d,
                                                    const VkDeviceBufferMemoryRequirements *i,
                                                    VkMemoryRequirements2 *r)
{
    real_GetDeviceBufferMemoryRequirements(d, i, r);
    split_requirements(&r->memoryRequirements, true);
}

BELOW(GetImageMemoryRequirements);
static VKAPI_ATTR void VKAPI_CALL image_needs(VkDevice d, VkImage b, VkMemoryRequirements *r)
{
    real_GetImageMemoryRequirements(d, b, r);
    split_requirements(r, false);
}

BELOW(GetImageMemoryRequirements2);
static VKAPI_ATTR void VKAPI_CALL image_needs2(VkDevice d, const VkImageMemoryRequirementsInfo2 *i,
                                               VkMemoryRequirements2 *r)
{
    real_GetImageMemoryRequirements2(d, i, r);
    split_requirements(&r->memoryRequirements, false);
}

BELOW(GetDeviceImageMemoryRequirements);
static VKAPI_ATTR void VKAPI_CALL image_would_need(VkDevice d,
                                                   const VkDeviceImageMemoryRequirements *i,
                                                   VkMemoryRequirements2 *r)
{
    real_GetDeviceImageMemoryRequirements(d, i, r);
    split_requirements(&r->memoryRequirements, false);
}

BELOW(CreateShaderModule);
static VKAPI_ATTR VkResult VKAPI_CALL create_module(VkDevice d,
                                                    const VkShaderModuleCreateInfo *info,
                                                    const VkAllocationCallbacks *a,
                                                    VkShaderModule *out)
{
    VkShaderModuleCreateInfo with = *info;
    uint32_t *words =
        rounding_rewrite(&below.kinds, info->pCode, info->codeSize / 4, &with.codeSize);
    if (words) {
        with.pCode = words;
        with.codeSize *= 4;
    }
    const VkResult result = real_CreateShaderModule(d, &with, a, out);
    free(words);
    return result;
}

static PFN_vkVoidFunction hook(PFN_vkVoidFunction real, const char *name);

BELOW(GetDeviceProcAddr);
static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_device_function(VkDevice device,
                                                                    const char *name)
{
    return hook(real_GetDeviceProcAddr(device, name), name);
}

// `real`, or what stands in for it. Functions of the software driver are the same for all of its devices.
static PFN_vkVoidFunction hook(PFN_vkVoidFunction real, const char *name)
{
#define HOOK(function, own_function)                                                               \
    if (!strcmp(name, "vk" #function) || !strcmp(name, "vk" #function "KHR")) {                    \
        real_##function = (PFN_vk##function)real;                                                  \
        return (PFN_vkVoidFunction)own_function;                                                   \
    }
    if (!real) {
        return NULL;
    }
    if (!strcmp(name, "vkEnumerateDeviceExtensionProperties")) {
        return (PFN_vkVoidFunction)list_extensions;
    }
    HOOK(CreateInstance, create_instance)
    HOOK(EnumeratePhysicalDevices, enumerate_physical_devices)
    HOOK(CreateDevice, create_device)
    HOOK(GetDeviceProcAddr, get_device_function)
    HOOK(GetPhysicalDeviceProperties, get_properties)
    HOOK(GetPhysicalDeviceProperties2, get_properties2)
    HOOK(CreateShaderModule, create_module)
    if (below.wide) {
        return real;
    }
    HOOK(GetPhysicalDeviceFeatures, get_features)
    HOOK(GetPhysicalDeviceFeatures2, get_features2)
    HOOK(GetPhysicalDeviceMemoryProperties, get_memory)
    HOOK(GetPhysicalDeviceMemoryProperties2, get_memory2)
    HOOK(GetPhysicalDeviceQueueFamilyProperties, get_families)
    HOOK(GetPhysicalDeviceQueueFamilyProperties2, get_families2)
    HOOK(AllocateMemory, allocate)
    HOOK(FreeMemory, free_memory)
    HOOK(MapMemory, map)
    HOOK(GetBufferMemoryRequirements, buffer_needs)
    HOOK(GetBufferMemoryRequirements2, buffer_needs2)
    HOOK(GetDeviceBufferMemoryRequirements, buffer_would_need)
    HOOK(GetImageMemoryRequirements, image_needs)
    HOOK(GetImageMemoryRequirements2, image_needs2)
    HOOK(GetDeviceImageMemoryRequirements, image_would_need)
    return real;
}

// ---- what the loader calls ----------------------------------------------------------------------------

EXPORT VKAPI_ATTR VkResult VKAPI_CALL vk_icdNegotiateLoaderICDInterfaceVersion(uint32_t *version)
{
    pthread_once(&below.once, open_below);
    return below.negotiate ? below.negotiate(version) : VK_ERROR_INCOMPATIBLE_DRIVER;
}

EXPORT VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL vk_icdGetInstanceProcAddr(VkInstance instance,
                                                                          const char *name)
{
    pthread_once(&below.once, open_below);
    return below.get ? hook(below.get(instance, name), name) : NULL;
}

EXPORT VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL vk_icdGetPhysicalDeviceProcAddr(VkInstance instance,
                                                                                const char *name)
{
    pthread_once(&below.once, open_below);
    return below.get_physical ? hook(below.get_physical(instance, name), name) : NULL;
}
