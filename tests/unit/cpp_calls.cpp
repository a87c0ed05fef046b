// cpp_calls.cpp -- the calls of docs/embedding.md, as a host in C++20 writes them. Compiled, not run.
#include <tyndall/context.h>
#include <tyndall/offline.h>

tyn_result cpp_calls(VkInstance instance, VkCommandBuffer cmd, const tyn_scene *scene,
                     const tyn_view *view, const tyn_image *color);

tyn_result cpp_calls(VkInstance instance, VkCommandBuffer cmd, const tyn_scene *scene,
                     const tyn_view *view, const tyn_image *color)
{
    tyn_device *dev = nullptr, *own = nullptr;
    tyn_context *ctx = nullptr, *plain = nullptr;
    tyn_offline *off = nullptr;
    // The macros, ...
    tyn_device_create(tyn_device_params(.instance = instance, .api_version = VK_API_VERSION_1_3),
                      &dev);
    tyn_device_open(tyn_device_open_params(.select = "0"), &own);
    tyn_context_create(dev, tyn_context_params(.method = "pop", .frames_in_flight = 2), &ctx);
    tyn_offline_create(own, tyn_offline_params(.method = "path"), &off);
    tyn_context_prepare(ctx, tyn_frame(.scene = scene, .view = view, .color = color));
    // ... references to temporaries and to variables.
    tyn_context_create(dev, tyn_context_params{}, &plain);
    tyn_frame frame{};
    frame.cmd = cmd;
    frame.scene = scene;
    frame.view = view;
    return tyn_context_record(plain, frame);
}
