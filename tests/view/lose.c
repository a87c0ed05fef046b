// lose.c -- preloaded into the viewer: one Vulkan call fails once, as LOSE says ("surface-present", "device-submit").
#include <dlfcn.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <vulkan/vulkan.h>

enum { AFTER = 8 }; // calls

// True at one call, of the kind and the place that LOSE names.
static bool lose(const char *kind, const char *place, unsigned *calls)
{
    const char *wanted = getenv("LOSE");
    const size_t length = strlen(kind);
    if (!wanted || strncmp(wanted, kind, length) != 0 || wanted[length] != '-' ||
        strcmp(wanted + length + 1, place) != 0 || ++*calls != AFTER) {
        return false;
    }
    fprintf(stderr, "%s lost once\n", wanted);
    return true;
}

static VkResult presented(const char *place, unsigned calls[2])
{
    if (lose("surface", place, &calls[0])) {
        return VK_ERROR_SURFACE_LOST_KHR;
    }
    return lose("date", place, &calls[1]) ? VK_ERROR_OUT_OF_DATE_KHR : VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL vkAcquireNextImageKHR(VkDevice device, VkSwapchainKHR swapchain,
                                                     uint64_t timeout, VkSemaphore semaphore,
                                                     VkFence fence, uint32_t *index)
{
    static unsigned calls[2];
    const VkResult result = presented("acquire", calls);
    PFN_vkAcquireNextImageKHR next;
    *(void **)&next = dlsym(RTLD_NEXT, "vkAcquireNextImageKHR");
    return result != VK_SUCCESS ? result
                                : next(device, swapchain, timeout, semaphore, fence, index);
}

VKAPI_ATTR VkResult VKAPI_CALL vkQueuePresentKHR(VkQueue queue, const VkPresentInfoKHR *info)
{
    static unsigned calls[2];
    PFN_vkQueuePresentKHR next;
    *(void **)&next = dlsym(RTLD_NEXT, "vkQueuePresentKHR");
    const VkResult done = next(queue, info);
    const VkResult result = presented("present", calls); // after: the semaphores are waited for
    return result != VK_SUCCESS ? result : done;
}

VKAPI_ATTR VkResult VKAPI_CALL vkQueueSubmit2(VkQueue queue, uint32_t count,
                                              const VkSubmitInfo2 *submits, VkFence fence)
{
    static unsigned calls;
    PFN_vkQueueSubmit2 next;
    *(void **)&next = dlsym(RTLD_NEXT, "vkQueueSubmit2");
    return lose("device", "submit", &calls) ? VK_ERROR_DEVICE_LOST
                                            : next(queue, count, submits, fence);
}

VKAPI_ATTR VkResult VKAPI_CALL vkWaitForFences(VkDevice device, uint32_t count,
                                               const VkFence *fences, VkBool32 all,
                                               uint64_t timeout)
{
    static unsigned calls;
    PFN_vkWaitForFences next;
    *(void **)&next = dlsym(RTLD_NEXT, "vkWaitForFences");
    const VkResult done = next(device, count, fences, all, timeout);
    return lose("device", "fence", &calls) ? VK_ERROR_DEVICE_LOST : done;
}
