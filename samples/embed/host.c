// host.c -- a small renderer of somebody else's. What fails here ends the program: it is not the
// subject.
#include "host.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void require(VkResult result, const char *what)
{
    if (result != VK_SUCCESS) {
        fprintf(stderr, "host: %s failed with VkResult %d\n", what, (int)result);
        exit(1);
    }
}

// ---- instance and device ----------------------------------------------------------------------

static VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                 VkDebugUtilsMessageTypeFlagsEXT types,
                                                 const VkDebugUtilsMessengerCallbackDataEXT *data,
                                                 void *user)
{
    (void)severity;
    (void)types;
    host *h = user;
    h->messages++;
    if (!h->quiet) {
        fprintf(stderr, "host: validation: %s\n", data->pMessage);
    }
    return VK_FALSE;
}

static VkDebugUtilsMessengerCreateInfoEXT messenger_info(host *h)
{
    return (VkDebugUtilsMessengerCreateInfoEXT){
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                           VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT |
                       VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT,
        .pfnUserCallback = on_message,
        .pUserData = h,
    };
}

enum { MOST_EXTENSIONS = 16 };

// Adds names to a list of at most MOST_EXTENSIONS.
static uint32_t add_names(const char **list, uint32_t count, const char *const *names)
{
    for (; names && *names && count < MOST_EXTENSIONS; names++) {
        list[count++] = *names;
    }
    return count;
}

static bool open_instance(host *h, const host_wants *wants)
{
    const bool validation = wants->validation;
    h->loader = dlopen("libvulkan.so.1", RTLD_NOW | RTLD_LOCAL);
    if (!h->loader) {
        fprintf(stderr, "host: no Vulkan loader: %s\n", dlerror());
        return false;
    }
    *(void **)&h->get_instance_proc_addr = dlsym(h->loader, "vkGetInstanceProcAddr");
    PFN_vkCreateInstance create =
        (PFN_vkCreateInstance)h->get_instance_proc_addr(NULL, "vkCreateInstance");

    // Hazards between submissions are looked for only when the layer is told so from outside.
    if (validation) {
        setenv("VK_LAYER_ENABLES",
               "VALIDATION_CHECK_ENABLE_SYNCHRONIZATION_VALIDATION_QUEUE_SUBMIT", 1);
    }
    const VkDebugUtilsMessengerCreateInfoEXT messages = messenger_info(h);
    const VkValidationFeatureEnableEXT enables[] = {
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    const VkValidationFeaturesEXT features = {
        .sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
        .pNext = &messages,
        .enabledValidationFeatureCount = 1,
        .pEnabledValidationFeatures = enables,
    };
    const VkApplicationInfo app = {
        .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
        .pApplicationName = "host",
        .apiVersion = tyn_requirements_get()->api_version,
    };
    const char *const layers[] = {"VK_LAYER_KHRONOS_validation"};
    const char *const debug[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME, NULL};
    const char *extensions[MOST_EXTENSIONS];
    const uint32_t num_extensions =
        add_names(extensions, add_names(extensions, 0, wants->instance_extensions),
                  validation ? debug : NULL);
    const VkResult made = create(
        &(VkInstanceCreateInfo){
            .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
            .pNext = validation ? &features : NULL,
            .pApplicationInfo = &app,
            .enabledLayerCount = validation ? 1 : 0,
            .ppEnabledLayerNames = layers,
            .enabledExtensionCount = num_extensions,
            .ppEnabledExtensionNames = extensions,
        },
        NULL, &h->instance);
    if (made != VK_SUCCESS) {
        fprintf(stderr, "host: no Vulkan instance (VkResult %d)%s\n", (int)made,
                made == VK_ERROR_LAYER_NOT_PRESENT ? ": the validation layer is not installed"
                                                   : "");
        return false;
    }
#define X(name) h->vk.name = (PFN_vk##name)h->get_instance_proc_addr(h->instance, "vk" #name);
    HOST_INSTANCE_PROCS(X)
#undef X
    if (validation) {
        PFN_vkCreateDebugUtilsMessengerEXT listen =
            (PFN_vkCreateDebugUtilsMessengerEXT)h->get_instance_proc_addr(
                h->instance, "vkCreateDebugUtilsMessengerEXT");
        require(listen(h->instance, &messages, NULL, &h->messenger), "the debug messenger");
    }
    return true;
}

// A queue that draws and computes.
static bool find_queue(host *h)
{
    VkQueueFamilyProperties families[16];
    uint32_t count = 16;
    h->vk.GetPhysicalDeviceQueueFamilyProperties(h->physical_device, &count, families);
    for (uint32_t i = 0; i < count; i++) {
        const VkQueueFlags wanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
        if ((families[i].queueFlags & wanted) == wanted) {
            h->queue_family = i;
            return true;
        }
    }
    return false;
}

static bool open_device(host *h, const host_wants *wants)
{
    const tyn_requirements *needs = tyn_requirements_get();
    VkPhysicalDevice devices[8];
    uint32_t count = 8;
    if (h->vk.EnumeratePhysicalDevices(h->instance, &count, devices) < 0) {
        count = 0;
    }
    for (uint32_t i = 0; i < count && !h->device; i++) {
        VkPhysicalDeviceProperties properties;
        h->vk.GetPhysicalDeviceProperties(devices[i], &properties);
        h->physical_device = devices[i];
        if (properties.apiVersion < needs->api_version || !find_queue(h)) {
            continue;
        }
        const char *extensions[MOST_EXTENSIONS];
        const uint32_t num_extensions = add_names(
            extensions, add_names(extensions, 0, needs->extensions), wants->device_extensions);
        const float priority = 1.0f;
        const VkDeviceQueueCreateInfo queue = {
            .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
            .queueFamilyIndex = h->queue_family,
            .queueCount = 1,
            .pQueuePriorities = &priority,
        };
        // The required features and not one more; a device without them refuses.
        const VkResult made = h->vk.CreateDevice(h->physical_device,
                                                 &(VkDeviceCreateInfo){
                                                     .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                                     .pNext = needs->features,
                                                     .queueCreateInfoCount = 1,
                                                     .pQueueCreateInfos = &queue,
                                                     .enabledExtensionCount = num_extensions,
                                                     .ppEnabledExtensionNames = extensions,
                                                 },
                                                 NULL, &h->device);
        if (made == VK_SUCCESS) {
            snprintf(h->device_name, sizeof(h->device_name), "%s", properties.deviceName);
        }
    }
    if (!h->device) {
        fprintf(stderr, "host: no Vulkan device with the features that Tyndall requires\n");
        return false;
    }
#define X(name) h->vk.name = (PFN_vk##name)h->vk.GetDeviceProcAddr(h->device, "vk" #name);
    HOST_DEVICE_PROCS(X)
#undef X
    h->vk.GetPhysicalDeviceMemoryProperties(h->physical_device, &h->memory);
    h->vk.GetDeviceQueue(h->device, h->queue_family, 0, &h->queue);
    return true;
}

host_status host_open(host *h, bool validation)
{
    return host_open_with(h, &(host_wants){.validation = validation});
}

host_status host_open_with(host *h, const host_wants *wants)
{
    *h = (host){0};
    if (!open_instance(h, wants) || !open_device(h, wants)) {
        host_close(h);
        return HOST_NO_DEVICE;
    }
    for (uint32_t i = 0; i < HOST_SLOTS; i++) {
        require(
            h->vk.CreateCommandPool(h->device,
                                    &(VkCommandPoolCreateInfo){
                                        .sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                        .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                        .queueFamilyIndex = h->queue_family,
                                    },
                                    NULL, &h->pools[i]),
            "vkCreateCommandPool");
        require(h->vk.AllocateCommandBuffers(
                    h->device,
                    &(VkCommandBufferAllocateInfo){
                        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                        .commandPool = h->pools[i],
                        .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                        .commandBufferCount = 1,
                    },
                    &h->commands[i]),
                "vkAllocateCommandBuffers");
        require(h->vk.CreateFence(
                    h->device, &(VkFenceCreateInfo){.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO},
                    NULL, &h->fences[i]),
                "vkCreateFence");
    }
    return HOST_OK;
}

void host_close(host *h)
{
    if (h->device) {
        h->vk.DeviceWaitIdle(h->device);
        for (uint32_t i = 0; i < HOST_SLOTS; i++) {
            h->vk.DestroyFence(h->device, h->fences[i], NULL);
            h->vk.DestroyCommandPool(h->device, h->pools[i], NULL);
        }
        h->vk.DestroyDevice(h->device, NULL);
    }
    if (h->messenger) {
        PFN_vkDestroyDebugUtilsMessengerEXT unlisten =
            (PFN_vkDestroyDebugUtilsMessengerEXT)h->get_instance_proc_addr(
                h->instance, "vkDestroyDebugUtilsMessengerEXT");
        unlisten(h->instance, h->messenger, NULL);
    }
    if (h->instance) {
        h->vk.DestroyInstance(h->instance, NULL);
    }
    if (h->loader) {
        dlclose(h->loader);
    }
    const uint32_t messages = h->messages;
    *h = (host){.messages = messages};
}

void host_describe(const host *h, tyn_device_params *params)
{
    const tyn_requirements *needs = tyn_requirements_get();
    params->instance = h->instance;
    params->physical_device = h->physical_device;
    params->device = h->device;
    params->get_instance_proc_addr = h->get_instance_proc_addr;
    params->api_version = needs->api_version;
    params->features = needs->features;
    params->queue_family = h->queue_family;
    params->debug_names = h->messenger != VK_NULL_HANDLE;
}

// ---- frames -----------------------------------------------------------------------------------

VkCommandBuffer host_begin(host *h, uint32_t slot)
{
    host_wait(h, slot);
    require(h->vk.BeginCommandBuffer(h->commands[slot],
                                     &(VkCommandBufferBeginInfo){
                                         .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                         .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT,
                                     }),
            "vkBeginCommandBuffer");
    return h->commands[slot];
}

void host_submit(host *h, uint32_t slot)
{
    host_submit_between(h, slot, VK_NULL_HANDLE, VK_NULL_HANDLE);
}

void host_submit_between(host *h, uint32_t slot, VkSemaphore before, VkSemaphore after)
{
    const VkSemaphoreSubmitInfo wait = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                                        .semaphore = before,
                                        .stageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT},
                                signal = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                                          .semaphore = after,
                                          .stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT};
    require(h->vk.EndCommandBuffer(h->commands[slot]), "vkEndCommandBuffer");
    require(h->vk.QueueSubmit2(h->queue, 1,
                               &(VkSubmitInfo2){
                                   .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
                                   .waitSemaphoreInfoCount = before ? 1 : 0,
                                   .pWaitSemaphoreInfos = &wait,
                                   .commandBufferInfoCount = 1,
                                   .pCommandBufferInfos =
                                       &(VkCommandBufferSubmitInfo){
                                           .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                           .commandBuffer = h->commands[slot],
                                       },
                                   .signalSemaphoreInfoCount = after ? 1 : 0,
                                   .pSignalSemaphoreInfos = &signal,
                               },
                               h->fences[slot]),
            "vkQueueSubmit2");
    h->pending[slot] = true;
}

void host_wait(host *h, uint32_t slot)
{
    if (h->pending[slot]) {
        require(h->vk.WaitForFences(h->device, 1, &h->fences[slot], VK_TRUE, UINT64_MAX),
                "vkWaitForFences");
        require(h->vk.ResetFences(h->device, 1, &h->fences[slot]), "vkResetFences");
        h->pending[slot] = false;
    }
}

// ---- images and buffers -----------------------------------------------------------------------

static VkDeviceMemory allocate(host *h, const VkMemoryRequirements *needs,
                               VkMemoryPropertyFlags wanted)
{
    for (uint32_t i = 0; i < h->memory.memoryTypeCount; i++) {
        const VkMemoryPropertyFlags has = h->memory.memoryTypes[i].propertyFlags;
        if (!(needs->memoryTypeBits & 1u << i) || (has & wanted) != wanted) {
            continue;
        }
        VkDeviceMemory memory;
        require(h->vk.AllocateMemory(h->device,
                                     &(VkMemoryAllocateInfo){
                                         .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                         .allocationSize = needs->size,
                                         .memoryTypeIndex = i,
                                     },
                                     NULL, &memory),
                "vkAllocateMemory");
        return memory;
    }
    fprintf(stderr, "host: no memory type for this resource\n");
    exit(1);
}

host_image host_image_new(host *h, VkFormat format, VkExtent3D extent, VkImageUsageFlags usage)
{
    const bool is_depth = format == VK_FORMAT_D32_SFLOAT || format == VK_FORMAT_D16_UNORM ||
                          format == VK_FORMAT_D32_SFLOAT_S8_UINT ||
                          format == VK_FORMAT_D24_UNORM_S8_UINT;
    host_image image = {
        .format = format,
        .extent = extent,
        .usage = usage,
        .aspect = is_depth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT,
    };
    const bool is_3d = extent.depth > 1;
    require(h->vk.CreateImage(h->device,
                              &(VkImageCreateInfo){
                                  .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                  .imageType = is_3d ? VK_IMAGE_TYPE_3D : VK_IMAGE_TYPE_2D,
                                  .format = format,
                                  .extent = extent,
                                  .mipLevels = 1,
                                  .arrayLayers = 1,
                                  .samples = VK_SAMPLE_COUNT_1_BIT,
                                  .tiling = VK_IMAGE_TILING_OPTIMAL,
                                  .usage = usage,
                              },
                              NULL, &image.image),
            "vkCreateImage");
    VkMemoryRequirements needs;
    h->vk.GetImageMemoryRequirements(h->device, image.image, &needs);
    image.memory = allocate(h, &needs, 0);
    require(h->vk.BindImageMemory(h->device, image.image, image.memory, 0), "vkBindImageMemory");
    require(
        h->vk.CreateImageView(h->device,
                              &(VkImageViewCreateInfo){
                                  .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                  .image = image.image,
                                  .viewType = is_3d ? VK_IMAGE_VIEW_TYPE_3D : VK_IMAGE_VIEW_TYPE_2D,
                                  .format = format,
                                  .subresourceRange = {image.aspect, 0, 1, 0, 1},
                              },
                              NULL, &image.view),
        "vkCreateImageView");
    return image;
}

void host_image_free(host *h, host_image *image)
{
    h->vk.DestroyImageView(h->device, image->view, NULL);
    h->vk.DestroyImage(h->device, image->image, NULL);
    h->vk.FreeMemory(h->device, image->memory, NULL);
    *image = (host_image){0};
}

// Barriers are of all aspects of a format.
static VkImageAspectFlags whole_aspect(const host_image *image)
{
    const bool stencil = image->format == VK_FORMAT_D32_SFLOAT_S8_UINT ||
                         image->format == VK_FORMAT_D24_UNORM_S8_UINT;
    return image->aspect | (stencil ? VK_IMAGE_ASPECT_STENCIL_BIT : 0);
}

void host_transition(host *h, VkCommandBuffer cmd, host_image *image, tyn_sync to)
{
    h->vk.CmdPipelineBarrier2(cmd,
                              &(VkDependencyInfo){
                                  .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                  .imageMemoryBarrierCount = 1,
                                  .pImageMemoryBarriers =
                                      &(VkImageMemoryBarrier2){
                                          .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                          .srcStageMask = image->state.stages,
                                          .srcAccessMask = image->state.access,
                                          .dstStageMask = to.stages,
                                          .dstAccessMask = to.access,
                                          .oldLayout = image->state.layout,
                                          .newLayout = to.layout,
                                          .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                          .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                          .image = image->image,
                                          .subresourceRange = {whole_aspect(image), 0, 1, 0, 1},
                                      },
                              });
    image->state = to;
}

tyn_image host_lend(host_image *image, tyn_sync after)
{
    const tyn_image lent = {
        .image = image->image,
        .view = image->view,
        .format = image->format,
        .extent = image->extent,
        .usage = image->usage,
        .before = image->state,
        .after = after,
    };
    image->state = after;
    return lent;
}

host_buffer host_buffer_new(host *h, VkDeviceSize size)
{
    host_buffer buffer = {.size = size};
    require(h->vk.CreateBuffer(h->device,
                               &(VkBufferCreateInfo){
                                   .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                   .size = size,
                                   .usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                            VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                                            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                               },
                               NULL, &buffer.buffer),
            "vkCreateBuffer");
    VkMemoryRequirements needs;
    h->vk.GetBufferMemoryRequirements(h->device, buffer.buffer, &needs);
    buffer.memory = allocate(
        h, &needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    require(h->vk.BindBufferMemory(h->device, buffer.buffer, buffer.memory, 0),
            "vkBindBufferMemory");
    require(h->vk.MapMemory(h->device, buffer.memory, 0, VK_WHOLE_SIZE, 0, &buffer.data),
            "vkMapMemory");
    return buffer;
}

void host_buffer_free(host *h, host_buffer *buffer)
{
    h->vk.DestroyBuffer(h->device, buffer->buffer, NULL);
    h->vk.FreeMemory(h->device, buffer->memory, NULL); // unmaps
    *buffer = (host_buffer){0};
}

static VkBufferImageCopy whole(const host_image *image)
{
    return (VkBufferImageCopy){
        .imageSubresource = {image->aspect, 0, 0, 1},
        .imageExtent = image->extent,
    };
}

void host_upload(host *h, VkCommandBuffer cmd, const host_buffer *from, host_image *to)
{
    const VkBufferImageCopy copy = whole(to);
    h->vk.CmdCopyBufferToImage(cmd, from->buffer, to->image, to->state.layout, 1, &copy);
}

void host_download(host *h, VkCommandBuffer cmd, const host_image *from, const host_buffer *to)
{
    const VkBufferImageCopy copy = whole(from);
    h->vk.CmdCopyImageToBuffer(cmd, from->image, from->state.layout, to->buffer, 1, &copy);
    // The processor reads it after the fence.
    h->vk.CmdPipelineBarrier2(cmd, &(VkDependencyInfo){
                                       .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                       .memoryBarrierCount = 1,
                                       .pMemoryBarriers =
                                           &(VkMemoryBarrier2){
                                               .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                               .srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT,
                                               .srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                               .dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT,
                                               .dstAccessMask = VK_ACCESS_2_HOST_READ_BIT,
                                           },
                                   });
}

// ---- drawing ----------------------------------------------------------------------------------

void host_paint(const host_buffer *color, const host_buffer *depth, uint32_t width, uint32_t height,
                const host_card *cards, uint32_t num_cards)
{
    float *colors = color->data, *depths = depth->data;
    for (uint32_t i = 0; i < num_cards; i++) {
        const host_card *c = &cards[i];
        for (uint32_t y = c->y; y < c->y + c->height && y < height; y++) {
            for (uint32_t x = c->x; x < c->x + c->width && x < width; x++) {
                const size_t pixel = (size_t)y * width + x;
                memcpy(colors + 4 * pixel, c->color, sizeof(c->color));
                depths[pixel] = c->depth;
            }
        }
    }
}
