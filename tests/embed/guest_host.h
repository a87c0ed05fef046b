// guest_host.h -- a host that draws stripes and cards at depths of its choice and lets Tyndall record over them; its scenes, its
// frames, and what they must look like.
#pragma once
#include <tyndall/context.h>

#include "host.h"

enum { WIDTH = 80, HEIGHT = 56, VOXELS = 24 };

typedef struct fixture {
    host host;
    tyn_device *guest;
    tyn_device *own; // of the offline reference
    tyn_settings *settings;
    uint32_t errors; // lines of level error in the log
    bool quiet;      // they are expected
} fixture;

typedef struct target {
    host_image color, depth;
    host_buffer color_up, depth_up, color_down, depth_down;
    bool half;
} target;

typedef struct frame_states {
    const char *name;
    tyn_sync color_before, color_after, depth_before, depth_after;
    bool no_depth;
    VkFormat color_format;
} frame_states;

typedef struct picture {
    float *radiance, *transmittance; // four floats a pixel
} picture;

tyn_log log_of(fixture *f);
tyn_device *new_guest(fixture *f);
int set_up(void **state);
int tear_down(void **state);
tyn_context *new_context(fixture *f, tyn_device *dev, const char *method);
// A box of 2 m about the origin with a soft ball of smoke in it, and a sun.
void make_smoke(tyn_scene *scene);
// The same box, filled evenly with something that only absorbs: transmittance has a closed form.
void make_ink(tyn_scene *scene);
// A view of `width` x `height` pixels along -z from (x, 0, 5).
tyn_view make_view(float x, uint32_t width, uint32_t height, uint32_t outputs);
// How the host made its depth: Vulkan clip space, y down.
void projection(const tyn_view *view, bool reverse_z, float m[16]);
// The depth-buffer value of a plane at `distance` in front of the camera.
float depth_of(const float m[16], float distance);
target new_target(host *h, uint32_t width, uint32_t height, VkFormat color_format);
void free_target(host *h, target *t);
// A backdrop of stripes at the value `far` of the depth buffer.
void paint_backdrop(target *t, float far);
// What was painted as floats, if the image holds halves.
void pack(target *t);
float color_at(const target *t, uint32_t x, uint32_t y, int channel);
void begin_frame(fixture *f, VkCommandBuffer cmd, target *t, const frame_states *s);
// The host goes on from where it was promised to find its images: it reads them.
void end_frame(fixture *f, VkCommandBuffer cmd, target *t);
tyn_result prepare_frame(tyn_context *ctx, const tyn_scene *scene, const tyn_view *view, target *t,
                         const frame_states *s, const float *m, const tyn_image *density);
tyn_result record_frame(tyn_context *ctx, VkCommandBuffer cmd, const tyn_scene *scene,
                        const tyn_view *view, target *t, const frame_states *s, const float *m,
                        const tyn_image *density);
// The same view, offline, on a device of Tyndall's own.
picture reference(fixture *f, const char *method, const tyn_scene *scene, tyn_view view);
void free_picture(picture *p);
// Backdrop x transmittance + radiance everywhere, the host's alpha and depth as they were.
void check_composite(const target *t, const picture *p);
void expect_silence(const fixture *f);
frame_states usual_states(void);
// The usual images, with the backdrop at this depth, as the host has them before a frame.
target painted_target(fixture *f, float depth);
// Prepares and records a frame over usual images, and waits for it.
void run_frame(fixture *f, tyn_context *ctx, const tyn_scene *scene, const tyn_view *view,
               target *t, const float m[16]);
