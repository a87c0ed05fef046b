// hold.c -- preloaded into the viewer: no kernel is compiled as long as the file that HOLD names is there.
#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <vulkan/vulkan.h>

static PFN_vkGetDeviceProcAddr device_proc;
static PFN_vkCreateComputePipelines compile;

static VKAPI_ATTR VkResult VKAPI_CALL compile_later(VkDevice device, VkPipelineCache cache,
                                                    uint32_t count,
                                                    const VkComputePipelineCreateInfo *infos,
                                                    const VkAllocationCallbacks *callbacks,
                                                    VkPipeline *out)
{
    const char *path = getenv("HOLD");
    while (path && access(path, F_OK) == 0) {
        usleep(5000);
    }
    return compile(device, cache, count, infos, callbacks, out);
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL of_device(VkDevice device, const char *name)
{
    PFN_vkVoidFunction found = device_proc(device, name);
    if (strcmp(name, "vkCreateComputePipelines") != 0) {
        return found;
    }
    compile = (PFN_vkCreateComputePipelines)found;
    return (PFN_vkVoidFunction)compile_later;
}

// The library under the viewer has its functions from here.
VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL vkGetInstanceProcAddr(VkInstance instance,
                                                               const char *name)
{
    PFN_vkGetInstanceProcAddr next;
    *(void **)&next = dlsym(RTLD_NEXT, "vkGetInstanceProcAddr");
    PFN_vkVoidFunction found = next(instance, name);
    if (strcmp(name, "vkGetDeviceProcAddr") != 0) {
        return found;
    }
    device_proc = (PFN_vkGetDeviceProcAddr)found;
    return (PFN_vkVoidFunction)of_device;
}
