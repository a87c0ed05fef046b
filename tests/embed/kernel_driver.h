// kernel_driver.h -- between the library and the driver: makes kernels slow to compile, lets them fail, keeps a pipeline
// cache of its own, and tells what it was asked for. When a kernel is compiled is then no accident.
#pragma once
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <vulkan/vulkan_core.h>

enum { KEPT_BYTES = 16 };

// One a process: Vulkan's functions get handles only.
typedef struct kernel_driver {
    atomic_int ms;        // that a kernel takes which is not in the cache
    atomic_int fail;      // so many more kernels fail
    atomic_int under_way; // kernels
    atomic_int most;      // of them at once
    bool compile_anew;    // else the driver below compiles what is equal once only
    bool keeps;   // it has a pipeline cache, which holds everything once it was given `kept`
    bool refuses; // to start with a cache
    char kept[KEPT_BYTES];
    char given[KEPT_BYTES];   // to the newest cache
    atomic_size_t given_size; // bytes
} kernel_driver;
extern kernel_driver driver;

// To be called in place of `below`.
PFN_vkGetInstanceProcAddr kernel_driver_start(PFN_vkGetInstanceProcAddr below);
void kernel_driver_reset(void);
// Destroys what was kept of all devices of the library's on `device`.
void kernel_driver_finish(VkDevice device);
