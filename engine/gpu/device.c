// device.c -- tyn_device on a host's VkDevice: requirements, function tables, samplers.
#include "gpu/compiler.h"
#include "base/fault.h"
#include "base/given.h"
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- requirements -----------------------------------------------------------------------------

static const VkPhysicalDeviceVulkan13Features required13 = {
    .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,
    .synchronization2 = VK_TRUE,
    .dynamicRendering = VK_TRUE, // raster kernels
    .maintenance4 = VK_TRUE,     // LocalSizeId and relaxed interfaces that current glslang may emit
};
static const VkPhysicalDeviceVulkan12Features required12 = {
    .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES,
    .pNext = (void *)&required13,
    .scalarBlockLayout = VK_TRUE, // one struct definition for C and GLSL
};
static const VkPhysicalDeviceFeatures2 required = {
    .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
    .pNext = (void *)&required12,
    .features = {.shaderStorageImageExtendedFormats = VK_TRUE}, // rg32f storage images
};

const tyn_requirements *tyn_requirements_get(void)
{
    static const char *const none[] = {NULL};
    static const tyn_requirements requirements = {VK_API_VERSION_1_3, &required, none};
    return &requirements;
}

static const void *find_in_chain(const void *chain, VkStructureType type)
{
    for (const VkBaseInStructure *s = chain; s; s = s->pNext) {
        if (s->sType == type) {
            return s;
        }
    }
    return NULL;
}

const char *tyn_missing_feature(const VkPhysicalDeviceFeatures2 *enabled)
{
    const VkPhysicalDeviceVulkan12Features *v12 =
        find_in_chain(enabled, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES);
    const VkPhysicalDeviceVulkan13Features *v13 =
        find_in_chain(enabled, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES);
    // A host may chain the promoted structs instead of the core ones.
    const VkPhysicalDeviceScalarBlockLayoutFeatures *scalar =
        find_in_chain(enabled, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SCALAR_BLOCK_LAYOUT_FEATURES);
    const VkPhysicalDeviceSynchronization2Features *sync2 =
        find_in_chain(enabled, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES);
    const VkPhysicalDeviceMaintenance4Features *maint4 =
        find_in_chain(enabled, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_4_FEATURES);
    const VkPhysicalDeviceDynamicRenderingFeatures *rendering =
        find_in_chain(enabled, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES);
    if (!enabled || !enabled->features.shaderStorageImageExtendedFormats) {
        return "shaderStorageImageExtendedFormats";
    }
    if (!(v12 && v12->scalarBlockLayout) && !(scalar && scalar->scalarBlockLayout)) {
        return "scalarBlockLayout";
    }
    if (!(v13 && v13->synchronization2) && !(sync2 && sync2->synchronization2)) {
        return "synchronization2";
    }
    if (!(v13 && v13->maintenance4) && !(maint4 && maint4->maintenance4)) {
        return "maintenance4";
    }
    if (!(v13 && v13->dynamicRendering) && !(rendering && rendering->dynamicRendering)) {
        return "dynamicRendering";
    }
    return NULL;
}

static bool separates_stencil(const VkPhysicalDeviceFeatures2 *enabled)
{
    const VkPhysicalDeviceVulkan12Features *v12 =
        find_in_chain(enabled, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES);
    const VkPhysicalDeviceSeparateDepthStencilLayoutsFeatures *own = find_in_chain(
        enabled, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SEPARATE_DEPTH_STENCIL_LAYOUTS_FEATURES);
    return (v12 && v12->separateDepthStencilLayouts) || (own && own->separateDepthStencilLayouts);
}

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

// Formats that passes sample with linear filtering or store to, beyond what Vulkan promises.
static tyn_result check_formats(const tyn_device *dev)
{
    static const struct {
        VkFormat format;
        const char *name;
        VkFormatFeatureFlags need;
    } formats[] = {
        {VK_FORMAT_R16_SFLOAT, "R16_SFLOAT", VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT},
        {VK_FORMAT_R32_SFLOAT, "R32_SFLOAT",
         VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT | VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT},
        {VK_FORMAT_R32G32_SFLOAT, "R32G32_SFLOAT",
         VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT | VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT},
        {VK_FORMAT_R32G32B32A32_SFLOAT, "R32G32B32A32_SFLOAT",
         VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT | VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT},
    };
    for (size_t i = 0; i < sizeof formats / sizeof formats[0]; i++) {
        VkFormatProperties p;
        dev->vk.GetPhysicalDeviceFormatProperties(dev->physical_device, formats[i].format, &p);
        if ((p.optimalTilingFeatures & formats[i].need) != formats[i].need) {
            return TYN_FAULT(&dev->log, TYN_ERR_UNSUPPORTED,
                             "device '%s' cannot filter or store images of format %s",
                             dev->properties.deviceName, formats[i].name);
        }
    }
    return TYN_OK;
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
    dev->graphics = (family.queueFlags & VK_QUEUE_GRAPHICS_BIT) != 0;
    if (!(family.queueFlags & VK_QUEUE_COMPUTE_BIT)) {
        return TYN_FAULT(&dev->log, TYN_ERR_PARAMS, "queue_family %u has no compute",
                         dev->queue_family);
    }
    TYN_TRY(check_formats(dev));

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
    const char *missing = tyn_missing_feature(params->features);
    if (missing) {
        return TYN_FAULT(log, TYN_ERR_UNSUPPORTED,
                         "tyn_device_create: feature %s is not enabled on the device; "
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
    dev->separate_stencil = separates_stencil(params->features);
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
