// calls.c -- results of Vulkan's functions, and names of what they make.
#include "gpu/device.h"
#include <string.h>

tyn_result tyn_vk_check(const tyn_device *dev, VkResult result, const char *what)
{
    if (result == VK_SUCCESS) {
        return TYN_OK;
    }
    bool memory = result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY;
    tyn_log_print(&dev->log, TYN_LOG_ERROR, "%s failed with VkResult %d%s", what, (int)result,
                  memory                           ? " (out of memory)"
                  : result == VK_ERROR_DEVICE_LOST ? " (device lost)"
                                                   : "");
    return memory ? TYN_ERR_MEMORY : TYN_ERR_DEVICE;
}

VkResult tyn_vk_made(VkResult result, void *handle, size_t size)
{
    if (result != VK_SUCCESS) {
        memset(handle, 0, size);
    }
    return result;
}

void tyn_device_name_object(const tyn_device *dev, VkObjectType type, uint64_t handle,
                            const char *name)
{
    if (!handle || !dev->debug_names || !dev->vk.SetDebugUtilsObjectNameEXT || !name) {
        return;
    }
    dev->vk.SetDebugUtilsObjectNameEXT(
        dev->device, &(VkDebugUtilsObjectNameInfoEXT){
                         .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
                         .objectType = type,
                         .objectHandle = handle,
                         .pObjectName = name,
                     });
}
