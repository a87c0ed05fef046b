// capacity.c -- how many threads a device holds at once, and how long they may run.
//
// Vulkan itself does not tell. Extensions of three vendors do, as properties, which need not be enabled.
#include "gpu/device.h"
#include "gpu/needs.h"
#include <math.h>

// Of cards that do not tell; and bounds of those that do, should one tell nonsense.
enum { DISCRETE = 262144, OTHER = 8192, LEAST = 4096, MOST = 1 << 20 };

// Puts a struct of properties in front of a chain where the device has the extension.
static void ask(VkPhysicalDeviceProperties2 *all, uint64_t met, tyn_need_id extension,
                void *properties)
{
    if (tyn_need_in(met, extension)) {
        ((VkBaseOutStructure *)properties)->pNext = all->pNext;
        all->pNext = properties;
    }
}

// What an extension that the device lacks leaves at 0 makes its product 0.
static double threads_told(const tyn_procs *vk, VkPhysicalDevice device)
{
    const uint64_t met = tyn_needs_extensions(vk, device);
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
    ask(&all, met, TYN_NEED_VK_NV_shader_sm_builtins, &nv);
    ask(&all, met, TYN_NEED_VK_AMD_shader_core_properties, &amd);
    ask(&all, met, TYN_NEED_VK_AMD_shader_core_properties2, &amd2);
    ask(&all, met, TYN_NEED_VK_ARM_shader_core_builtins, &arm);
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
    VkPhysicalDeviceDriverProperties driver = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceProperties2 known = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                         .pNext = &driver};
    vk->GetPhysicalDeviceProperties2(device, &known);
    const VkPhysicalDeviceType type = known.properties.deviceType;
    const bool little = !tyn_need_in(tyn_needs_limits(&known.properties.limits),
                                     TYN_NEED_maxComputeSharedMemorySize);
    tyn_capacity c = {.software = type == VK_PHYSICAL_DEVICE_TYPE_CPU,
                      .little_shared = little,
                      .short_loops = driver.driverID == VK_DRIVER_ID_MESA_LLVMPIPE};
    if (c.software) {
        return c;
    }
    const double told = threads_told(vk, device);
    const double by_type = type == VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU ? DISCRETE : OTHER;
    const double threads = fmin(fmax(told > 0 ? told : by_type, LEAST), MOST);
    c.threads = (uint32_t)exp2(round(log2(threads)));
    return c;
}
