// rig.h -- a small host with one volume scene and one picture, for tests of how Tyndall behaves in it: a ball of smoke before a map,
// above a floor, with a sun and a lamp, so that grids, maps of shadows, drawn surfaces and the lattice are all there.
#pragma once
#include <tyndall/context.h>
#include <tyndall/registry.h>
#include "host.h"

enum { RIG_WIDTH = 32, RIG_HEIGHT = 24 };

typedef struct rig {
    host host;
    tyn_settings *settings; // small grids
    tyn_scene scene;
    tyn_view view;
    host_image color;
    host_buffer black, picture; // four floats a pixel
    uint32_t errors;            // lines of level error in the log
    bool quiet;                 // they are expected, and not printed
    char last_error[256];
} rig;

// False: there is no device.
bool rig_open(rig *r, bool validation);
void rig_close(rig *r); // contexts and devices are destroyed
tyn_log rig_log(rig *r);
// `tap`: functions of Vulkan through vulkan_tap.h. TYN_OK, or what tyn_device_create says; `allocator` may be NULL.
tyn_result rig_device(rig *r, bool tap, const tyn_allocator *allocator, tyn_device **out);
tyn_result rig_context(rig *r, tyn_device *dev, const char *method, tyn_context **out);
// Of this many pixels.
void rig_resize(rig *r, uint32_t width, uint32_t height);
tyn_result rig_prepare(rig *r, tyn_context *ctx);
// Begins the command buffer of a slot, with a black picture; rig_end submits it and waits.
VkCommandBuffer rig_begin(rig *r, uint32_t slot);
tyn_result rig_record(rig *r, tyn_context *ctx, VkCommandBuffer cmd);
void rig_end(rig *r, uint32_t slot);
// All of it; `picture` is filled.
void rig_frame(rig *r, tyn_context *ctx);
// Sum over the picture.
double rig_light(const rig *r);
// Nothing was logged as an error, and the layers are silent.
void rig_expect_silence(const rig *r);
