// needs.h -- all that the library asks of a device, in one table: devices are chosen, made and listed by it.
#pragma once
#include <tyndall/device.h>
#include <tyndall/pass.h>
#include "gpu/procs.h"

// A limit that kernels of some passes exceed on small devices (pipeline.c).
#define TYN_NEED_REFUSED                                                                           \
    "a kernel that binds more than the device takes is refused when a scene needs it"
#define TYN_NEED_LARGER "a scene that needs a larger one is refused in a line that names it"
#define TYN_MOST_SIDE 16384                                             // of pictures, pixels
#define TYN_NEED_BY_KIND "262144 if such a card is discrete, else 8192" // capacity.c

// What a row is for, and the fallback without it; NULL: none, the device cannot be used.
// VERSION(name, version)       F10, F12, F13(feature's name, 1 if required: it is enabled; the feature's own structure)
// LIMIT(name, least)           FORMAT(name, features)         QUEUE(name, condition on `family`)         EXTENSION(name)
// clang-format off
#define TYN_NEEDS(VERSION, F10, F12, F13, LIMIT, FORMAT, QUEUE, EXTENSION) \
    VERSION(version, VK_API_VERSION_1_3, "SPIR-V 1.6, and functions of all passes", NULL) \
    F10(shaderStorageImageExtendedFormats, 1, MAX_ENUM, "images of one and two channels that kernels write", NULL) \
    F12(scalarBlockLayout, 1, PHYSICAL_DEVICE_SCALAR_BLOCK_LAYOUT_FEATURES, "one definition of a struct for C and GLSL", NULL) \
    F13(synchronization2, 1, PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES, "barriers and submissions", NULL) \
    F13(maintenance4, 1, PHYSICAL_DEVICE_MAINTENANCE_4_FEATURES, "LocalSizeId and relaxed interfaces, which glslang may emit", NULL) \
    F13(dynamicRendering, 1, PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES, "drawing surfaces", NULL) \
    QUEUE(compute, (family->queueFlags & VK_QUEUE_COMPUTE_BIT) != 0, "all passes", NULL) \
    LIMIT(maxComputeWorkGroupInvocations, 256, "workgroups of 256 threads", NULL) \
    LIMIT(maxComputeWorkGroupSize, 256, "... in one dimension", NULL) \
    FORMAT(R16_SFLOAT, SAMPLED_IMAGE_FILTER_LINEAR_BIT, "filtered reads of density", NULL) \
    FORMAT(R32_SFLOAT, SAMPLED_IMAGE_FILTER_LINEAR_BIT | VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT, "filtered reads, and writes, of mean density and distances", NULL) \
    FORMAT(R32G32_SFLOAT, SAMPLED_IMAGE_FILTER_LINEAR_BIT | VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT, "filtered reads, and writes, of tables of phase functions", NULL) \
    FORMAT(R32G32B32A32_SFLOAT, SAMPLED_IMAGE_FILTER_LINEAR_BIT | VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT, "filtered reads, and writes, of light", NULL) \
    QUEUE(graphics, (family->queueFlags & VK_QUEUE_GRAPHICS_BIT) != 0, "drawing surfaces", "scenes with surfaces are refused") \
    QUEUE(timestamps, family->timestampValidBits != 0, "times of passes, and samples of a record by them", "no times in reports; samples of a record by an estimate") \
    FORMAT(D32_SFLOAT, DEPTH_STENCIL_ATTACHMENT_BIT | VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT, "depth of drawn surfaces and shadow maps, which kernels read", "scenes with surfaces are refused") \
    LIMIT(maxImageDimension2D, TYN_MOST_SIDE, "pictures of 16384 pixels a side; shadow maps", "smaller pictures, fewer samples of surfaces; a map that is larger is refused in a line that names it") \
    LIMIT(maxImageDimension3D, 2048, "volumes of 2048 voxels a side; light of several suns and lamps in one image", TYN_NEED_LARGER) \
    LIMIT(maxStorageBufferRange, 134217728, "buffers of 128 MiB", NULL) \
    LIMIT(maxDrawIndexedIndexValue, TYN_MOST_INDEX, "vertices of surfaces under a sky", "all devices have it; scenes with more are refused") \
    LIMIT(maxTexelBufferElements, 33554432, "... read as texels of 4 bytes", TYN_NEED_LARGER) \
    LIMIT(maxComputeSharedMemorySize, 32768, "coarse levels of the lattice in one workgroup", "fewer cells in it") \
    LIMIT(maxPerStageDescriptorStorageImages, 11, "most images that a kernel writes", TYN_NEED_REFUSED) \
    LIMIT(maxPerStageDescriptorStorageBuffers, 10, "most buffers of a kernel", TYN_NEED_REFUSED) \
    LIMIT(maxPerStageDescriptorSampledImages, 27, "most images and texel buffers that a kernel reads", TYN_NEED_REFUSED) \
    LIMIT(maxPerStageDescriptorSamplers, 17, "most images that a kernel filters", TYN_NEED_REFUSED) \
    F12(separateDepthStencilLayouts, 0, PHYSICAL_DEVICE_SEPARATE_DEPTH_STENCIL_LAYOUTS_FEATURES, "a host's depth without its stencil", "a host names both aspects of its image") \
    EXTENSION(VK_NV_shader_sm_builtins, "threads that a card of NVIDIA holds at once", TYN_NEED_BY_KIND) \
    EXTENSION(VK_AMD_shader_core_properties, "threads that a card of AMD holds at once", TYN_NEED_BY_KIND) \
    EXTENSION(VK_AMD_shader_core_properties2, "... without compute units that are switched off", "all count") \
    EXTENSION(VK_ARM_shader_core_builtins, "threads that a card of ARM holds at once", TYN_NEED_BY_KIND)
// clang-format on

typedef enum tyn_need_id {
#define TYN_NEED_ID(name, ...) TYN_NEED_##name,
    TYN_NEEDS(TYN_NEED_ID, TYN_NEED_ID, TYN_NEED_ID, TYN_NEED_ID, TYN_NEED_ID, TYN_NEED_ID,
              TYN_NEED_ID, TYN_NEED_ID) TYN_NUM_NEEDS
#undef TYN_NEED_ID
} tyn_need_id;

// Sets of rows: bit i is tyn_needs()[i].
static inline bool tyn_need_in(uint64_t set, tyn_need_id id)
{
    return set >> id & 1;
}

// The first required row that `met` lacks: "feature scalarBlockLayout (one definition of a struct for C and GLSL)"; or "".
void tyn_need_unmet(uint64_t met, char out[256]);

uint64_t tyn_needs_features(const VkPhysicalDeviceFeatures2 *enabled); // rows of features alone
uint64_t tyn_needs_limits(const VkPhysicalDeviceLimits *limits);       // rows of limits alone
uint64_t tyn_needs_extensions(const tyn_procs *vk, VkPhysicalDevice device); // none where not told
uint64_t tyn_needs_of_device(const tyn_procs *vk, VkPhysicalDevice device, uint32_t queue_family);
