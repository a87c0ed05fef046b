// swapchain.c -- see swapchain.h.
#include "swapchain.h"

#include <stdio.h>
#include <stdlib.h>

const char *const swapchain_extensions[] = {VK_KHR_SWAPCHAIN_EXTENSION_NAME, NULL};

static void require(VkResult result, const char *what)
{
    if (result != VK_SUCCESS) {
        fprintf(stderr, "embed-window: %s failed with VkResult %d\n", what, (int)result);
        exit(1);
    }
}

// Functions that host.h does not list.
#define DEVICE(h, name) ((PFN_##name)(h)->vk.GetDeviceProcAddr((h)->device, #name))
#define INSTANCE(h, name) ((PFN_##name)(h)->get_instance_proc_addr((h)->instance, #name))

// 8 bits that copies encode as sRGB.
static VkSurfaceFormatKHR choose_format(host *h, VkSurfaceKHR surface)
{
    VkSurfaceFormatKHR formats[64];
    uint32_t count = 64;
    if (INSTANCE(h, vkGetPhysicalDeviceSurfaceFormatsKHR)(h->physical_device, surface, &count,
                                                          formats) < 0) {
        count = 0;
    }
    for (uint32_t i = 0; i < count; i++) {
        if (formats[i].format == VK_FORMAT_B8G8R8A8_SRGB ||
            formats[i].format == VK_FORMAT_R8G8B8A8_SRGB) {
            return formats[i];
        }
    }
    fprintf(stderr, "embed-window: the window has no sRGB format\n");
    exit(1);
}

static VkSemaphore new_semaphore(host *h)
{
    VkSemaphore made;
    require(DEVICE(h, vkCreateSemaphore)(
                h->device,
                &(VkSemaphoreCreateInfo){.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO}, NULL,
                &made),
            "vkCreateSemaphore");
    return made;
}

void swapchain_open(host *h, swapchain *s, VkSurfaceKHR surface)
{
    *s = (swapchain){.surface = surface};
    VkBool32 presents = VK_FALSE;
    require(INSTANCE(h, vkGetPhysicalDeviceSurfaceSupportKHR)(h->physical_device, h->queue_family,
                                                              surface, &presents),
            "vkGetPhysicalDeviceSurfaceSupportKHR");
    if (!presents) {
        fprintf(stderr, "embed-window: %s does not present to this window\n", h->device_name);
        exit(1);
    }
    s->format = choose_format(h, surface);
    for (int i = 0; i < HOST_SLOTS; i++) {
        s->acquired[i] = new_semaphore(h);
    }
}

static void drop_images(host *h, swapchain *s)
{
    for (uint32_t i = 0; i < s->num_images; i++) {
        DEVICE(h, vkDestroySemaphore)(h->device, s->drawn[i], NULL);
    }
    s->num_images = 0;
}

void swapchain_close(host *h, swapchain *s)
{
    h->vk.DeviceWaitIdle(h->device);
    drop_images(h, s);
    for (int i = 0; i < HOST_SLOTS; i++) {
        DEVICE(h, vkDestroySemaphore)(h->device, s->acquired[i], NULL);
    }
    DEVICE(h, vkDestroySwapchainKHR)(h->device, s->chain, NULL);
    INSTANCE(h, vkDestroySurfaceKHR)(h->instance, s->surface, NULL);
    *s = (swapchain){0};
}

bool swapchain_resize(host *h, swapchain *s, VkExtent2D size)
{
    h->vk.DeviceWaitIdle(h->device); // the queue still presents
    VkSurfaceCapabilitiesKHR can;
    require(INSTANCE(h, vkGetPhysicalDeviceSurfaceCapabilitiesKHR)(h->physical_device, s->surface,
                                                                   &can),
            "vkGetPhysicalDeviceSurfaceCapabilitiesKHR");
    s->extent = can.currentExtent.width != UINT32_MAX ? can.currentExtent : size;
    VkSwapchainKHR old = s->chain;
    s->chain = VK_NULL_HANDLE;
    drop_images(h, s);
    if (!(can.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_DST_BIT)) {
        fprintf(stderr, "embed-window: images of the window cannot be copied into\n");
        exit(1);
    }
    const bool opaque = can.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
    if (s->extent.width && s->extent.height) {
        const uint32_t wanted = can.minImageCount + 1;
        require(DEVICE(h, vkCreateSwapchainKHR)(
                    h->device,
                    &(VkSwapchainCreateInfoKHR){
                        .sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
                        .surface = s->surface,
                        .minImageCount = can.maxImageCount && wanted > can.maxImageCount
                                             ? can.maxImageCount
                                             : wanted,
                        .imageFormat = s->format.format,
                        .imageColorSpace = s->format.colorSpace,
                        .imageExtent = s->extent,
                        .imageArrayLayers = 1,
                        .imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                        .preTransform = can.currentTransform,
                        .compositeAlpha = opaque ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                                                 : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR,
                        .presentMode = VK_PRESENT_MODE_FIFO_KHR,
                        .clipped = VK_TRUE,
                        .oldSwapchain = old,
                    },
                    NULL, &s->chain),
                "vkCreateSwapchainKHR");
        s->num_images = SWAPCHAIN_IMAGES;
        require(DEVICE(h, vkGetSwapchainImagesKHR)(h->device, s->chain, &s->num_images, s->images),
                "vkGetSwapchainImagesKHR");
        for (uint32_t i = 0; i < s->num_images; i++) {
            s->drawn[i] = new_semaphore(h);
        }
    }
    DEVICE(h, vkDestroySwapchainKHR)(h->device, old, NULL);
    return s->chain != VK_NULL_HANDLE;
}

bool swapchain_acquire(host *h, swapchain *s, uint32_t slot, uint32_t *image)
{
    host_wait(h, slot); // so that its semaphore is not waited for any more
    const VkResult got = DEVICE(h, vkAcquireNextImageKHR)(h->device, s->chain, UINT64_MAX,
                                                          s->acquired[slot], VK_NULL_HANDLE, image);
    if (got != VK_ERROR_OUT_OF_DATE_KHR && got != VK_SUBOPTIMAL_KHR) {
        require(got, "vkAcquireNextImageKHR");
    }
    return got != VK_ERROR_OUT_OF_DATE_KHR;
}

// From one state of a window's image to the next.
static void change(host *h, VkCommandBuffer cmd, VkImage image, tyn_sync from, tyn_sync to)
{
    host_image is = {.image = image, .aspect = VK_IMAGE_ASPECT_COLOR_BIT, .state = from};
    host_transition(h, cmd, &is, to);
}

void swapchain_blit(host *h, swapchain *s, VkCommandBuffer cmd, uint32_t image,
                    const host_image *from)
{
    // The stage is the one that the semaphore is waited for at.
    const tyn_sync acquired = {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_NONE,
                               VK_IMAGE_LAYOUT_UNDEFINED},
                   blitted = {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                              VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL},
                   // The signal comes after this stage.
        shown = {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_NONE,
                 VK_IMAGE_LAYOUT_PRESENT_SRC_KHR};
    change(h, cmd, s->images[image], acquired, blitted);
    const VkImageSubresourceLayers layer = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    const VkOffset3D end = {(int32_t)s->extent.width, (int32_t)s->extent.height, 1};
    const VkImageBlit all = {.srcSubresource = layer,
                             .srcOffsets = {{0, 0, 0}, end},
                             .dstSubresource = layer,
                             .dstOffsets = {{0, 0, 0}, end}};
    DEVICE(h, vkCmdBlitImage)
    (cmd, from->image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, s->images[image],
     VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &all, VK_FILTER_NEAREST);
    change(h, cmd, s->images[image], blitted, shown);
}

bool swapchain_present(host *h, swapchain *s, uint32_t slot, uint32_t image)
{
    host_submit_between(h, slot, s->acquired[slot], s->drawn[image]);
    const VkResult shown = DEVICE(h, vkQueuePresentKHR)(
        h->queue, &(VkPresentInfoKHR){.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
                                      .waitSemaphoreCount = 1,
                                      .pWaitSemaphores = &s->drawn[image],
                                      .swapchainCount = 1,
                                      .pSwapchains = &s->chain,
                                      .pImageIndices = &image});
    if (shown != VK_ERROR_OUT_OF_DATE_KHR && shown != VK_SUBOPTIMAL_KHR) {
        require(shown, "vkQueuePresentKHR");
    }
    return shown == VK_SUCCESS;
}
