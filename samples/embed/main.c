// main.c -- a renderer that lets Tyndall record smoke into its frames.
//
// usage: embed-host [SCENE [PICTURE.png]]
//
// The host draws its own frame (cards at several depths; a real one would have pipelines), hands over the
// colour and the depth image as it has them after drawing, and goes on from where it asked to find
// them. Three frames go by with the camera moving; the last is written to a file.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <tyndall/context.h>
#include <tyndall/io.h>

#include "host.h"

enum { WIDTH = 512, HEIGHT = 512, FRAMES = 3 };

static const float near_plane = 0.1f;

static void print_log(void *user, tyn_log_level level, const char *message)
{
    (void)user;
    (void)level;
    fprintf(stderr, "tyndall: %s\n", message);
}

// Stops at the first fault; the log has said what it is.
static void check(tyn_result result, const char *what)
{
    if (result != TYN_OK) {
        fprintf(stderr, "embed-host: %s failed\n", what);
        exit(1);
    }
}

// The host's own images, and the states in which its renderer has them.
typedef struct frame_images {
    host_image color, depth;
    host_buffer color_up, depth_up, color_down;
} frame_images;

static const tyn_sync undefined = {VK_PIPELINE_STAGE_2_NONE, VK_ACCESS_2_NONE,
                                   VK_IMAGE_LAYOUT_UNDEFINED};
static const tyn_sync copied_to = {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL};
static const tyn_sync copied_from = {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                                     VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
static const tyn_sync drawn = {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                               VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                               VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
static const tyn_sync depth_drawn = {VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
                                     VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
                                     VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};

static frame_images new_images(host *h)
{
    const VkExtent3D extent = {WIDTH, HEIGHT, 1};
    const VkImageUsageFlags copies =
        VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    return (frame_images){
        .color = host_image_new(h, VK_FORMAT_R32G32B32A32_SFLOAT, extent,
                                VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                    copies),
        .depth = host_image_new(h, VK_FORMAT_D32_SFLOAT, extent,
                                VK_IMAGE_USAGE_SAMPLED_BIT |
                                    VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | copies),
        .color_up = host_buffer_new(h, WIDTH * HEIGHT * 16),
        .depth_up = host_buffer_new(h, WIDTH * HEIGHT * 4),
        .color_down = host_buffer_new(h, WIDTH * HEIGHT * 16),
    };
}

static void free_images(host *h, frame_images *f)
{
    host_image_free(h, &f->color);
    host_image_free(h, &f->depth);
    host_buffer_free(h, &f->color_up);
    host_buffer_free(h, &f->depth_up);
    host_buffer_free(h, &f->color_down);
}

// A reversed, infinite projection: depth = near / distance.
static void projection(const tyn_camera *camera, float m[16])
{
    const float focal = 1 / tanf(0.5f * camera->yfov);
    memset(m, 0, 16 * sizeof(float));
    m[0] = focal * HEIGHT / WIDTH;
    m[5] = -focal; // Vulkan's y points down
    m[11] = -1;
    m[14] = near_plane;
}

// The rest of the host's frame: posts in a row that leads from before the volume to behind it.
static void draw(host *h, VkCommandBuffer cmd, frame_images *f, float nearest, float farthest)
{
    enum { POSTS = 6 };
    host_card cards[1 + POSTS] = {
        {0, 0, WIDTH, HEIGHT, {0.03f, 0.04f, 0.06f, 1}, 0} // the backdrop, infinitely far
    };
    for (int i = 0; i < POSTS; i++) {
        const float t = (float)(POSTS - 1 - i) / (POSTS - 1); // far ones first
        const float distance = nearest + (farthest - nearest) * t;
        const float height = 0.9f * HEIGHT * nearest / distance;
        const float warm = 1 - t;
        cards[1 + i] =
            (host_card){(uint32_t)(70 + 60 * i + 20 * i * i / POSTS),
                        (uint32_t)(0.5f * (HEIGHT - height)),
                        (uint32_t)(34 * nearest / distance),
                        (uint32_t)height,
                        {0.15f + 0.6f * warm, 0.25f + 0.1f * warm, 0.5f - 0.4f * warm, 1},
                        near_plane / distance};
    }
    host_paint(&f->color_up, &f->depth_up, WIDTH, HEIGHT, cards, 1 + POSTS);
    f->color.state = f->depth.state = undefined;
    host_transition(h, cmd, &f->color, copied_to);
    host_transition(h, cmd, &f->depth, copied_to);
    host_upload(h, cmd, &f->color_up, &f->color);
    host_upload(h, cmd, &f->depth_up, &f->depth);
    host_transition(h, cmd, &f->color, drawn);
    host_transition(h, cmd, &f->depth, depth_drawn);
}

// Linear to sRGB, clipped at 1.
static bool write_picture(const char *path, const float *rgba, const tyn_log *log)
{
    uint8_t *bytes = malloc(WIDTH * HEIGHT * 3);
    for (size_t i = 0; bytes && i < WIDTH * HEIGHT * 3; i++) {
        const float v = fminf(fmaxf(rgba[i / 3 * 4 + i % 3], 0), 1);
        const float s = v <= 0.0031308f ? 12.92f * v : 1.055f * powf(v, 1 / 2.4f) - 0.055f;
        bytes[i] = (uint8_t)(s * 255 + 0.5f);
    }
    const bool ok = bytes && tyn_png_write(path, WIDTH, HEIGHT, 3, bytes, log) == TYN_OK;
    free(bytes);
    return ok;
}

int main(int argc, char **argv)
{
    const char *path = argc > 1 ? argv[1] : "build/samples/scenes/smoke.gltf";
    const char *picture = argc > 2 ? argv[2] : "embed-host.png";
    const tyn_log log = {print_log, NULL, TYN_LOG_WARN};

    // The host's side: an instance, a device with the features that Tyndall requires, images.
    host h;
    if (host_open(&h, false) != HOST_OK) {
        return 77; // what a test runner takes for "skipped"
    }
    frame_images images[HOST_SLOTS];
    for (uint32_t i = 0; i < HOST_SLOTS; i++) {
        images[i] = new_images(&h);
    }

    // Tyndall's side: a device on the host's, a scene, a context for it.
    tyn_device_params device_params = {.struct_size = sizeof(device_params), .log = log};
    host_describe(&h, &device_params);
    tyn_device *dev = NULL;
    check(tyn_device_create(&device_params, &dev), "tyn_device_create");
    tyn_scene scene;
    tyn_scene_init(&scene);
    check(tyn_scene_load(&scene, path, NULL, &log), "tyn_scene_load");
    tyn_context *ctx = NULL;
    check(tyn_context_create(dev, tyn_context_params(.frames_in_flight = HOST_SLOTS), &ctx),
          "tyn_context_create");

    tyn_view view = {
        .width = WIDTH, .height = HEIGHT, .outputs = TYN_OUTPUT_COMPOSITE, .no_background = true};
    if (scene.num_cameras) {
        view.camera = scene.cameras[0];
    } else {
        tyn_camera_frame_scene(&view.camera, &scene);
    }
    // How far from the camera the volume begins and ends.
    float lo[3], hi[3], middle = 0, radius = 0;
    tyn_scene_bounds(&scene, lo, hi);
    for (int a = 0; a < 3; a++) {
        middle += (view.camera.position[a] - 0.5f * (lo[a] + hi[a])) * view.camera.back[a];
        radius = fmaxf(radius, 0.35f * (hi[a] - lo[a]));
    }

    for (uint32_t i = 0; i < FRAMES; i++) {
        frame_images *f = &images[i % HOST_SLOTS];
        VkCommandBuffer cmd = host_begin(&h, i % HOST_SLOTS);
        draw(&h, cmd, f, middle - radius, middle + radius);

        view.camera.position[0] += 0.01f * middle;
        const tyn_image color = host_lend(&f->color, copied_from);
        const tyn_image depth = host_lend(&f->depth, depth_drawn);
        tyn_frame frame = {.struct_size = sizeof(frame),
                           .cmd = cmd,
                           .scene = &scene,
                           .view = &view,
                           .color = &color,
                           .depth = &depth};
        projection(&view.camera, frame.view_to_clip);
        if (i == 0) { // and whenever sizes change
            check(tyn_context_prepare(ctx, &frame), "tyn_context_prepare");
        }
        check(tyn_context_record(ctx, &frame), "tyn_context_record");

        host_download(&h, cmd, &f->color, &f->color_down);
        host_submit(&h, i % HOST_SLOTS);
    }
    for (uint32_t i = 0; i < HOST_SLOTS; i++) {
        host_wait(&h, i);
    }

    tyn_report report;
    tyn_context_report(ctx, &report);
    printf("on %s, the last frame:\n", h.device_name);
    for (uint32_t i = 0; i < report.num_nodes; i++) {
        const tyn_node_report *n = &report.nodes[i];
        printf("  %-16s %-10s %8.2f ms\n", n->name, n->state, n->gpu_ms);
    }
    const float *rgba = images[(FRAMES - 1) % HOST_SLOTS].color_down.data;
    const bool ok = write_picture(picture, rgba, &log);
    if (ok) {
        printf("see %s\n", picture);
    }

    tyn_context_destroy(&ctx);
    tyn_device_destroy(&dev);
    tyn_scene_finish(&scene);
    for (uint32_t i = 0; i < HOST_SLOTS; i++) {
        free_images(&h, &images[i]);
    }
    host_close(&h);
    return ok ? 0 : 1;
}
