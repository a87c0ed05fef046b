// surface.c -- what of the device is shown in the window: Vulkan surface, swapchain, render pass, presentation.
#include "view/surface.h"
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <stdlib.h>

static uint32_t between(uint32_t low, uint32_t value, uint32_t high)
{
    return value < low ? low : value > high ? high : value;
}

// ---- surface ----------------------------------------------------------------------------------

// 8 bits that the shader has encoded.
static bool choose_format(surface *s, VkSurfaceFormatKHR *chosen)
{
    VkSurfaceFormatKHR formats[64];
    uint32_t count = ARRAY_SIZE(formats);
    if (!gpu_check(s->gpu,
                   vkGetPhysicalDeviceSurfaceFormatsKHR(s->gpu->physical_device, s->surface, &count,
                                                        formats),
                   "vkGetPhysicalDeviceSurfaceFormatsKHR")) {
        return false;
    }
    *chosen = formats[0];
    for (uint32_t i = count; i-- > 0;) {
        if (formats[i].format == VK_FORMAT_B8G8R8A8_UNORM ||
            formats[i].format == VK_FORMAT_R8G8B8A8_UNORM) {
            *chosen = formats[i];
        }
    }
    return true;
}

static bool make_surface(surface *s)
{
    gpu *g = s->gpu;
    VkBool32 presents = VK_FALSE;
    if (!gpu_check(g, glfwCreateWindowSurface(g->instance, s->window, NULL, &s->surface),
                   "glfwCreateWindowSurface") ||
        !gpu_check(g,
                   vkGetPhysicalDeviceSurfaceSupportKHR(g->physical_device, g->queue_family,
                                                        s->surface, &presents),
                   "vkGetPhysicalDeviceSurfaceSupportKHR")) {
        return false;
    }
    if (!presents) {
        app_error(g->app, "device '%s' cannot present to this window", g->info.name);
    }
    return presents;
}

static bool make_pass(surface *s)
{
    VkSurfaceFormatKHR format;
    if (!choose_format(s, &format)) {
        return false;
    }
    s->format = format.format;
    const VkAttachmentDescription attachment = {
        .format = s->format,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .loadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
        .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
        .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED,
        .finalLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR,
    };
    const VkAttachmentReference color = {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkSubpassDescription subpass = {
        .pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
        .colorAttachmentCount = 1,
        .pColorAttachments = &color,
    };
    const VkSubpassDependency acquired = {
        .srcSubpass = VK_SUBPASS_EXTERNAL,
        .dstSubpass = 0,
        .srcStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
        .dstStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
        .dstAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
    };
    const VkRenderPassCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
        .attachmentCount = 1,
        .pAttachments = &attachment,
        .subpassCount = 1,
        .pSubpasses = &subpass,
        .dependencyCount = 1,
        .pDependencies = &acquired,
    };
    return gpu_check(s->gpu, vkCreateRenderPass(s->gpu->device, &info, NULL, &s->pass),
                     "vkCreateRenderPass");
}

bool surface_open(surface *s, gpu *g, GLFWwindow *window)
{
    *s = (surface){.gpu = g, .window = window, .stale = true};
    const VkSemaphoreCreateInfo semaphore = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    return make_surface(s) && make_pass(s) && gpu_commands_make(g, &s->commands) &&
           gpu_check(g, vkCreateSemaphore(g->device, &semaphore, NULL, &s->acquired),
                     "vkCreateSemaphore");
}

// ---- swapchain --------------------------------------------------------------------------------

static void drop_images(surface *s)
{
    VkDevice device = s->gpu->device;
    for (uint32_t i = 0; i < s->num_images; i++) {
        vkDestroyFramebuffer(device, s->images[i].framebuffer, NULL);
        vkDestroyImageView(device, s->images[i].view, NULL);
        vkDestroySemaphore(device, s->images[i].drawn, NULL);
        s->images[i].framebuffer = VK_NULL_HANDLE;
        s->images[i].view = VK_NULL_HANDLE;
        s->images[i].drawn = VK_NULL_HANDLE;
    }
    s->num_images = 0;
}

void surface_close(surface *s)
{
    if (!s->gpu || !s->gpu->device) {
        return;
    }
    gpu_wait_idle(s->gpu);
    drop_images(s);
    vkDestroySwapchainKHR(s->gpu->device, s->swapchain, NULL);
    vkDestroySemaphore(s->gpu->device, s->acquired, NULL);
    gpu_commands_free(s->gpu, &s->commands);
    vkDestroyRenderPass(s->gpu->device, s->pass, NULL);
    vkDestroySurfaceKHR(s->gpu->instance, s->surface, NULL);
    *s = (surface){0};
}

static bool make_images(surface *s)
{
    gpu *g = s->gpu;
    VkImage images[SURFACE_MAX_IMAGES];
    uint32_t count = SURFACE_MAX_IMAGES;
    if (!gpu_check(g, vkGetSwapchainImagesKHR(g->device, s->swapchain, &count, images),
                   "vkGetSwapchainImagesKHR")) {
        return false;
    }
    s->num_images = count;
    bool made = true;
    for (uint32_t i = 0; made && i < count; i++) {
        const VkImageViewCreateInfo view = {
            .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
            .image = images[i],
            .viewType = VK_IMAGE_VIEW_TYPE_2D,
            .format = s->format,
            .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1},
        };
        made = gpu_check(g, vkCreateImageView(g->device, &view, NULL, &s->images[i].view),
                         "vkCreateImageView");
        const VkFramebufferCreateInfo framebuffer = {
            .sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
            .renderPass = s->pass,
            .attachmentCount = 1,
            .pAttachments = &s->images[i].view,
            .width = s->extent.width,
            .height = s->extent.height,
            .layers = 1,
        };
        const VkSemaphoreCreateInfo semaphore = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
        made = made &&
               gpu_check(
                   g, vkCreateFramebuffer(g->device, &framebuffer, NULL, &s->images[i].framebuffer),
                   "vkCreateFramebuffer") &&
               gpu_check(g, vkCreateSemaphore(g->device, &semaphore, NULL, &s->images[i].drawn),
                         "vkCreateSemaphore");
    }
    return made;
}

// VK_ERROR_SURFACE_LOST_KHR is for the caller to mend, and is not said.
static VkResult make_swapchain(surface *s, VkExtent2D size)
{
    gpu *g = s->gpu;
    VkSurfaceCapabilitiesKHR can;
    VkResult result =
        vkGetPhysicalDeviceSurfaceCapabilitiesKHR(g->physical_device, s->surface, &can);
    VkSurfaceFormatKHR format;
    if (result < 0) {
        return result;
    }
    if (!choose_format(s, &format) || format.format != s->format) {
        app_error(g->app, "the window's new surface has another format");
        return VK_ERROR_FORMAT_NOT_SUPPORTED;
    }
    const bool given = can.currentExtent.width != UINT32_MAX;
    s->extent.width =
        between(can.minImageExtent.width, given ? can.currentExtent.width : size.width,
                can.maxImageExtent.width);
    s->extent.height =
        between(can.minImageExtent.height, given ? can.currentExtent.height : size.height,
                can.maxImageExtent.height);
    if (s->extent.width == 0 || s->extent.height == 0) {
        return VK_NOT_READY;
    }
    uint32_t most = can.maxImageCount ? can.maxImageCount : SURFACE_MAX_IMAGES;
    s->min_images = between(can.minImageCount, 3, most < SURFACE_MAX_IMAGES - 2 ? most : 5);
    VkSwapchainKHR old = s->swapchain;
    const VkSwapchainCreateInfoKHR info = {
        .sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
        .surface = s->surface,
        .minImageCount = s->min_images,
        .imageFormat = format.format,
        .imageColorSpace = format.colorSpace,
        .imageExtent = s->extent,
        .imageArrayLayers = 1,
        .imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
        .preTransform = can.currentTransform,
        .compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR,
        .presentMode = VK_PRESENT_MODE_FIFO_KHR,
        .clipped = VK_TRUE,
        .oldSwapchain = old,
    };
    s->swapchain = VK_NULL_HANDLE;
    result = vkCreateSwapchainKHR(g->device, &info, NULL, &s->swapchain);
    drop_images(s);
    vkDestroySwapchainKHR(g->device, old, NULL);
    if (result == VK_SUCCESS && !make_images(s)) {
        result = VK_ERROR_INITIALIZATION_FAILED;
    }
    return result;
}

static bool renew_surface(surface *s)
{
    gpu_wait_idle(s->gpu);
    drop_images(s);
    vkDestroySwapchainKHR(s->gpu->device, s->swapchain, NULL);
    s->swapchain = VK_NULL_HANDLE;
    vkDestroySurfaceKHR(s->gpu->instance, s->surface, NULL);
    s->surface = VK_NULL_HANDLE;
    s->stale = true;
    s->num_recreated++;
    return make_surface(s);
}

static surface_state renew_swapchain(surface *s, VkExtent2D size)
{
    if (!gpu_wait(s->gpu, &s->commands)) {
        return SURFACE_FAILED;
    }
    gpu_wait_idle(s->gpu);
    VkResult result = make_swapchain(s, size);
    if (result == VK_ERROR_SURFACE_LOST_KHR) {
        return renew_surface(s) ? SURFACE_SKIP : SURFACE_FAILED;
    }
    if (result == VK_NOT_READY || result == VK_ERROR_OUT_OF_DATE_KHR) {
        return SURFACE_SKIP;
    }
    s->num_recreated++;
    s->stale = result != VK_SUCCESS;
    return gpu_check(s->gpu, result, "making the swapchain") ? SURFACE_READY : SURFACE_FAILED;
}

// ---- frames -----------------------------------------------------------------------------------

static surface_state mend(surface *s, VkResult result, const char *what)
{
    if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR) {
        s->stale = true;
        return SURFACE_SKIP;
    }
    if (result == VK_ERROR_SURFACE_LOST_KHR) {
        return renew_surface(s) ? SURFACE_SKIP : SURFACE_FAILED;
    }
    return gpu_check(s->gpu, result, what) ? SURFACE_SKIP : SURFACE_FAILED;
}

surface_state surface_begin(surface *s)
{
    int width, height;
    glfwGetFramebufferSize(s->window, &width, &height);
    if (width <= 0 || height <= 0 || glfwGetWindowAttrib(s->window, GLFW_ICONIFIED)) {
        return SURFACE_SKIP;
    }
    const VkExtent2D size = {(uint32_t)width, (uint32_t)height};
    if (s->stale || size.width != s->extent.width || size.height != s->extent.height) {
        const surface_state state = renew_swapchain(s, size);
        if (state != SURFACE_READY) {
            return state;
        }
    }
    if (!gpu_wait(s->gpu, &s->commands)) {
        return SURFACE_FAILED;
    }
    const VkResult result = vkAcquireNextImageKHR(s->gpu->device, s->swapchain, 1000000000,
                                                  s->acquired, VK_NULL_HANDLE, &s->current);
    if (result == VK_SUBOPTIMAL_KHR) {
        s->stale = true; // this image can still be shown
    } else if (result != VK_SUCCESS) {
        return mend(s, result, "vkAcquireNextImageKHR");
    }
    return gpu_begin(s->gpu, &s->commands) ? SURFACE_READY : SURFACE_FAILED;
}

void surface_begin_pass(surface *s)
{
    VkCommandBuffer cmd = s->commands.cmd;
    const VkRenderPassBeginInfo begin = {
        .sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
        .renderPass = s->pass,
        .framebuffer = s->images[s->current].framebuffer,
        .renderArea = {.extent = s->extent},
    };
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
    const VkViewport viewport = {0, 0, (float)s->extent.width, (float)s->extent.height, 0, 1};
    vkCmdSetViewport(cmd, 0, 1, &viewport);
    vkCmdSetScissor(cmd, 0, 1, &begin.renderArea);
}

surface_state surface_end(surface *s)
{
    vkCmdEndRenderPass(s->commands.cmd);
    VkSemaphore drawn = s->images[s->current].drawn;
    if (!gpu_submit(s->gpu, &s->commands, s->acquired, drawn)) {
        return SURFACE_FAILED;
    }
    const VkPresentInfoKHR present = {
        .sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
        .waitSemaphoreCount = 1,
        .pWaitSemaphores = &drawn,
        .swapchainCount = 1,
        .pSwapchains = &s->swapchain,
        .pImageIndices = &s->current,
    };
    const VkResult result = vkQueuePresentKHR(s->gpu->queue, &present);
    return result == VK_SUCCESS ? SURFACE_READY : mend(s, result, "vkQueuePresentKHR");
}
