// surface.h -- what of the device is shown in the window: Vulkan surface, swapchain, render pass, presentation.
#pragma once
#include "view/gpu.h"

typedef struct GLFWwindow GLFWwindow;
enum { SURFACE_MAX_IMAGES = 8 };

typedef struct surface {
    gpu *gpu;
    GLFWwindow *window;
    VkSurfaceKHR surface;
    VkFormat format;
    VkRenderPass pass; // one colour attachment, all of it drawn over, left to be presented
    VkSwapchainKHR swapchain;
    VkExtent2D extent;
    uint32_t num_images, min_images;
    struct {
        VkImageView view;
        VkFramebuffer framebuffer;
        VkSemaphore drawn;
    } images[SURFACE_MAX_IMAGES];
    VkSemaphore acquired;
    gpu_commands commands;
    uint32_t current;
    bool stale;             // the swapchain is to be made anew
    uint32_t num_recreated; // swapchains made after the first, and surfaces
} surface;

bool surface_open(surface *s, gpu *g, GLFWwindow *window);
void surface_close(surface *s);

typedef enum surface_state {
    SURFACE_READY = 0,
    SURFACE_SKIP,   // nothing can be shown now: the window has no pixels, or changes its size
    SURFACE_FAILED, // said; the device may be lost
} surface_state;

// Begins a frame's commands, outside of the render pass. A swapchain that does not fit any more and a lost surface are
// made anew.
surface_state surface_begin(surface *s);
void surface_begin_pass(surface *s);
surface_state surface_end(surface *s); // ends the render pass, submits and presents
