// capacity.c -- how many threads a device holds at once.
//
// Vulkan itself does not tell. Extensions of three vendors do, as properties, which need not be enabled.
#include "gpu/device.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

// Of cards that do not tell; and bounds of those that do, should one tell nonsense.
enum { DISCRETE = 262144, OTHER = 8192, LEAST = 4096, MOST = 1 << 20 };

typedef struct extension_list {
    VkExtensionProperties *items;
    uint32_t count;
} extension_list;

// Empty where it cannot be had.
static extension_list list_extensions(const tyn_procs *vk, VkPhysicalDevice device)
{
    extension_list list = {0};
    if (vk->EnumerateDeviceExtensionProperties(device, NULL, &list.count, NULL) != VK_SUCCESS) {
        return (extension_list){0};
    }
    list.items = calloc(list.count ? list.count : 1, sizeof *list.items);
    const VkResult listed =
        list.items ? vk->EnumerateDeviceExtensionProperties(device, NULL, &list.count, list.items)
                   : VK_ERROR_OUT_OF_HOST_MEMORY;
    if (listed != VK_SUCCESS) {
        free(list.items);
        return (extension_list){0};
    }
    return list;
}

static bool has(const extension_list *list, const char *name)
{
    for (uint32_t i = 0; i < list->count; i++) {
        if (!strcmp(list->items[i].extensionName, name)) {
            return true;
        }
    }
    return false;
}

// Puts a struct of properties in front of a chain where the device has the extension.
static void ask(VkPhysicalDeviceProperties2 *all, const extension_list *list, const char *extension,
                void *properties)
{
    if (has(list, extension)) {
        ((VkBaseOutStructure *)properties)->pNext = all->pNext;
        all->pNext = properties;
    }
}

// What an extension that the device lacks leaves at 0 makes its product 0.
static double threads_told(const tyn_procs *vk, VkPhysicalDevice device, const extension_list *list)
{
    VkPhysicalDeviceSubgroupProperties core = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES};
    VkPhysicalDeviceShaderSMBuiltinsPropertiesNV nv = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_SM_BUILTINS_PROPERTIES_NV};
    VkPhysicalDeviceShaderCorePropertiesAMD amd = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_CORE_PROPERTIES_AMD};
    VkPhysicalDeviceShaderCoreProperties2AMD amd2 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_CORE_PROPERTIES_2_AMD};
    VkPhysicalDeviceShaderCoreBuiltinsPropertiesARM arm = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_CORE_BUILTINS_PROPERTIES_ARM};
    VkPhysicalDeviceProperties2 all = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                       .pNext = &core};
    ask(&all, list, VK_NV_SHADER_SM_BUILTINS_EXTENSION_NAME, &nv);
    ask(&all, list, VK_AMD_SHADER_CORE_PROPERTIES_EXTENSION_NAME, &amd);
    ask(&all, list, VK_AMD_SHADER_CORE_PROPERTIES_2_EXTENSION_NAME, &amd2);
    ask(&all, list, VK_ARM_SHADER_CORE_BUILTINS_EXTENSION_NAME, &arm);
    vk->GetPhysicalDeviceProperties2(device, &all);
    const double of_nv = (double)nv.shaderSMCount * nv.shaderWarpsPerSM * core.subgroupSize;
    const double of_arm = (double)arm.shaderCoreCount * arm.shaderWarpsPerCore * core.subgroupSize;
    // Some compute units of a shader array may be switched off: the second extension tells how many work.
    const double units = amd2.activeComputeUnitCount
                             ? amd2.activeComputeUnitCount
                             : (double)amd.shaderEngineCount * amd.shaderArraysPerEngineCount *
                                   amd.computeUnitsPerShaderArray;
    const double of_amd =
        units * amd.simdPerComputeUnit * amd.wavefrontsPerSimd * amd.wavefrontSize;
    return of_nv > 0 ? of_nv : of_amd > 0 ? of_amd : of_arm;
}

tyn_capacity tyn_device_capacity(const tyn_procs *vk, VkPhysicalDevice device)
{
    VkPhysicalDeviceProperties2 known = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
    vk->GetPhysicalDeviceProperties2(device, &known);
    const VkPhysicalDeviceType type = known.properties.deviceType;
    const bool little = known.properties.limits.maxComputeSharedMemorySize < 32768;
    if (type == VK_PHYSICAL_DEVICE_TYPE_CPU) {
        return (tyn_capacity){.software = true, .little_shared = little};
    }
    const extension_list list = list_extensions(vk, device);
    const double told = threads_told(vk, device, &list);
    free(list.items);
    const double by_type = type == VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU ? DISCRETE : OTHER;
    const double threads = fmin(fmax(told > 0 ? told : by_type, LEAST), MOST);
    return (tyn_capacity){.little_shared = little, .threads = (uint32_t)exp2(round(log2(threads)))};
}
