// fake_vulkan.h -- a device without a GPU: counts objects, writes what is recorded as text, and can run
// out of memory on demand. For tests of the render graph.
#pragma once
#include "gpu/device.h"

typedef struct fake_vulkan {
    tyn_device dev;
    char *text; // commands since fake_clear, one a line
    size_t used, cap;
    uint32_t live;    // objects and allocations that exist
    uint32_t created; // ever
    uint32_t memory,
        kernels; // of these: allocations of memory, and pipelines with what belongs to them
    VkDeviceSize bytes, most_bytes; // of device memory: now, and at most; a test may set it back
    uint32_t fail_at;               // the create or allocate call with this number fails; 0 = none
    bool no_sets;                   // descriptor sets cannot be allocated
    bool recording;                 // nothing may be created now
    uint32_t created_while_recording;
    uint32_t dispatches, copies; // since fake_clear
    char log[4096];              // error lines, each ended by '\n'
} fake_vulkan;

fake_vulkan *fake_create(void);
// Fails the test if something still exists.
void fake_destroy(fake_vulkan **fake);
void fake_clear(fake_vulkan *fake);
// An image of the host's, with a view; gone with fake_free_image.
tyn_image fake_image(fake_vulkan *fake, const char *name, VkExtent3D extent);
void fake_free_image(fake_vulkan *fake, tyn_image *image);
