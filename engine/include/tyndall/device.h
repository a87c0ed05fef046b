// device.h -- Tyndall on a Vulkan device: a host's, or one of its own. Tier 1.
#pragma once
#include "base.h"
#include <vulkan/vulkan_core.h> // types only; functions come from get_instance_proc_addr

#ifdef __cplusplus
extern "C" {
#endif

// Pipelines and memory on a VkDevice. Contexts of one device may be used by several threads at once, a context by one; they
// share its pipelines. The log may then be called by all of these. Several device objects on one VkDevice are fine.
typedef struct tyn_device tyn_device;

// A host's job system, which compiles kernels in place of threads of ours (tyn_frame.background).
typedef struct tyn_jobs {
    // Has run(job) called once for each call of submit: on any thread, now or later, several at once. A job compiles one
    // kernel, which takes milliseconds to seconds. Called by prepare and record, on their thread. After tyn_device_destroy
    // a job that has not run yet does nothing, but has to be run to free what it holds.
    void (*submit)(void *user, void (*run)(void *job), void *job); // NULL: there is none
    void *user;
} tyn_jobs;

// What to enable before vkCreateDevice. Static data; tyn_device_create checks it again and names
// what is missing.
typedef struct tyn_requirements {
    uint32_t api_version;                      // lowest accepted
    const VkPhysicalDeviceFeatures2 *features; // chain of what must be enabled
    const char *const *extensions;             // NULL-terminated (none today)
} tyn_requirements;
TYN_API const tyn_requirements *tyn_requirements_get(void);

// All that the library asks of a device, in one table: devices are chosen and made by it. `tyndall info --devices` prints it.
typedef struct tyn_need {
    const char *kind;     // "Vulkan", "feature", "limit", "format", "queue", "extension"
    const char *name;     // as Vulkan has it
    uint32_t least;       // of a limit
    const char *use;      // what it is for
    const char *fallback; // what is done without it; NULL: a device without it cannot be used
} tyn_need;
TYN_API const tyn_need *tyn_needs(uint32_t *count); // static data; at most 64

// ---- memory of the host's ---------------------------------------------------------------------

// A block of device memory that is asked for. Buffers and images both are put into it.
typedef struct tyn_memory_request {
    VkMemoryRequirements requirements; // size, alignment: bytes; memoryTypeBits: one type
    bool mapped;                       // `mapped` has to be filled
} tyn_memory_request;

typedef struct tyn_allocation {
    VkDeviceMemory memory;
    VkDeviceSize offset; // of the block, bytes; a multiple of the alignment
    void *mapped;        // address of the block's first byte, until it is freed
    void *handle;        // the host's own
} tyn_allocation;

// Where device memory comes from, if not from vkAllocateMemory: vmaAllocateMemory and vmaFreeMemory in a few lines
// (docs/embedding.md). Few blocks are asked for, of 1 to 256 MiB or of one resource that is larger. Only tyn_context_prepare
// asks, tyn_context_prepare and tyn_context_destroy free.
typedef struct tyn_allocator {
    // Out of memory ends the call under way with TYN_ERR_MEMORY, other errors with TYN_ERR_DEVICE.
    VkResult (*allocate)(void *user, const tyn_memory_request *request, tyn_allocation *out);
    void (*free)(void *user, const tyn_allocation *allocation);
    void *user;
} tyn_allocator;

// ---- the device -------------------------------------------------------------------------------

typedef struct tyn_device_params {
    size_t struct_size TYN_PARAMS_SIZE(tyn_device_params); // sizeof; set by the macro
    VkInstance instance;                                   // Required, borrowed
    VkPhysicalDevice physical_device;                      // Required
    VkDevice device;                                       // Required, borrowed
    PFN_vkGetInstanceProcAddr get_instance_proc_addr;      // Required
    uint32_t api_version;                      // Required: as given in VkApplicationInfo
    const VkPhysicalDeviceFeatures2 *features; // Required: as enabled on `device`
    uint32_t queue_family;      // of the command buffers we will be given: one with compute, and
                                // with graphics if scenes are to have surfaces
    bool debug_names;           // VK_EXT_debug_utils is enabled: name objects, label nodes
    const void *pipeline_cache; // from an earlier tyn_device_pipeline_cache; may be NULL
    size_t
        pipeline_cache_size; // what is damaged, or another driver's, is ignored with a line in the log
    uint32_t compile_threads; // 0..16 that compile kernels in the background; 0 = by the machine, 4
                              // at most. Started when something is to be compiled there
    tyn_jobs jobs;            // in their place
    tyn_allocator allocator;  // both functions, or none: vkAllocateMemory
    tyn_log log;
} tyn_device_params;
#define tyn_device_params(...) TYN_PARAMS(tyn_device_params, __VA_ARGS__)
TYN_API tyn_result tyn_device_create(const tyn_device_params *params, tyn_device **out);
// The GPU must be done with our work. What is being compiled is waited for, what waits to be compiled is not.
TYN_API void tyn_device_destroy(tyn_device **dev);

// A device of our own: loads the Vulkan loader at run time, makes instance, device and queue.
typedef struct tyn_device_open_params {
    size_t struct_size TYN_PARAMS_SIZE(tyn_device_open_params);
    // Index or part of the name; NULL = the first discrete, integrated, then any.
    const char *select;
    bool validation; // validation and synchronization validation; messages go to the log as errors
    const void *pipeline_cache; // this and what follows as in tyn_device_params
    size_t pipeline_cache_size;
    uint32_t compile_threads;
    tyn_jobs jobs;
    // Where all functions of Vulkan come from; NULL = the loader's, libvulkan.so.1.
    PFN_vkGetInstanceProcAddr get_instance_proc_addr;
    tyn_log log;
} tyn_device_open_params;
#define tyn_device_open_params(...) TYN_PARAMS(tyn_device_open_params, __VA_ARGS__)
TYN_API tyn_result tyn_device_open(const tyn_device_open_params *params, tyn_device **out);

// Validation messages since the device was opened (0 without validation).
TYN_API uint32_t tyn_device_validation_messages(const tyn_device *dev);

TYN_API const char *tyn_device_name(const tyn_device *dev);
TYN_API const char *tyn_device_driver(const tyn_device *dev);

// How much a device does at once. Dispatches are sized by it (<tyndall/extend/dispatch_sizes.h>).
typedef struct tyn_capacity {
    bool software;      // a processor
    bool little_shared; // a workgroup has less than 32 KiB of shared memory; Vulkan promises 16
    bool short_loops;   // the loops of a thread end after 65535 turns in all: lavapipe
    uint32_t threads;   // that a card holds at once, a power of two; 0 of a processor
} tyn_capacity;

// Lists devices of this machine: fills up to `max` entries, returns how many there are (or < 0).
typedef struct tyn_device_info {
    char name[256], driver[256], missing[256]; // missing: first unmet requirement, "" = usable
    uint32_t api_version;
    const char *type; // "discrete", "integrated", "virtual", "cpu", "other"
    uint64_t heap_bytes;
    uint64_t met; // bit i: the device has tyn_needs()[i]
    tyn_capacity capacity;
} tyn_device_info;
TYN_API int tyn_devices_list(tyn_device_info *infos, uint32_t max, const tyn_log *log);

// The compiled kernels as bytes to keep, for the next device's `pipeline_cache`. With `blob` NULL *size becomes how many
// there are; else *size says how many `blob` has room for and becomes how many were written: if kernels have been compiled
// since, those that have room. Any thread.
TYN_API tyn_result tyn_device_pipeline_cache(tyn_device *dev, void *blob, size_t *size);

// Since the device was made. Any thread.
typedef struct tyn_pipeline_stats {
    uint32_t compiled;   // kernels, one for each choice of its constants
    uint32_t from_cache; // of these: the driver had them from `pipeline_cache`, as far as it tells
    double seconds;      // in the driver's calls, of all threads together
} tyn_pipeline_stats;
TYN_API void tyn_device_pipelines(tyn_device *dev, tyn_pipeline_stats *stats);

// ---- host images ----------------------------------------------------------------------------

// An exact synchronisation state.
typedef struct tyn_sync {
    VkPipelineStageFlags2 stages;
    VkAccessFlags2 access;
    VkImageLayout layout;
} tyn_sync;

// A host image: never destroyed by us; alive until the GPU work is done.
typedef struct tyn_image {
    VkImage image;
    VkImageView view; // of mip 0, layer 0; for a depth image a depth-only view
    VkFormat format;
    VkExtent3D extent;
    VkImageUsageFlags usage;
    // 0 = all that the format has. DEPTH alone of a format with stencil is for devices with separateDepthStencilLayouts.
    VkImageAspectFlags aspect;
    tyn_sync before, after; // state on entry, trusted; state left behind, guaranteed
} tyn_image;

#ifdef __cplusplus
} // extern "C"

// The same, of a reference.
inline tyn_result tyn_device_create(const tyn_device_params &params, tyn_device **out)
{
    return tyn_device_create(&params, out);
}
inline tyn_result tyn_device_open(const tyn_device_open_params &params, tyn_device **out)
{
    return tyn_device_open(&params, out);
}
#endif
