// gpu.c -- the viewer's own Vulkan devices: one draws the window, on the other the library is a guest.
#include "view/gpu.h"
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool gpu_check(gpu *g, VkResult result, const char *what)
{
    if (result == VK_ERROR_DEVICE_LOST) {
        g->lost = true;
    }
    if (result < 0) {
        app_error(g->app, "%s failed with VkResult %d%s", what, (int)result,
                  g->lost ? ": the device is lost" : "");
    }
    return result >= 0;
}

// ---- instance ---------------------------------------------------------------------------------

static VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                 VkDebugUtilsMessageTypeFlagsEXT types,
                                                 const VkDebugUtilsMessengerCallbackDataEXT *data,
                                                 void *user)
{
    (void)severity;
    (void)types;
    gpu *g = user;
    g->messages++;
    app_error(g->app, "validation: %s", data->pMessage);
    return VK_FALSE;
}

static bool has_validation_layer(const char *name)
{
    VkLayerProperties layers[64];
    uint32_t count = ARRAY_SIZE(layers);
    bool found = false;
    if (vkEnumerateInstanceLayerProperties(&count, layers) >= 0) {
        for (uint32_t i = 0; i < count; i++) {
            found = found || strcmp(layers[i].layerName, name) == 0;
        }
    }
    return found;
}

static int open_instance(gpu *g, bool validation)
{
    static const char layer[] = "VK_LAYER_KHRONOS_validation";
    if (validation && !has_validation_layer(layer)) {
        app_error(g->app, "--validate: %s is not installed", layer);
        return EXIT_FAILED;
    }
    const char *extensions[16];
    uint32_t count = 0;
    const char **wanted = glfwGetRequiredInstanceExtensions(&count);
    if (!wanted || count + 1 > ARRAY_SIZE(extensions)) {
        app_error(g->app, "this Vulkan installation cannot present to a window");
        return EXIT_FAILED;
    }
    memcpy(extensions, wanted, count * sizeof *extensions);
    if (validation) {
        extensions[count++] = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    }
    const VkDebugUtilsMessengerCreateInfoEXT listener = {
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                           VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT |
                       VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT,
        .pfnUserCallback = on_message,
        .pUserData = g,
    };
    const VkValidationFeatureEnableEXT enables[] = {
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    const VkValidationFeaturesEXT features = {
        .sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
        .pNext = &listener,
        .enabledValidationFeatureCount = 1,
        .pEnabledValidationFeatures = enables,
    };
    const VkApplicationInfo application = {
        .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
        .pApplicationName = "tyndall view",
        .apiVersion = tyn_requirements_get()->api_version,
    };
    const char *const layers[] = {layer};
    const VkResult made =
        vkCreateInstance(&(VkInstanceCreateInfo){.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                                 .pNext = validation ? &features : NULL,
                                                 .pApplicationInfo = &application,
                                                 .enabledLayerCount = validation ? 1 : 0,
                                                 .ppEnabledLayerNames = layers,
                                                 .enabledExtensionCount = count,
                                                 .ppEnabledExtensionNames = extensions},
                         NULL, &g->instance);
    if (!gpu_check(g, made, "vkCreateInstance")) {
        return EXIT_FAILED;
    }
    if (validation) {
        PFN_vkCreateDebugUtilsMessengerEXT listen =
            (PFN_vkCreateDebugUtilsMessengerEXT)vkGetInstanceProcAddr(
                g->instance, "vkCreateDebugUtilsMessengerEXT");
        if (!gpu_check(g, listen(g->instance, &listener, NULL, &g->messenger),
                       "vkCreateDebugUtilsMessengerEXT")) {
            return EXIT_FAILED;
        }
    }
    return EXIT_DONE;
}

// ---- device -----------------------------------------------------------------------------------

// A queue that draws, computes and presents.
static bool find_queue(gpu *g)
{
    VkQueueFamilyProperties families[16];
    uint32_t count = ARRAY_SIZE(families);
    vkGetPhysicalDeviceQueueFamilyProperties(g->physical_device, &count, families);
    const VkQueueFlags wanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    for (uint32_t i = 0; i < count; i++) {
        if ((families[i].queueFlags & wanted) == wanted &&
            glfwGetPhysicalDevicePresentationSupport(g->instance, g->physical_device, i)) {
            g->queue_family = i;
            return true;
        }
    }
    app_error(g->app, "device '%s' has no queue that draws, computes and presents", g->info.name);
    return false;
}

static bool make_device(gpu *g)
{
    const tyn_requirements *needs = tyn_requirements_get();
    const char *extensions[16] = {VK_KHR_SWAPCHAIN_EXTENSION_NAME};
    uint32_t count = 1;
    for (uint32_t i = 0; needs->extensions && needs->extensions[i] && count < 16; i++) {
        extensions[count++] = needs->extensions[i];
    }
    const float priority = 1;
    const VkDeviceQueueCreateInfo queue = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
        .queueFamilyIndex = g->queue_family,
        .queueCount = 1,
        .pQueuePriorities = &priority,
    };
    const VkResult made =
        vkCreateDevice(g->physical_device,
                       &(VkDeviceCreateInfo){.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                             .pNext = needs->features,
                                             .queueCreateInfoCount = 1,
                                             .pQueueCreateInfos = &queue,
                                             .enabledExtensionCount = count,
                                             .ppEnabledExtensionNames = extensions},
                       NULL, &g->device);
    if (!gpu_check(g, made, "vkCreateDevice")) {
        return false;
    }
    vkGetDeviceQueue(g->device, g->queue_family, 0, &g->queue);
    vkGetPhysicalDeviceMemoryProperties(g->physical_device, &g->memory);
    return true;
}

static int open_device(gpu *g, int index)
{
    VkPhysicalDevice devices[16];
    uint32_t count = ARRAY_SIZE(devices);
    if (!gpu_check(g, vkEnumeratePhysicalDevices(g->instance, &count, devices),
                   "vkEnumeratePhysicalDevices")) {
        return EXIT_FAILED;
    }
    if ((uint32_t)index >= count || g->info.missing[0]) {
        app_error(g->app, "device '%s' cannot be used, it lacks %s", g->info.name,
                  g->info.missing[0] ? g->info.missing : "a window system");
        return EXIT_FAILED;
    }
    g->physical_device = devices[index];
    return find_queue(g) && make_device(g) ? EXIT_DONE : EXIT_FAILED;
}

int gpu_open(gpu *g, app *a, const machine_options *options, bool validation)
{
    const uint32_t messages = g->messages; // of a device that was lost
    *g = (gpu){.app = a, .messages = messages};
    int index;
    int code = machine_choose(a, options, &index, &g->info);
    if (code == EXIT_DONE) {
        code = open_instance(g, validation);
    }
    return code == EXIT_DONE ? open_device(g, index) : code;
}

int gpu_open_library(gpu *g, const gpu *window)
{
    *g = (gpu){.app = window->app,
               .window = window,
               .info = window->info,
               .instance = window->instance,
               .physical_device = window->physical_device,
               .queue_family = window->queue_family};
    if (!make_device(g)) {
        return EXIT_FAILED;
    }
    const tyn_requirements *needs = tyn_requirements_get();
    pipeline_cache_read(&g->cache, &g->info);
    const tyn_result made = tyn_device_create(
        tyn_device_params(.instance = g->instance, .physical_device = g->physical_device,
                          .device = g->device, .get_instance_proc_addr = vkGetInstanceProcAddr,
                          .api_version = needs->api_version, .features = needs->features,
                          .queue_family = g->queue_family,
                          .debug_names = window->messenger != VK_NULL_HANDLE,
                          .pipeline_cache = g->cache.bytes, .pipeline_cache_size = g->cache.size,
                          .log = g->app->log),
        &g->tyn);
    return app_exit_code(g->app, made, false);
}

void gpu_wait_idle(gpu *g)
{
    if (g->device) {
        vkDeviceWaitIdle(g->device); // a lost device is idle as well
    }
}

void gpu_close(gpu *g)
{
    gpu_wait_idle(g);
    if (g->tyn && !g->lost) {
        pipeline_cache_write(&g->cache, g->tyn);
    }
    tyn_device_destroy(&g->tyn);
    pipeline_cache_finish(&g->cache);
    if (g->device) {
        vkDestroyDevice(g->device, NULL);
    }
    if (g->messenger) {
        PFN_vkDestroyDebugUtilsMessengerEXT unlisten =
            (PFN_vkDestroyDebugUtilsMessengerEXT)vkGetInstanceProcAddr(
                g->instance, "vkDestroyDebugUtilsMessengerEXT");
        unlisten(g->instance, g->messenger, NULL);
    }
    if (g->instance && !g->window) {
        vkDestroyInstance(g->instance, NULL);
    }
    const uint32_t messages = g->messages;
    *g = (gpu){.app = g->app, .messages = messages};
}

// ---- command buffers --------------------------------------------------------------------------

bool gpu_commands_make(gpu *g, gpu_commands *c)
{
    const VkCommandPoolCreateInfo pool = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
        .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
        .queueFamilyIndex = g->queue_family,
    };
    if (!gpu_check(g, vkCreateCommandPool(g->device, &pool, NULL, &c->pool),
                   "vkCreateCommandPool")) {
        return false;
    }
    const VkCommandBufferAllocateInfo buffer = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
        .commandPool = c->pool,
        .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
        .commandBufferCount = 1,
    };
    const VkFenceCreateInfo fence = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    return gpu_check(g, vkAllocateCommandBuffers(g->device, &buffer, &c->cmd),
                     "vkAllocateCommandBuffers") &&
           gpu_check(g, vkCreateFence(g->device, &fence, NULL, &c->fence), "vkCreateFence");
}

void gpu_commands_free(gpu *g, gpu_commands *c)
{
    if (g->device) {
        vkDestroyFence(g->device, c->fence, NULL);
        vkDestroyCommandPool(g->device, c->pool, NULL);
    }
    *c = (gpu_commands){0};
}

gpu_state gpu_wait_for(gpu *g, gpu_commands *c, double seconds)
{
    if (!c->pending) {
        return GPU_DONE;
    }
    const uint64_t timeout = seconds < 1e9 ? (uint64_t)(1e9 * seconds) : UINT64_MAX;
    const VkResult result = vkWaitForFences(g->device, 1, &c->fence, VK_TRUE, timeout);
    if (result == VK_TIMEOUT) {
        return GPU_BUSY;
    }
    c->pending = false;
    const bool done = gpu_check(g, result, "vkWaitForFences") &&
                      gpu_check(g, vkResetFences(g->device, 1, &c->fence), "vkResetFences");
    return done ? GPU_DONE : GPU_FAILED;
}

bool gpu_wait(gpu *g, gpu_commands *c)
{
    return gpu_wait_for(g, c, INFINITY) == GPU_DONE;
}

void gpu_finish(gpu *g, gpu_commands *c)
{
    if (c->pending) {
        c->pending = false;
        vkWaitForFences(g->device, 1, &c->fence, VK_TRUE, UINT64_MAX);
    }
}

bool gpu_begin(gpu *g, gpu_commands *c)
{
    const VkCommandBufferBeginInfo begin = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
        .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT,
    };
    return gpu_wait(g, c) &&
           gpu_check(g, vkBeginCommandBuffer(c->cmd, &begin), "vkBeginCommandBuffer");
}

bool gpu_submit(gpu *g, gpu_commands *c, VkSemaphore wait, VkSemaphore signal)
{
    if (!gpu_check(g, vkEndCommandBuffer(c->cmd), "vkEndCommandBuffer")) {
        return false;
    }
    const VkCommandBufferSubmitInfo commands = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO, .commandBuffer = c->cmd};
    const VkSemaphoreSubmitInfo before = {
        .sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
        .semaphore = wait,
        .stageMask = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
    };
    const VkSemaphoreSubmitInfo after = {
        .sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
        .semaphore = signal,
        .stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
    };
    const VkSubmitInfo2 submit = {
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
        .waitSemaphoreInfoCount = wait ? 1 : 0,
        .pWaitSemaphoreInfos = &before,
        .commandBufferInfoCount = 1,
        .pCommandBufferInfos = &commands,
        .signalSemaphoreInfoCount = signal ? 1 : 0,
        .pSignalSemaphoreInfos = &after,
    };
    c->pending = gpu_check(g, vkQueueSubmit2(g->queue, 1, &submit, c->fence), "vkQueueSubmit2");
    return c->pending;
}

// ---- memory -----------------------------------------------------------------------------------

static bool allocate(gpu *g, const VkMemoryRequirements *needs, VkMemoryPropertyFlags wanted,
                     VkDeviceMemory *memory)
{
    for (uint32_t i = 0; i < g->memory.memoryTypeCount; i++) {
        const VkMemoryPropertyFlags has = g->memory.memoryTypes[i].propertyFlags;
        if (needs->memoryTypeBits & 1u << i && (has & wanted) == wanted) {
            const VkMemoryAllocateInfo info = {
                .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                .allocationSize = needs->size,
                .memoryTypeIndex = i,
            };
            return gpu_check(g, vkAllocateMemory(g->device, &info, NULL, memory),
                             "vkAllocateMemory");
        }
    }
    app_error(g->app, "device '%s' has no memory of a kind that is needed", g->info.name);
    return false;
}

bool gpu_buffer_make(gpu *g, VkDeviceSize size, gpu_buffer *b)
{
    *b = (gpu_buffer){.size = size};
    const VkBufferCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
        .size = size,
        .usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
    };
    if (!gpu_check(g, vkCreateBuffer(g->device, &info, NULL, &b->buffer), "vkCreateBuffer")) {
        return false;
    }
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(g->device, b->buffer, &needs);
    const VkMemoryPropertyFlags wanted =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    return allocate(g, &needs, wanted, &b->memory) &&
           gpu_check(g, vkBindBufferMemory(g->device, b->buffer, b->memory, 0),
                     "vkBindBufferMemory") &&
           gpu_check(g, vkMapMemory(g->device, b->memory, 0, VK_WHOLE_SIZE, 0, &b->data),
                     "vkMapMemory");
}

void gpu_buffer_free(gpu *g, gpu_buffer *b)
{
    vkDestroyBuffer(g->device, b->buffer, NULL);
    vkFreeMemory(g->device, b->memory, NULL);
    *b = (gpu_buffer){0};
}

bool gpu_image_make(gpu *g, uint32_t width, uint32_t height, VkFormat format, gpu_image *image)
{
    *image = (gpu_image){.width = width, .height = height};
    const VkImageCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
        .imageType = VK_IMAGE_TYPE_2D,
        .format = format,
        .extent = {width, height, 1},
        .mipLevels = 1,
        .arrayLayers = 1,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .tiling = VK_IMAGE_TILING_OPTIMAL,
        .usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
    };
    if (!gpu_check(g, vkCreateImage(g->device, &info, NULL, &image->image), "vkCreateImage")) {
        return false;
    }
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(g->device, image->image, &needs);
    if (!allocate(g, &needs, 0, &image->memory) ||
        !gpu_check(g, vkBindImageMemory(g->device, image->image, image->memory, 0),
                   "vkBindImageMemory")) {
        return false;
    }
    const VkImageViewCreateInfo view = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
        .image = image->image,
        .viewType = VK_IMAGE_VIEW_TYPE_2D,
        .format = format,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1},
    };
    return gpu_check(g, vkCreateImageView(g->device, &view, NULL, &image->view),
                     "vkCreateImageView");
}

void gpu_image_free(gpu *g, gpu_image *image)
{
    vkDestroyImageView(g->device, image->view, NULL);
    vkDestroyImage(g->device, image->image, NULL);
    vkFreeMemory(g->device, image->memory, NULL);
    *image = (gpu_image){0};
}
