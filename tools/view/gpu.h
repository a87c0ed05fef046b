// gpu.h -- the viewer's own Vulkan devices: instance, device, queue, command buffers.
//
// There are two of one instance: one draws the window, on the other the library is a guest. A queue does one thing after another,
// and many devices have a single one: on it the window would wait for a picture that takes seconds.
//
// Vulkan is linked here, as Dear ImGui's backend needs it. What fails is one log line; a lost device sets `lost`, and then
// everything made on it is to be closed and made anew.
#pragma once
#include "machine.h"
#include <vulkan/vulkan.h>

typedef struct gpu {
    app *app;
    uint32_t messages; // of the validation layer
    bool lost;
    const struct gpu *window; // the device that this one shares the instance with; NULL: its own
    tyn_device_info info;
    VkInstance instance;
    VkDebugUtilsMessengerEXT messenger;
    VkPhysicalDevice physical_device;
    VkPhysicalDeviceMemoryProperties memory;
    VkDevice device;
    uint32_t queue_family;
    VkQueue queue;
    pipeline_cache cache;
    tyn_device *tyn; // the library on this device; NULL: the window's
} gpu;

// Opens the device that --device names, with what GLFW needs to present. Gives the exit code; gpu_close is due in any
// case.
int gpu_open(gpu *g, app *a, const machine_options *options, bool validation);
// The same device once more, for the library. To be closed before `window`, which stays where it is.
int gpu_open_library(gpu *g, const gpu *window);
void gpu_close(gpu *g);
void gpu_wait_idle(gpu *g);

// False: a log line about `what`, and `lost` if that is it.
bool gpu_check(gpu *g, VkResult result, const char *what);

// ---- command buffers --------------------------------------------------------------------------

typedef struct gpu_commands {
    VkCommandPool pool;
    VkCommandBuffer cmd;
    VkFence fence;
    bool pending;
} gpu_commands;

bool gpu_commands_make(gpu *g, gpu_commands *c);
void gpu_commands_free(gpu *g, gpu_commands *c);
bool gpu_begin(gpu *g, gpu_commands *c); // waits until its last work is done
// Semaphores may be VK_NULL_HANDLE; `wait` is waited for where colour is drawn.
bool gpu_submit(gpu *g, gpu_commands *c, VkSemaphore wait, VkSemaphore signal);
bool gpu_wait(gpu *g, gpu_commands *c);
typedef enum gpu_state { GPU_DONE = 0, GPU_BUSY, GPU_FAILED } gpu_state;
gpu_state gpu_wait_for(gpu *g, gpu_commands *c, double seconds); // at most
void gpu_finish(gpu *g, gpu_commands *c);                        // waits, on a lost device as well

// ---- memory -----------------------------------------------------------------------------------

typedef struct gpu_buffer { // mapped and coherent: for uploads
    VkBuffer buffer;
    VkDeviceMemory memory;
    void *data;
    VkDeviceSize size;
} gpu_buffer;
bool gpu_buffer_make(gpu *g, VkDeviceSize size, gpu_buffer *b);
void gpu_buffer_free(gpu *g, gpu_buffer *b);

typedef struct gpu_image { // a 2D picture, copied to and sampled
    VkImage image;
    VkImageView view;
    VkDeviceMemory memory;
    uint32_t width, height;
} gpu_image;
bool gpu_image_make(gpu *g, uint32_t width, uint32_t height, VkFormat format, gpu_image *image);
void gpu_image_free(gpu *g, gpu_image *image);
