// open.c -- a device of our own: the loader at run time, instance, validation, choice of device.
#include "gpu/compiler.h"
#include "base/fault.h"
#include "base/given.h"
#include "gpu/needs.h"
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct instance_procs {
    PFN_vkGetInstanceProcAddr gipa;
    PFN_vkCreateInstance CreateInstance;
    PFN_vkEnumerateInstanceLayerProperties EnumerateInstanceLayerProperties;
    PFN_vkEnumerateInstanceExtensionProperties EnumerateInstanceExtensionProperties;
    PFN_vkEnumerateInstanceVersion EnumerateInstanceVersion;
} instance_procs;

// procs->gipa: the one that was given, or NULL: the loader's.
static tyn_result load_loader(void **loader, instance_procs *procs, const tyn_log *log)
{
    if (!procs->gipa) {
        *loader = dlopen("libvulkan.so.1", RTLD_NOW | RTLD_LOCAL);
        if (!*loader) {
            return TYN_FAULT(log, TYN_ERR_DEVICE,
                             "no Vulkan loader: %s; install it (Debian: libvulkan1)", dlerror());
        }
        *(void **)&procs->gipa = dlsym(*loader, "vkGetInstanceProcAddr");
    }
    if (procs->gipa) {
#define X(name) procs->name = (PFN_vk##name)procs->gipa(NULL, "vk" #name);
        X(CreateInstance)
        X(EnumerateInstanceLayerProperties)
        X(EnumerateInstanceExtensionProperties)
        X(EnumerateInstanceVersion)
#undef X
    }
    uint32_t version = 0;
    if (!procs->CreateInstance || !procs->EnumerateInstanceVersion ||
        procs->EnumerateInstanceVersion(&version) != VK_SUCCESS || version < VK_API_VERSION_1_3) {
        return TYN_FAULT(log, TYN_ERR_DEVICE, "the Vulkan loader is older than 1.3");
    }
    return TYN_OK;
}

static VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                 VkDebugUtilsMessageTypeFlagsEXT types,
                                                 const VkDebugUtilsMessengerCallbackDataEXT *data,
                                                 void *user)
{
    (void)severity;
    (void)types;
    tyn_device *dev = user;
    dev->validation_messages++;
    tyn_log_print(&dev->log, TYN_LOG_ERROR, "validation: %s", data->pMessage);
    return VK_FALSE;
}

static VkDebugUtilsMessengerCreateInfoEXT describe_messenger(tyn_device *dev)
{
    return (VkDebugUtilsMessengerCreateInfoEXT){
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                           VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT |
                       VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT,
        .pfnUserCallback = on_message,
        .pUserData = dev,
    };
}

static bool has_layer(const instance_procs *procs, const char *name)
{
    uint32_t count = 0;
    procs->EnumerateInstanceLayerProperties(&count, NULL);
    VkLayerProperties *layers = calloc(count ? count : 1, sizeof *layers);
    bool found = false;
    if (layers && procs->EnumerateInstanceLayerProperties(&count, layers) >= 0) {
        for (uint32_t i = 0; i < count; i++) {
            found |= !strcmp(layers[i].layerName, name);
        }
    }
    free(layers);
    return found;
}

// The loader found none, or only where variables sent it.
static void say_no_driver(const tyn_log *log)
{
    static const char *const variables[] = {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"};
    const char *name = NULL, *value = NULL;
    for (int i = 0; i < 2 && !value; i++) {
        name = variables[i];
        value = getenv(name);
    }
    tyn_log_print(log, TYN_LOG_ERROR,
                  "no Vulkan driver: install that of the graphics card, or Mesa's software device "
                  "(Debian: mesa-vulkan-drivers)%s%s%s%.200s%s",
                  value ? "; " : "", value ? name : "", value ? " says to look at '" : "",
                  value ? value : "", value ? "' alone" : "");
}

static tyn_result create_instance(const instance_procs *procs, bool validation, tyn_device *user,
                                  VkInstance *out, const tyn_log *log)
{
    static const char layer[] = "VK_LAYER_KHRONOS_validation";
    if (validation && !has_layer(procs, layer)) {
        return TYN_FAULT(log, TYN_ERR_UNSUPPORTED,
                         "validation was asked for, but %s is not installed", layer);
    }
    const VkDebugUtilsMessengerCreateInfoEXT messenger = describe_messenger(user);
    const VkValidationFeaturesEXT features = {
        .sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
        .pNext = &messenger,
        .enabledValidationFeatureCount = 1,
        .pEnabledValidationFeatures =
            (const VkValidationFeatureEnableEXT[]){
                VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT},
    };
    const VkResult made = TYN_VK_MADE(
        out,
        procs->CreateInstance(
            &(VkInstanceCreateInfo){
                .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                .pNext = validation ? &features : NULL,
                .pApplicationInfo =
                    &(VkApplicationInfo){.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                         .pApplicationName = "tyndall",
                                         .applicationVersion = TYN_VERSION,
                                         .apiVersion = VK_API_VERSION_1_3},
                .enabledLayerCount = validation ? 1 : 0,
                .ppEnabledLayerNames = (const char *const[]){layer},
                .enabledExtensionCount = validation ? 1 : 0,
                .ppEnabledExtensionNames = (const char *const[]){VK_EXT_DEBUG_UTILS_EXTENSION_NAME},
            },
            NULL, out));
    if (made == VK_ERROR_INCOMPATIBLE_DRIVER) {
        say_no_driver(log);
        return TYN_ERR_DEVICE;
    }
    return tyn_vk_check(&(tyn_device){.log = log ? *log : (tyn_log){0}}, made, "vkCreateInstance");
}

// ---- choosing ---------------------------------------------------------------------------------

typedef struct candidate {
    VkPhysicalDevice device;
    VkPhysicalDeviceProperties properties;
    char driver[256];
    uint64_t met;      // rows of the table of needs
    char missing[256]; // "" = usable
    uint32_t queue_family;
} candidate;

static candidate inspect(const tyn_procs *vk, VkPhysicalDevice device)
{
    candidate c = {.device = device, .queue_family = UINT32_MAX};
    tyn_device_describe(vk, device, &c.properties, c.driver);
    VkQueueFamilyProperties families[16];
    uint32_t count = 16;
    vk->GetPhysicalDeviceQueueFamilyProperties(device, &count, families);
    // One that draws as well, if there is one: scenes with surfaces need it.
    const VkQueueFlags wishes[] = {VK_QUEUE_COMPUTE_BIT | VK_QUEUE_GRAPHICS_BIT,
                                   VK_QUEUE_COMPUTE_BIT};
    for (uint32_t w = 0; w < 2; w++) {
        for (uint32_t i = 0; i < count && c.queue_family == UINT32_MAX; i++) {
            if ((families[i].queueFlags & wishes[w]) == wishes[w]) {
                c.queue_family = i;
            }
        }
    }
    c.met = tyn_needs_of_device(vk, device, c.queue_family);
    tyn_need_unmet(c.met, c.missing);
    return c;
}

// By VkPhysicalDeviceType.
static const struct {
    const char *name;
    int rank; // the highest is chosen
} kinds[] = {{"other", 0}, {"integrated", 2}, {"discrete", 3}, {"virtual", 1}, {"cpu", 0}};

static size_t kind_of(const candidate *c)
{
    const size_t type = (size_t)c->properties.deviceType;
    return type < sizeof kinds / sizeof *kinds ? type : 0;
}

enum { MAX_DEVICES = 16 };

static tyn_result choose(tyn_device *dev, const char *select, candidate *out)
{
    VkPhysicalDevice devices[MAX_DEVICES];
    uint32_t count = MAX_DEVICES;
    VkResult listed = dev->vk.EnumeratePhysicalDevices(dev->instance, &count, devices);
    if (listed < 0) {
        return tyn_vk_check(dev, listed, "vkEnumeratePhysicalDevices");
    }
    if (!count) {
        return TYN_FAULT(
            &dev->log, TYN_ERR_DEVICE,
            "no Vulkan device; a software one comes with Debian's mesa-vulkan-drivers");
    }
    char *end = NULL;
    unsigned long index = select ? strtoul(select, &end, 10) : 0;
    bool by_index = select && *select && !*end;
    int best = -1;
    for (uint32_t i = 0; i < count; i++) {
        candidate c = inspect(&dev->vk, devices[i]);
        bool wanted = !select ||
                      (by_index ? i == index : strcasestr(c.properties.deviceName, select) != NULL);
        int score = (c.missing[0] ? 0 : 10) + kinds[kind_of(&c)].rank;
        if (wanted && score > best) {
            best = score;
            *out = c;
        }
    }
    if (best < 0) {
        return TYN_FAULT(
            &dev->log, TYN_ERR_PARAMS,
            "device '%s' is not there; the %u devices are listed by `tyndall info --devices`",
            select, count);
    }
    if (out->missing[0]) {
        return TYN_FAULT(&dev->log, TYN_ERR_DEVICE, "device '%s' lacks %s",
                         out->properties.deviceName, out->missing);
    }
    return TYN_OK;
}

static void load_instance_procs(tyn_device *dev, PFN_vkGetInstanceProcAddr gipa)
{
#define X(name) dev->vk.name = (PFN_vk##name)gipa(dev->instance, "vk" #name);
    TYN_INSTANCE_PROCS(X)
#undef X
}

static tyn_result create_messenger(tyn_device *dev)
{
    const VkDebugUtilsMessengerCreateInfoEXT messenger = describe_messenger(dev);
    PFN_vkCreateDebugUtilsMessengerEXT create =
        (PFN_vkCreateDebugUtilsMessengerEXT)dev->get_instance_proc_addr(
            dev->instance, "vkCreateDebugUtilsMessengerEXT");
    dev->debug_names = true;
    return tyn_vk_check(
        dev, TYN_VK_MADE(&dev->messenger, create(dev->instance, &messenger, NULL, &dev->messenger)),
        "vkCreateDebugUtilsMessengerEXT");
}

static tyn_result open_device(tyn_device *dev, const tyn_device_open_params *params)
{
    instance_procs procs = {.gipa = params->get_instance_proc_addr};
    candidate c = {0};
    dev->own = true;
    TYN_TRY(load_loader(&dev->loader, &procs, &dev->log));
    dev->get_instance_proc_addr = procs.gipa;
    TYN_TRY(create_instance(&procs, params->validation, dev, &dev->instance, &dev->log));
    load_instance_procs(dev, procs.gipa);
    if (params->validation) {
        TYN_TRY(create_messenger(dev));
    }
    TYN_TRY(choose(dev, params->select, &c));
    dev->physical_device = c.device;
    dev->queue_family = c.queue_family;
    VkResult made = TYN_VK_MADE(
        &dev->device,
        dev->vk.CreateDevice(
            dev->physical_device,
            &(VkDeviceCreateInfo){
                .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                .pNext = tyn_requirements_get()->features,
                .queueCreateInfoCount = 1,
                .pQueueCreateInfos =
                    &(VkDeviceQueueCreateInfo){.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                               .queueFamilyIndex = dev->queue_family,
                                               .queueCount = 1,
                                               .pQueuePriorities = (const float[]){1.0f}},
            },
            NULL, &dev->device));
    TYN_TRY(tyn_vk_check(dev, made, "vkCreateDevice"));
    TYN_TRY(
        tyn_device_init(dev, procs.gipa,
                        &(tyn_pipeline_params){params->pipeline_cache, params->pipeline_cache_size,
                                               params->compile_threads, params->jobs}));
    dev->vk.GetDeviceQueue(dev->device, dev->queue_family, 0, &dev->queue);
    return TYN_OK;
}

tyn_result tyn_device_open(const tyn_device_open_params *params, tyn_device **out)
{
    const tyn_log *log = params ? &params->log : NULL;
    if (out) {
        *out = NULL;
    }
    if (!TYN_GIVEN(log, params, out) ||
        !tyn_sized(log, __func__, params->struct_size, sizeof *params, "tyn_device_open_params")) {
        return TYN_ERR_PARAMS;
    }
    tyn_device *dev = calloc(1, sizeof *dev);
    if (!dev) {
        return TYN_ERR_MEMORY;
    }
    dev->log = params->log;
    tyn_result result = open_device(dev, params);
    if (result != TYN_OK) {
        tyn_device_destroy(&dev);
    }
    *out = dev;
    return result;
}

// ---- listing ----------------------------------------------------------------------------------

int tyn_devices_list(tyn_device_info *infos, uint32_t max, const tyn_log *log)
{
    tyn_device dev = {0};
    if (max && !TYN_GIVEN(log, infos)) {
        return TYN_ERR_PARAMS;
    }
    if (log) {
        dev.log = *log;
    }
    instance_procs procs = {0};
    tyn_result result = load_loader(&dev.loader, &procs, log);
    if (result == TYN_OK) {
        result = create_instance(&procs, false, NULL, &dev.instance, log);
    }
    if (result != TYN_OK) {
        if (dev.loader) {
            dlclose(dev.loader);
        }
        return (int)result;
    }
    load_instance_procs(&dev, procs.gipa);
    VkPhysicalDevice devices[MAX_DEVICES];
    uint32_t count = MAX_DEVICES;
    if (dev.vk.EnumeratePhysicalDevices(dev.instance, &count, devices) < 0) {
        count = 0;
    }
    for (uint32_t i = 0; i < count && i < max; i++) {
        candidate c = inspect(&dev.vk, devices[i]);
        VkPhysicalDeviceMemoryProperties memory;
        dev.vk.GetPhysicalDeviceMemoryProperties(devices[i], &memory);
        infos[i] = (tyn_device_info){.api_version = c.properties.apiVersion,
                                     .type = kinds[kind_of(&c)].name,
                                     .heap_bytes = memory.memoryHeaps[0].size,
                                     .met = c.met,
                                     .capacity = tyn_device_capacity(&dev.vk, devices[i])};
        snprintf(infos[i].name, sizeof infos[i].name, "%s", c.properties.deviceName);
        snprintf(infos[i].driver, sizeof infos[i].driver, "%s", c.driver);
        snprintf(infos[i].missing, sizeof infos[i].missing, "%s", c.missing);
    }
    dev.vk.DestroyInstance(dev.instance, NULL);
    dlclose(dev.loader);
    return (int)count;
}
