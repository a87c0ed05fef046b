// device.h -- the inside of tyn_device: functions, limits, samplers, pipelines.
#pragma once
#include <stdatomic.h>
#include <tyndall/device.h>
#include <tyndall/pass.h>
#include "gpu/procs.h"

typedef struct tyn_compiler tyn_compiler;
typedef struct tyn_variant tyn_variant;

// A kernel's layouts, and one pipeline per set of specialisation constants.
typedef struct tyn_pipeline {
    tyn_compiler *compiler; // the device's
    const tyn_pass_desc *pass;
    const tyn_kernel *kernel;
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    tyn_variant *variants; // a list, which grows only; under the compiler's lock
} tyn_pipeline;

struct tyn_device {
    tyn_log log;
    VkInstance instance;
    VkPhysicalDevice physical_device;
    VkDevice device;
    uint32_t queue_family;
    tyn_procs vk;
    VkPhysicalDeviceProperties properties;
    char driver[256];
    tyn_capacity capacity;
    VkPhysicalDeviceMemoryProperties memory;
    tyn_allocator allocator; // of the host, or none
    uint32_t timestamp_bits; // 0: no timestamps
    bool graphics;           // the queue family draws
    bool depth;              // format D32_SFLOAT, which drawing takes
    uint64_t image_bytes;    // the most that an image in rgba32f may take; 0: not known
    bool separate_stencil;   // separateDepthStencilLayouts is enabled
    bool debug_names;
    VkSampler clamp, repeat_x; // linear
    VkSampler nearest;         // for depth formats, which need not be filterable
    VkPipelineCache cache;
    tyn_compiler *compiler;
    tyn_pipeline **pipelines; // under the compiler's lock, as all that contexts change of a device
    uint32_t num_pipelines;
    PFN_vkGetInstanceProcAddr get_instance_proc_addr;
    // Only of a device opened by ourselves:
    bool own;
    void *loader; // NULL: get_instance_proc_addr was given
    VkDebugUtilsMessengerEXT messenger;
    VkQueue queue;
    atomic_uint validation_messages; // of any thread
};

// Logs "what: VkResult" and gives the matching tyn_result. TYN_OK for VK_SUCCESS.
tyn_result tyn_vk_check(const tyn_device *dev, VkResult result, const char *what);
// The result of a call of Vulkan that makes what `handle` points to. If it failed, nothing is there: Vulkan lets it leave
// anything.
#define TYN_VK_MADE(handle, ...) tyn_vk_made((__VA_ARGS__), handle, sizeof *(handle))
VkResult tyn_vk_made(VkResult result, void *handle, size_t size);
// Nothing happens to a handle that is 0.
void tyn_device_name_object(const tyn_device *dev, VkObjectType type, uint64_t handle,
                            const char *name);

// Of both ways to a device: the cache that was given, and who compiles.
typedef struct tyn_pipeline_params {
    const void *cache;
    size_t cache_size;
    uint32_t threads;
    tyn_jobs jobs;
} tyn_pipeline_params;

void tyn_device_describe(const tyn_procs *vk, VkPhysicalDevice device,
                         VkPhysicalDeviceProperties *properties, char driver[256]);

// capacity.c: by what the driver tells, else by the kind of device.
tyn_capacity tyn_device_capacity(const tyn_procs *vk, VkPhysicalDevice device);

// Shared by tyn_device_create and tyn_device_open: loads functions, makes samplers, cache and compiler.
tyn_result tyn_device_init(tyn_device *dev, PFN_vkGetInstanceProcAddr gipa,
                           const tyn_pipeline_params *pipelines);

// Without what is wrong with the blob, which is said.
tyn_result tyn_pipeline_cache_create(tyn_device *dev, const void *blob, size_t size);

// Finds or makes the layouts of a kernel; then the place of its pipeline for `spec` (kernel->num_spec values), which is
// made by compiler.h. Any thread.
tyn_result tyn_pipeline_get(tyn_device *dev, const tyn_pass_desc *pass, uint32_t kernel,
                            tyn_pipeline **out);
tyn_result tyn_variant_get(tyn_pipeline *pipeline, const uint32_t *spec, tyn_variant **out);
// Makes a pipeline, whatever is in the table, and tells if the cache had it. Logs nothing. Any thread.
VkResult tyn_pipeline_compile(const tyn_device *dev, const tyn_pipeline *pipeline,
                              const uint32_t *spec, VkPipeline *out, bool *cached);
// The descriptor type of a binding.
VkDescriptorType tyn_descriptor_type(const tyn_pass_desc *pass, const tyn_binding *binding);
// The stages that see a kernel's bindings and push constants.
VkShaderStageFlags tyn_kernel_stages(const tyn_kernel *kernel);

// Finds only; VK_NULL_HANDLE if it was never made. Any thread.
VkPipeline tyn_pipeline_find(const tyn_pipeline *pipeline, const uint32_t *spec);
void tyn_pipelines_destroy(tyn_device *dev); // none may be queued or under way
