// vulkan_tap.h -- a vkGetInstanceProcAddr between a program and Vulkan, which counts calls and lets chosen ones fail.
//
// A call that is to fail never reaches the driver, and leaves rubbish where its results belong, as Vulkan allows. Functions of
// Vulkan know nothing of who calls them, so there is one tap in a process. Counting is atomic; a plan is for one thread.
#pragma once
#include <stdbool.h>
#include <stdint.h>
#include <vulkan/vulkan_core.h>

typedef struct tap_counts {
    uint32_t calls;   // of functions that may fail
    uint32_t creates; // vkCreate*, vkAllocateCommandBuffers: objects
    uint32_t memory;  // vkAllocateMemory, vkMapMemory
    uint32_t submits; // vkQueueSubmit2
    uint32_t waits;   // for fences, queues, the device; query results with VK_QUERY_RESULT_WAIT_BIT
    uint32_t commands; // vkCmd*
    uint32_t frees;    // vkDestroy*, vkFreeMemory
} tap_counts;

// Functions that it does not know are `real`'s own.
PFN_vkGetInstanceProcAddr tap_open(PFN_vkGetInstanceProcAddr real);
tap_counts tap_since(void); // the last tap_clear
void tap_clear(void);
int tap_live(
    void); // objects and memory, made less ended: 0 = nothing is left of what was made through it
uint64_t
tap_most_memory(void); // bytes from vkAllocateMemory at one time, since this was asked last
// The call with this number since tap_clear (1 = the next) fails with `error`; 0 = none. With `from_then_on` all later ones as well,
// as those of a lost device do.
void tap_fail(uint32_t call, VkResult error, bool from_then_on);
// What has failed last: "vkCreateImage"; "" = nothing.
const char *tap_failed(void);
