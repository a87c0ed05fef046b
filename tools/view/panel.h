// panel.h -- Dear ImGui as plain C functions: the widgets that the viewer's panel is made of. One panel a process.
#pragma once
#include <stdbool.h>
#include <stdint.h>
#include <vulkan/vulkan_core.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct GLFWwindow GLFWwindow;

// Takes part in the window's callbacks: those set before are called as well.
void panel_open(GLFWwindow *window);
void panel_close(void);

// What draws it; may be closed and opened again with another device.
typedef struct panel_device {
    VkInstance instance;
    VkPhysicalDevice physical_device;
    VkDevice device;
    uint32_t queue_family;
    VkQueue queue;
    VkDescriptorPool pool; // room for one combined image sampler
    VkRenderPass pass;
    uint32_t min_images, num_images; // of the swapchain
} panel_device;
bool panel_open_device(const panel_device *device);
void panel_record_font(VkCommandBuffer cmd); // once, outside of a render pass
void panel_font_is_done(void);               // the device has run that
void panel_close_device(void);               // the device is done with the panel

void panel_begin(void); // a frame: widgets and lines follow
void panel_end(void);
void panel_record(VkCommandBuffer cmd); // in the render pass
bool panel_has_mouse(void);             // the pointer is over it, or holds one of its widgets
bool panel_has_keyboard(void);          // something is being typed

// ---- widgets: true when the user has just changed the value --------------------------------------

void panel_window(const char *title, float width, float height); // at the upper left corner; folds
void panel_window_end(void);
bool panel_section(const char *title, bool open);
void panel_text(const char *text); // wrapped
void panel_row(const char *left, const char *right);
bool panel_slider(const char *label, float *value, float low, float high, bool logarithmic);
bool panel_color(const char *label, float rgb[3]); // each 0 or more
bool panel_choice(const char *label, int *index, const char *const *names, int count);
bool panel_checkbox(const char *label, bool *value);
bool panel_button(const char *label);
// A curve of shares on a logarithmic scale, with a line at each power of ten; values are equally far apart, 0: not known.
void panel_curve(const char *label, const float *values, int count);
void panel_push(int id); // labels up to panel_pop may be those of other groups
void panel_pop(void);

// ---- over the picture, in pixels of the window ------------------------------------------------------

void panel_line(float x0, float y0, float x1, float y1, uint32_t abgr);
void panel_label(float x, float y, const char *text);

#ifdef __cplusplus
}
#endif
