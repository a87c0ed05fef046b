// swapchain.h -- the host's window: what is drawn in an image of its own is copied into the window's.
#pragma once
#include "../host.h"

enum { SWAPCHAIN_IMAGES = 16 };

typedef struct swapchain {
    VkSurfaceKHR surface; // the swapchain's own once it is open
    VkSwapchainKHR chain; // null: nothing can be shown, the window has no area
    VkSurfaceFormatKHR format;
    VkExtent2D extent;
    VkImage images[SWAPCHAIN_IMAGES];
    uint32_t num_images;
    VkSemaphore acquired[HOST_SLOTS], drawn[SWAPCHAIN_IMAGES];
} swapchain;

// Extensions of the device, for host_wants.
extern const char *const swapchain_extensions[];

// Without images yet. What fails ends the program.
void swapchain_open(host *h, swapchain *s, VkSurfaceKHR surface);
void swapchain_close(host *h, swapchain *s);
// Images of the window's size now; `size` (pixels) is for windows that leave it to their host. Waits for the device.
// False: the window has no area, there is nothing to draw.
bool swapchain_resize(host *h, swapchain *s, VkExtent2D size);

// The image that comes next, for this slot's frame; false: swapchain_resize first.
bool swapchain_acquire(host *h, swapchain *s, uint32_t slot, uint32_t *image);
// Records the copy of `from`, in layout TRANSFER_SRC and of the window's extent. Linear colours become sRGB.
void swapchain_blit(host *h, swapchain *s, VkCommandBuffer cmd, uint32_t image,
                    const host_image *from);
// Submits the slot's commands and shows the image; false: swapchain_resize.
bool swapchain_present(host *h, swapchain *s, uint32_t slot, uint32_t image);
