// host.h -- a small renderer of somebody else's: its own Vulkan instance, device, queue and images.
//
// It stands for the program that Tyndall is embedded in. It knows Tyndall only through
// tyn_requirements_get(), whose features, and nothing else, it enables.
#pragma once
#include <stdbool.h>
#include <stdint.h>
#include <tyndall/device.h>
#include <vulkan/vulkan.h> // types; every function is fetched through vkGetInstanceProcAddr

#define HOST_INSTANCE_PROCS(X)                                                                     \
    X(DestroyInstance)                                                                             \
    X(EnumeratePhysicalDevices)                                                                    \
    X(GetPhysicalDeviceProperties)                                                                 \
    X(GetPhysicalDeviceMemoryProperties)                                                           \
    X(GetPhysicalDeviceQueueFamilyProperties)                                                      \
    X(CreateDevice)                                                                                \
    X(GetDeviceProcAddr)

#define HOST_DEVICE_PROCS(X)                                                                       \
    X(DestroyDevice)                                                                               \
    X(DeviceWaitIdle)                                                                              \
    X(GetDeviceQueue)                                                                              \
    X(CreateCommandPool)                                                                           \
    X(DestroyCommandPool)                                                                          \
    X(AllocateCommandBuffers)                                                                      \
    X(BeginCommandBuffer)                                                                          \
    X(EndCommandBuffer)                                                                            \
    X(CreateFence)                                                                                 \
    X(DestroyFence)                                                                                \
    X(WaitForFences)                                                                               \
    X(ResetFences)                                                                                 \
    X(QueueSubmit2)                                                                                \
    X(CreateImage)                                                                                 \
    X(DestroyImage)                                                                                \
    X(GetImageMemoryRequirements)                                                                  \
    X(BindImageMemory)                                                                             \
    X(CreateImageView)                                                                             \
    X(DestroyImageView)                                                                            \
    X(CreateBuffer)                                                                                \
    X(DestroyBuffer)                                                                               \
    X(GetBufferMemoryRequirements)                                                                 \
    X(BindBufferMemory)                                                                            \
    X(AllocateMemory)                                                                              \
    X(FreeMemory)                                                                                  \
    X(MapMemory)                                                                                   \
    X(CmdPipelineBarrier2)                                                                         \
    X(CmdCopyImageToBuffer)                                                                        \
    X(CmdCopyBufferToImage)

typedef struct host_procs {
#define X(name) PFN_vk##name name;
    HOST_INSTANCE_PROCS(X)
    HOST_DEVICE_PROCS(X)
#undef X
} host_procs;

enum { HOST_SLOTS = 2 }; // frames in flight

typedef struct host {
    void *loader;
    PFN_vkGetInstanceProcAddr get_instance_proc_addr;
    VkInstance instance;
    VkDebugUtilsMessengerEXT messenger;
    uint32_t messages; // of the validation layers
    bool quiet;        // they are counted but not printed
    VkPhysicalDevice physical_device;
    VkPhysicalDeviceMemoryProperties memory;
    char device_name[VK_MAX_PHYSICAL_DEVICE_NAME_SIZE];
    VkDevice device;
    uint32_t queue_family;
    VkQueue queue;
    VkCommandPool pools[HOST_SLOTS];
    VkCommandBuffer commands[HOST_SLOTS];
    VkFence fences[HOST_SLOTS];
    bool pending[HOST_SLOTS];
    host_procs vk;
} host;

typedef enum host_status { HOST_OK = 0, HOST_NO_DEVICE, HOST_FAILED } host_status;

// What a host needs beside that, for a window say. Lists of names end with NULL; NULL: none.
typedef struct host_wants {
    bool validation; // and synchronization validation, where the layer is installed
    const char *const *instance_extensions, *const *device_extensions;
} host_wants;

// Opens the first device that can do what Tyndall asks for and has what is wanted. Says on stderr
// what went wrong.
host_status host_open_with(host *h, const host_wants *wants);
host_status host_open(host *h, bool validation);
void host_close(host *h); // everything made on it must be gone

// What tyn_device_create wants to know.
void host_describe(const host *h, tyn_device_params *params);

// The command buffer of a frame slot, begun; waits until the slot's earlier work is done.
VkCommandBuffer host_begin(host *h, uint32_t slot);
void host_submit(host *h, uint32_t slot);
// The same; `before` is waited for before images are copied into, `after` is signalled at the end.
void host_submit_between(host *h, uint32_t slot, VkSemaphore before, VkSemaphore after);
void host_wait(host *h, uint32_t slot);

typedef struct host_image {
    VkImage image;
    VkImageView view;
    VkDeviceMemory memory;
    VkFormat format;
    VkExtent3D extent;
    VkImageUsageFlags usage;
    VkImageAspectFlags aspect;
    tyn_sync state; // where the host's last command left it
} host_image;

host_image host_image_new(host *h, VkFormat format, VkExtent3D extent, VkImageUsageFlags usage);
void host_image_free(host *h, host_image *image);
// Records the change from the image's state to another.
void host_transition(host *h, VkCommandBuffer cmd, host_image *image, tyn_sync to);
// As Tyndall takes it, from the image's state to `after`, which becomes the image's state.
tyn_image host_lend(host_image *image, tyn_sync after);

typedef struct host_buffer {
    VkBuffer buffer;
    VkDeviceMemory memory;
    void *data; // mapped, coherent
    VkDeviceSize size;
} host_buffer;

host_buffer host_buffer_new(host *h, VkDeviceSize size);
void host_buffer_free(host *h, host_buffer *buffer);
// The image must be in layout TRANSFER_DST or GENERAL, TRANSFER_SRC or GENERAL.
void host_upload(host *h, VkCommandBuffer cmd, const host_buffer *from, host_image *to);
void host_download(host *h, VkCommandBuffer cmd, const host_image *from, const host_buffer *to);

// A flat card of the host's scene, in pixels from the upper left corner, at one depth-buffer value.
typedef struct host_card {
    uint32_t x, y, width, height;
    float color[4];
    float depth;
} host_card;

// Paints cards in order, later ones over earlier ones: what a host would draw with its own pipelines.
// `color` holds four floats a pixel, `depth` one.
void host_paint(const host_buffer *color, const host_buffer *depth, uint32_t width, uint32_t height,
                const host_card *cards, uint32_t num_cards);
