// main.cpp -- the host of main.c in C++17, as short as it gets: a sphere of fog, laid over a black frame.
//
// usage: embed-host-cpp [PICTURE.png]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <tyndall/context.h>
#include <tyndall/io.h>

extern "C" {
#include "host.h"
}

namespace {

constexpr uint32_t side = 256;

void print_log(void *, tyn_log_level, const char *message)
{
    std::fprintf(stderr, "tyndall: %s\n", message);
}

// Stops at the first fault; the log has said what it is.
void check(tyn_result result, const char *what)
{
    if (result != TYN_OK) {
        std::fprintf(stderr, "embed-host-cpp: %s failed\n", what);
        std::exit(1);
    }
}

// Fog in a sphere of 2 m, and a lamp beside it.
void fill(tyn_scene &scene)
{
    tyn_scene_init(&scene);
    tyn_medium &fog = scene.media[scene.num_media++];
    fog.volume = -1;
    tyn_shape &sphere = scene.shapes[scene.num_shapes++];
    sphere.kind = TYN_SHAPE_SPHERE;
    tyn_light &lamp = scene.lights[scene.num_lights++];
    lamp.kind = TYN_LIGHT_POINT;
    lamp.position[0] = 1.5f;
    lamp.position[1] = 1.2f;
    lamp.position[2] = 0.8f;
    const float blue_white[] = {5, 6, 8};
    for (int i = 0; i < 3; i++) {
        fog.sigma_s[i] = 1.2f;
        sphere.to_world[5 * i] = 2;
        lamp.color[i] = blue_white[i];
    }
    sphere.to_world[15] = 1;
}

// Linear to sRGB, clipped at 1.
std::vector<uint8_t> encode(const float *rgba)
{
    std::vector<uint8_t> bytes(side * side * 3);
    for (size_t i = 0; i < bytes.size(); i++) {
        const float v = std::clamp(rgba[i / 3 * 4 + i % 3], 0.0f, 1.0f);
        const float s = v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
        bytes[i] = static_cast<uint8_t>(s * 255 + 0.5f);
    }
    return bytes;
}

} // namespace

int main(int argc, char **argv)
{
    const char *picture = argc > 1 ? argv[1] : "embed-host-cpp.png";
    const tyn_log log = {print_log, nullptr, TYN_LOG_WARN};

    host h;
    if (host_open(&h, false) != HOST_OK) {
        return 77; // what a test runner takes for "skipped"
    }
    host_image color = host_image_new(&h, VK_FORMAT_R32G32B32A32_SFLOAT, {side, side, 1},
                                      VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                          VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    host_buffer up = host_buffer_new(&h, side * side * 16), down = host_buffer_new(&h, up.size);
    std::fill_n(static_cast<float *>(up.data), side * side * 4, 0.0f);

    tyn_device_params device_params{};
    device_params.log = log;
    host_describe(&h, &device_params);
    tyn_device *dev = nullptr;
    check(tyn_device_create(device_params, &dev), "tyn_device_create");
    tyn_context *ctx = nullptr;
    check(tyn_context_create(dev, tyn_context_params{}, &ctx), "tyn_context_create");

    tyn_scene scene;
    fill(scene);
    tyn_view view{};
    view.width = view.height = side;
    view.outputs = TYN_OUTPUT_COMPOSITE;
    tyn_camera_frame_scene(&view.camera, &scene);

    VkCommandBuffer cmd = host_begin(&h, 0);
    host_transition(&h, cmd, &color,
                    {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                     VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL});
    host_upload(&h, cmd, &up, &color);
    const tyn_image lent =
        host_lend(&color, {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                           VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL});
    tyn_frame frame{};
    frame.cmd = cmd;
    frame.scene = &scene;
    frame.view = &view;
    frame.color = &lent;
    check(tyn_context_prepare(ctx, frame), "tyn_context_prepare");
    check(tyn_context_record(ctx, frame), "tyn_context_record");
    host_download(&h, cmd, &color, &down);
    host_submit(&h, 0);
    host_wait(&h, 0);

    const float *rgba = static_cast<const float *>(down.data);
    const std::vector<uint8_t> bytes = encode(rgba);
    check(tyn_png_write(picture, side, side, 3, bytes.data(), &log), "tyn_png_write");
    const size_t middle = (side / 2 * side + side / 2) * 4;
    std::printf("in the middle %.3f %.3f %.3f; see %s\n", static_cast<double>(rgba[middle]),
                static_cast<double>(rgba[middle + 1]), static_cast<double>(rgba[middle + 2]),
                picture);
    const bool lit = rgba[middle] > 0 && rgba[middle + 2] > rgba[middle];

    tyn_context_destroy(&ctx);
    tyn_device_destroy(&dev);
    tyn_scene_finish(&scene);
    host_buffer_free(&h, &up);
    host_buffer_free(&h, &down);
    host_image_free(&h, &color);
    host_close(&h);
    return lit ? 0 : 1;
}
