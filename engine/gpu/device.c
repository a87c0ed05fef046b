// device.c -- tyn_device on a host's VkDevice: function tables, samplers.
#include "gpu/compiler.h"
#include "base/fault.h"
#include "base/given.h"
#include "gpu/needs.h"
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *tyn_device_name(const tyn_device *dev)
{
    return dev ? dev->properties.deviceName : "";
}

const char *tyn_device_driver(const tyn_device *dev)
{
    return dev ? dev->driver : "";
}

uint32_t tyn_device_validation_messages(const tyn_device *dev)
{
    return dev ? dev->validation_messages : 0;
}

// ---- create, destroy --------------------------------------------------------------------------

static tyn_result load_procs(tyn_device *dev, PFN_vkGetInstanceProcAddr gipa)
{
    const char *missing = NULL;
#define X(name)                                                                                    \
    dev->vk.name = (PFN_vk##name)gipa(dev->instance, "vk" #name);                                  \
    missing = dev->vk.name ? missing : "vk" #name;
    TYN_INSTANCE_PROCS(X)
#undef X
    if (!missing) {
#define X(name)                                                                                    \
    dev->vk.name = (PFN_vk##name)dev->vk.GetDeviceProcAddr(dev->device, "vk" #name);               \
    missing = dev->vk.name ? missing : "vk" #name;
        TYN_DEVICE_PROCS(X)
#undef X
    }
    if (missing) {
        return TYN_FAULT(&dev->log, TYN_ERR_UNSUPPORTED,
                         "get_instance_proc_addr does not know %s; Tyndall needs Vulkan 1.3",
                         missing);
    }
    if (dev->debug_names) {
#define X(name) dev->vk.name = (PFN_vk##name)gipa(dev->instance, "vk" #name);
        TYN_DEBUG_PROCS(X)
#undef X
        dev->debug_names = dev->vk.SetDebugUtilsObjectNameEXT && dev->vk.CmdBeginDebugUtilsLabelEXT;
    }
    return TYN_OK;
}

static VkResult create_sampler(tyn_device *dev, VkSamplerAddressMode u, VkFilter filter,
                               VkSampler *out)
{
    return TYN_VK_MADE(
        out, dev->vk.CreateSampler(dev->device,
                                   &(VkSamplerCreateInfo){
                                       .sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                       .magFilter = filter,
                                       .minFilter = filter,
                                       .mipmapMode = VK_SAMPLER_MIPMAP_MODE_NEAREST,
                                       .addressModeU = u,
                                       .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                       .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                       .maxLod = VK_LOD_CLAMP_NONE,
                                   },
                                   NULL, out));
}

void tyn_device_describe(const tyn_procs *vk, VkPhysicalDevice device,
                         VkPhysicalDeviceProperties *properties, char driver[256])
{
    VkPhysicalDeviceDriverProperties of_driver = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceProperties2 all = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                       .pNext = &of_driver};
    vk->GetPhysicalDeviceProperties2(device, &all);
    *properties = all.properties;
    snprintf(driver, 256, "%.127s %.126s", of_driver.driverName, of_driver.driverInfo);
}

tyn_result tyn_device_init(tyn_device *dev, PFN_vkGetInstanceProcAddr gipa,
                           const tyn_pipeline_params *pipelines)
{
    dev->get_instance_proc_addr = gipa;
    TYN_TRY(load_procs(dev, gipa));
    if (pipelines->threads > TYN_MAX_COMPILE_THREADS) {
        return TYN_FAULT(&dev->log, TYN_ERR_PARAMS, "compile_threads is %u; it must be 0 to %d",
                         pipelines->threads, TYN_MAX_COMPILE_THREADS);
    }
    dev->compiler = tyn_compiler_create(dev, pipelines->threads, pipelines->jobs);
    if (!dev->compiler) {
        return TYN_ERR_MEMORY;
    }
    tyn_device_describe(&dev->vk, dev->physical_device, &dev->properties, dev->driver);
    dev->capacity = tyn_device_capacity(&dev->vk, dev->physical_device);
    dev->vk.GetPhysicalDeviceMemoryProperties(dev->physical_device, &dev->memory);
    VkImageFormatProperties image = {.maxResourceSize = 0};
    const VkResult known = dev->vk.GetPhysicalDeviceImageFormatProperties(
        dev->physical_device, VK_FORMAT_R32G32B32A32_SFLOAT, VK_IMAGE_TYPE_2D,
        VK_IMAGE_TILING_OPTIMAL, VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT, 0,
        &image);
    if (known != VK_SUCCESS) {
        return tyn_vk_check(dev, known, "vkGetPhysicalDeviceImageFormatProperties");
    }
    dev->image_bytes = image.maxResourceSize;

    uint32_t count = 0;
    dev->vk.GetPhysicalDeviceQueueFamilyProperties(dev->physical_device, &count, NULL);
    if (dev->queue_family >= count) {
        return TYN_FAULT(&dev->log, TYN_ERR_PARAMS,
                         "queue_family is %u; the device has %u families", dev->queue_family,
                         count);
    }
    VkQueueFamilyProperties *families = calloc(count, sizeof *families);
    if (!families) {
        return TYN_ERR_MEMORY;
    }
    dev->vk.GetPhysicalDeviceQueueFamilyProperties(dev->physical_device, &count, families);
    VkQueueFamilyProperties family = families[dev->queue_family];
    free(families);
    dev->timestamp_bits = family.timestampValidBits;
    if (!(family.queueFlags & VK_QUEUE_COMPUTE_BIT)) {
        return TYN_FAULT(&dev->log, TYN_ERR_PARAMS, "queue_family %u has no compute",
                         dev->queue_family);
    }
    const uint64_t met = tyn_needs_of_device(&dev->vk, dev->physical_device, dev->queue_family);
    dev->graphics = tyn_need_in(met, TYN_NEED_graphics);
    dev->depth = tyn_need_in(met, TYN_NEED_D32_SFLOAT);
    char missing[256];
    tyn_need_unmet(met, missing);
    if (missing[0]) {
        return TYN_FAULT(&dev->log, TYN_ERR_UNSUPPORTED, "device '%s' lacks %s",
                         dev->properties.deviceName, missing);
    }

    const struct {
        VkSamplerAddressMode u;
        VkFilter filter;
        VkSampler *out;
    } samplers[] = {
        {VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, VK_FILTER_LINEAR, &dev->clamp},
        {VK_SAMPLER_ADDRESS_MODE_REPEAT, VK_FILTER_LINEAR, &dev->repeat_x},
        {VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, VK_FILTER_NEAREST, &dev->nearest},
    };
    for (size_t i = 0; i < sizeof samplers / sizeof samplers[0]; i++) {
        VkResult made = create_sampler(dev, samplers[i].u, samplers[i].filter, samplers[i].out);
        TYN_TRY(tyn_vk_check(dev, made, "vkCreateSampler"));
    }
    return tyn_pipeline_cache_create(dev, pipelines->cache, pipelines->cache_size);
}

void tyn_device_destroy(tyn_device **device)
{
    tyn_device *dev = device ? *device : NULL;
    if (!dev) {
        return;
    }
    *device = NULL;
    const bool own = dev->own;
    tyn_compiler_destroy(&dev->compiler);
    if (dev->device && dev->vk.DestroyDevice) {
        if (own && dev->vk.DeviceWaitIdle) {
            dev->vk.DeviceWaitIdle(dev->device);
        }
        if (dev->vk.DestroyPipelineCache) {
            tyn_pipelines_destroy(dev);
            dev->vk.DestroyPipelineCache(dev->device, dev->cache, NULL);
            dev->vk.DestroySampler(dev->device, dev->clamp, NULL);
            dev->vk.DestroySampler(dev->device, dev->repeat_x, NULL);
            dev->vk.DestroySampler(dev->device, dev->nearest, NULL);
        }
        if (own) {
            dev->vk.DestroyDevice(dev->device, NULL);
        }
    }
    if (own && dev->instance) {
        if (dev->messenger) {
            PFN_vkDestroyDebugUtilsMessengerEXT destroy =
                (PFN_vkDestroyDebugUtilsMessengerEXT)dev->get_instance_proc_addr(
                    dev->instance, "vkDestroyDebugUtilsMessengerEXT");
            destroy(dev->instance, dev->messenger, NULL);
        }
        dev->vk.DestroyInstance(dev->instance, NULL);
    }
    if (dev->loader) {
        dlclose(dev->loader);
    }
    free(dev);
}

tyn_result tyn_device_create(const tyn_device_params *params, tyn_device **out)
{
    const tyn_log *log = params ? &params->log : NULL;
    if (out) {
        *out = NULL;
    }
    if (!TYN_GIVEN(log, params, out)) {
        return TYN_ERR_PARAMS;
    }
    if (params->struct_size < sizeof *params || !params->instance || !params->physical_device ||
        !params->device || !params->get_instance_proc_addr) {
        return TYN_FAULT(log, TYN_ERR_PARAMS,
                         "tyn_device_create: instance, physical_device, device and "
                         "get_instance_proc_addr are required (use the tyn_device_params() macro)");
    }
    if (params->api_version < VK_API_VERSION_1_3) {
        return TYN_FAULT(
            log, TYN_ERR_UNSUPPORTED, "tyn_device_create: api_version is %u.%u; 1.3 is needed",
            VK_API_VERSION_MAJOR(params->api_version), VK_API_VERSION_MINOR(params->api_version));
    }
    if (!params->allocator.allocate != !params->allocator.free) {
        return TYN_FAULT(log, TYN_ERR_PARAMS,
                         "tyn_device_create: allocator.%s is NULL; give both or none",
                         params->allocator.allocate ? "free" : "allocate");
    }
    const uint64_t features = tyn_needs_features(params->features);
    char missing[256];
    tyn_need_unmet(features | ~tyn_needs_features(tyn_requirements_get()->features), missing);
    if (missing[0]) {
        return TYN_FAULT(log, TYN_ERR_UNSUPPORTED,
                         "tyn_device_create: %s is not enabled on the device; "
                         "tyn_requirements_get() lists what is needed",
                         missing);
    }
    tyn_device *dev = calloc(1, sizeof *dev);
    if (!dev) {
        return TYN_ERR_MEMORY;
    }
    dev->log = params->log;
    dev->instance = params->instance;
    dev->physical_device = params->physical_device;
    dev->device = params->device;
    dev->queue_family = params->queue_family;
    dev->debug_names = params->debug_names;
    dev->separate_stencil = tyn_need_in(features, TYN_NEED_separateDepthStencilLayouts);
    dev->allocator = params->allocator;
    tyn_result result =
        tyn_device_init(dev, params->get_instance_proc_addr,
                        &(tyn_pipeline_params){params->pipeline_cache, params->pipeline_cache_size,
                                               params->compile_threads, params->jobs});
    if (result != TYN_OK) {
        tyn_device_destroy(&dev);
        return result;
    }
    *out = dev;
    return TYN_OK;
}
