// kernel_driver.c -- see kernel_driver.h.
#include "kernel_driver.h"
#include <pthread.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MAX_MODULES = 256, MAX_KERNELS = 256 };

kernel_driver driver;

static struct {
    PFN_vkGetInstanceProcAddr instance_proc;
    PFN_vkGetDeviceProcAddr device_proc;
    PFN_vkCreateComputePipelines compute;
    PFN_vkDestroyPipeline destroy;
    PFN_vkCreateShaderModule module;
    PFN_vkCreatePipelineCache create_cache;
} below;

// What was compiled, by the words of its module and its constants.
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static struct {
    VkShaderModule handle;
    uint64_t hash;
} modules[MAX_MODULES];
static struct {
    VkPipeline handle;
    uint64_t hash;
} kernels[MAX_KERNELS];
static uint32_t num_modules, num_kernels;

static uint64_t hash_of(uint64_t hash, const void *data, size_t size)
{
    for (size_t i = 0; i < size; i++) {
        hash = (hash ^ ((const uint8_t *)data)[i]) * 0x100000001b3u;
    }
    return hash;
}

static VKAPI_ATTR VkResult VKAPI_CALL create_module(VkDevice device,
                                                    const VkShaderModuleCreateInfo *info,
                                                    const VkAllocationCallbacks *callbacks,
                                                    VkShaderModule *out)
{
    const VkResult made = below.module(device, info, callbacks, out);
    pthread_mutex_lock(&lock);
    modules[num_modules % MAX_MODULES].handle = *out;
    modules[num_modules++ % MAX_MODULES].hash = hash_of(1, info->pCode, info->codeSize);
    pthread_mutex_unlock(&lock);
    return made;
}

static uint64_t hash_of_kernel(const VkPipelineShaderStageCreateInfo *stage)
{
    uint64_t hash = 0;
    for (uint32_t i = 1; i <= MAX_MODULES && i <= num_modules && !hash; i++) { // the newest first
        const uint32_t m = (num_modules - i) % MAX_MODULES;
        hash = modules[m].handle == stage->module ? modules[m].hash : 0;
    }
    const VkSpecializationInfo *constants = stage->pSpecializationInfo;
    return constants ? hash_of(hash, constants->pData, constants->dataSize) : hash;
}

static VkPipeline find_kernel(uint64_t hash)
{
    for (uint32_t i = 0; i < num_kernels; i++) {
        if (kernels[i].hash == hash) {
            return kernels[i].handle;
        }
    }
    return VK_NULL_HANDLE;
}

// Pipelines outlive the layouts that they were made with, and go with others that are defined alike.
static VkResult make_kernel(VkDevice device, const VkComputePipelineCreateInfo *info,
                            VkPipeline *out)
{
    pthread_mutex_lock(&lock);
    const uint64_t hash = hash_of_kernel(&info->stage);
    *out = driver.compile_anew ? VK_NULL_HANDLE : find_kernel(hash);
    pthread_mutex_unlock(&lock);
    if (*out) {
        return VK_SUCCESS;
    }
    const VkResult made = below.compute(device, VK_NULL_HANDLE, 1, info, NULL, out);
    pthread_mutex_lock(&lock);
    if (made == VK_SUCCESS && num_kernels < MAX_KERNELS) {
        kernels[num_kernels].handle = *out;
        kernels[num_kernels++].hash = hash;
    }
    pthread_mutex_unlock(&lock);
    return made;
}

static VKAPI_ATTR void VKAPI_CALL destroy_kernel(VkDevice device, VkPipeline pipeline,
                                                 const VkAllocationCallbacks *callbacks)
{
    bool kept = false;
    pthread_mutex_lock(&lock);
    for (uint32_t i = 0; i < num_kernels; i++) {
        kept = kept || kernels[i].handle == pipeline;
    }
    pthread_mutex_unlock(&lock);
    if (!kept) {
        below.destroy(device, pipeline, callbacks);
    }
}

static const VkPipelineCreationFeedbackCreateInfo *feedback_of(const void *chain)
{
    const VkBaseInStructure *s = chain;
    while (s && s->sType != VK_STRUCTURE_TYPE_PIPELINE_CREATION_FEEDBACK_CREATE_INFO) {
        s = s->pNext;
    }
    return (const VkPipelineCreationFeedbackCreateInfo *)s;
}

static VKAPI_ATTR VkResult VKAPI_CALL compile(VkDevice device, VkPipelineCache cache,
                                              uint32_t count,
                                              const VkComputePipelineCreateInfo *info,
                                              const VkAllocationCallbacks *callbacks,
                                              VkPipeline *out)
{
    (void)cache, (void)callbacks;
    const bool hit = driver.keeps && driver.given_size == KEPT_BYTES;
    const int now = atomic_fetch_add(&driver.under_way, 1) + 1;
    int most = driver.most;
    while (most < now && !atomic_compare_exchange_weak(&driver.most, &most, now)) {
    }
    *out = VK_NULL_HANDLE;
    usleep(hit ? 0 : 1000u * (unsigned)driver.ms);
    VkResult made = VK_ERROR_OUT_OF_HOST_MEMORY;
    if (count != 1) {
        made = VK_ERROR_UNKNOWN;
    } else if (driver.fail > 0) {
        driver.fail--;
    } else {
        made = make_kernel(device, info, out);
    }
    const VkPipelineCreationFeedbackCreateInfo *feedback = feedback_of(info->pNext);
    if (driver.keeps && feedback) {
        feedback->pPipelineCreationFeedback->flags =
            VK_PIPELINE_CREATION_FEEDBACK_VALID_BIT |
            (hit ? VK_PIPELINE_CREATION_FEEDBACK_APPLICATION_PIPELINE_CACHE_HIT_BIT : 0u);
    }
    driver.under_way--;
    return made;
}

static VKAPI_ATTR VkResult VKAPI_CALL create_cache(VkDevice device,
                                                   const VkPipelineCacheCreateInfo *info,
                                                   const VkAllocationCallbacks *callbacks,
                                                   VkPipelineCache *out)
{
    VkPipelineCacheCreateInfo passed = *info;
    driver.given_size = info->initialDataSize;
    if (driver.refuses && info->initialDataSize) {
        return VK_ERROR_INITIALIZATION_FAILED;
    }
    if (driver.keeps) {
        const size_t size = info->initialDataSize < KEPT_BYTES ? info->initialDataSize : KEPT_BYTES;
        if (size) {
            memcpy(driver.given, info->pInitialData, size);
        }
        passed.initialDataSize = 0;
        passed.pInitialData = NULL;
    }
    return below.create_cache(device, &passed, callbacks, out);
}

static VKAPI_ATTR VkResult VKAPI_CALL cache_data(VkDevice device, VkPipelineCache cache,
                                                 size_t *size, void *data)
{
    (void)device, (void)cache;
    *size = data && *size < KEPT_BYTES ? *size / 8 * 8 : KEPT_BYTES; // entries of 8 bytes
    if (data) {
        memcpy(data, driver.kept, *size);
    }
    return *size < KEPT_BYTES ? VK_INCOMPLETE : VK_SUCCESS;
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL device_proc(VkDevice device, const char *name)
{
    PFN_vkVoidFunction found = below.device_proc(device, name);
    if (!strcmp(name, "vkCreateComputePipelines")) {
        below.compute = (PFN_vkCreateComputePipelines)found;
        return (PFN_vkVoidFunction)compile;
    }
    if (!strcmp(name, "vkDestroyPipeline")) {
        below.destroy = (PFN_vkDestroyPipeline)found;
        return (PFN_vkVoidFunction)destroy_kernel;
    }
    if (!strcmp(name, "vkCreateShaderModule")) {
        below.module = (PFN_vkCreateShaderModule)found;
        return (PFN_vkVoidFunction)create_module;
    }
    if (!strcmp(name, "vkCreatePipelineCache")) {
        below.create_cache = (PFN_vkCreatePipelineCache)found;
        return (PFN_vkVoidFunction)create_cache;
    }
    return driver.keeps && !strcmp(name, "vkGetPipelineCacheData") ? (PFN_vkVoidFunction)cache_data
                                                                   : found;
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instance_proc(VkInstance instance, const char *name)
{
    PFN_vkVoidFunction found = below.instance_proc(instance, name);
    if (strcmp(name, "vkGetDeviceProcAddr") != 0) {
        return found;
    }
    below.device_proc = (PFN_vkGetDeviceProcAddr)found;
    return (PFN_vkVoidFunction)device_proc;
}

PFN_vkGetInstanceProcAddr kernel_driver_start(PFN_vkGetInstanceProcAddr get)
{
    below.instance_proc = get;
    return instance_proc;
}

void kernel_driver_reset(void)
{
    driver.ms = driver.fail = driver.most = 0;
    driver.given_size = 0;
    driver.keeps = driver.refuses = driver.compile_anew = false;
    memset(driver.given, 0, sizeof driver.given);
    memcpy(driver.kept, "sixteen bytes...", sizeof driver.kept);
}

void kernel_driver_finish(VkDevice device)
{
    for (uint32_t i = 0; i < num_kernels; i++) {
        below.destroy(device, kernels[i].handle, NULL);
    }
    num_kernels = 0;
}
