// main.c -- a renderer with a window of its own: posts in a row through the medium, drawn by the host.
//
// usage: embed-window [SCENE [FRAMES PICTURE.png]]     HOST_VALIDATION in the environment: under the validation layers, of
//     which one message is a failure
//
// Dragging turns the camera about the medium, the wheel moves it nearer, Escape leaves. With FRAMES it leaves after that many,
// and writes the last one to a file. The host draws linear colours of any brightness into an image of its own; Tyndall lays the
// medium over it, and a blit brings it into the window's image.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <tyndall/context.h>
#include <tyndall/io.h>

#include "swapchain.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h> // after Vulkan, whose types it uses then

enum { POSTS = 7 };

static const float near_plane = 0.05f;
static const tyn_sync undefined = {VK_PIPELINE_STAGE_2_NONE, VK_ACCESS_2_NONE,
                                   VK_IMAGE_LAYOUT_UNDEFINED};
static const tyn_sync copied_to = {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL};
static const tyn_sync copied_from = {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                                     VK_ACCESS_2_TRANSFER_READ_BIT,
                                     VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};

static void print_log(void *user, tyn_log_level level, const char *message)
{
    (void)user;
    (void)level;
    fprintf(stderr, "tyndall: %s\n", message);
}

static const tyn_log log_to_stderr = {print_log, NULL, TYN_LOG_WARN};

// Stops at the first fault; the log has said what it is.
static void check(tyn_result result, const char *what)
{
    if (result < 0) {
        fprintf(stderr, "embed-window: %s failed\n", what);
        exit(1);
    }
}

// ---- the host's picture ---------------------------------------------------------------------------

// Of one frame slot; as large as the window.
typedef struct frame_images {
    host_image color, depth;
    host_buffer color_up, depth_up, color_down;
} frame_images;

static frame_images new_images(host *h, VkExtent2D size)
{
    const VkExtent3D extent = {size.width, size.height, 1};
    const VkDeviceSize pixels = (VkDeviceSize)size.width * size.height;
    const VkImageUsageFlags copies =
        VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    return (frame_images){
        .color = host_image_new(h, VK_FORMAT_R32G32B32A32_SFLOAT, extent,
                                VK_IMAGE_USAGE_STORAGE_BIT | copies),
        .depth =
            host_image_new(h, VK_FORMAT_D32_SFLOAT, extent, VK_IMAGE_USAGE_SAMPLED_BIT | copies),
        .color_up = host_buffer_new(h, pixels * 16),
        .depth_up = host_buffer_new(h, pixels * 4),
        .color_down = host_buffer_new(h, pixels * 16),
    };
}

static void free_images(host *h, frame_images *f)
{
    if (f->color.image) {
        host_image_free(h, &f->color);
        host_image_free(h, &f->depth);
        host_buffer_free(h, &f->color_up);
        host_buffer_free(h, &f->depth_up);
        host_buffer_free(h, &f->color_down);
    }
}

// A reversed, infinite projection: depth = near / distance.
static void projection(const tyn_camera *camera, VkExtent2D size, float m[16])
{
    const float focal = 1 / tanf(0.5f * camera->yfov);
    memset(m, 0, 16 * sizeof(float));
    m[0] = focal * (float)size.height / (float)size.width;
    m[5] = -focal; // Vulkan's y points down
    m[11] = -1;
    m[14] = near_plane;
}

// A post of the row that leads through the box [lo, hi], as a card; none (no width) if it is behind the camera.
static host_card see_post(int i, const float lo[3], const float hi[3], const tyn_camera *camera,
                          VkExtent2D size)
{
    const float t = 1.6f * ((float)i / (POSTS - 1) - 0.5f), warm = (float)i / (POSTS - 1);
    const float tall = hi[1] - lo[1],
                pixels = 0.5f * (float)size.height / tanf(0.5f * camera->yfov);
    float x = 0, y = 0, distance = 0;
    for (int a = 0; a < 3; a++) {
        const float along = a == 1 ? 0 : t * (hi[a] - lo[a]);
        const float way = 0.5f * (lo[a] + hi[a]) + along - camera->position[a];
        x += way * camera->right[a];
        y += way * camera->up[a];
        distance -= way * camera->back[a];
    }
    if (distance <= near_plane) {
        return (host_card){0};
    }
    const float scale = pixels / distance;
    const float left = 0.5f * (float)size.width + scale * (x - 0.03f * tall),
                top = 0.5f * (float)size.height - scale * (y + 0.45f * tall),
                right = left + 0.06f * scale * tall, bottom = top + 0.9f * scale * tall;
    if (right <= 0 || bottom <= 0 || left >= (float)size.width || top >= (float)size.height) {
        return (host_card){0};
    }
    const uint32_t x0 = (uint32_t)fmaxf(left, 0), y0 = (uint32_t)fmaxf(top, 0);
    return (host_card){x0,
                       y0,
                       (uint32_t)fminf(right, (float)size.width) - x0,
                       (uint32_t)fminf(bottom, (float)size.height) - y0,
                       {0.15f + 0.6f * warm, 0.25f + 0.1f * warm, 0.5f - 0.4f * warm, 1},
                       near_plane / distance};
}

static int nearer(const void *a, const void *b)
{
    const float one = ((const host_card *)a)->depth, two = ((const host_card *)b)->depth;
    return (one > two) - (one < two);
}

// Leaves both images as copies do.
static void draw(host *h, VkCommandBuffer cmd, frame_images *f, const tyn_scene *scene,
                 const tyn_camera *camera, VkExtent2D size)
{
    float lo[3], hi[3];
    tyn_scene_bounds(scene, lo, hi);
    host_card cards[1 + POSTS] = {{0, 0, size.width, size.height, {0.03f, 0.04f, 0.06f, 1}, 0}};
    for (int i = 0; i < POSTS; i++) {
        cards[1 + i] = see_post(i, lo, hi, camera, size);
    }
    qsort(cards + 1, POSTS, sizeof cards[0], nearer);
    host_paint(&f->color_up, &f->depth_up, size.width, size.height, cards, 1 + POSTS);
    f->color.state = f->depth.state = undefined;
    host_transition(h, cmd, &f->color, copied_to);
    host_transition(h, cmd, &f->depth, copied_to);
    host_upload(h, cmd, &f->color_up, &f->color);
    host_upload(h, cmd, &f->depth_up, &f->depth);
}

// Linear to sRGB, clipped at 1, as the blit does it.
static bool write_picture(const char *path, VkExtent2D size, const float *rgba)
{
    const size_t values = (size_t)size.width * size.height * 3;
    uint8_t *bytes = malloc(values);
    for (size_t i = 0; bytes && i < values; i++) {
        const float v = fminf(fmaxf(rgba[i / 3 * 4 + i % 3], 0), 1);
        const float s = v <= 0.0031308f ? 12.92f * v : 1.055f * powf(v, 1 / 2.4f) - 0.055f;
        bytes[i] = (uint8_t)(s * 255 + 0.5f);
    }
    const bool ok =
        bytes && tyn_png_write(path, size.width, size.height, 3, bytes, &log_to_stderr) == TYN_OK;
    free(bytes);
    return ok;
}

// ---- the camera -----------------------------------------------------------------------------------

typedef struct orbit {
    float middle[3], distance; // m
    float azimuth, elevation;  // of the camera as seen from the middle, radians
    double x, y;               // the pointer
} orbit;

static orbit orbit_of(const tyn_scene *scene, const tyn_camera *camera)
{
    orbit o = {0};
    float lo[3], hi[3], from[3], length2 = 0;
    tyn_scene_bounds(scene, lo, hi);
    for (int a = 0; a < 3; a++) {
        o.middle[a] = 0.5f * (lo[a] + hi[a]);
        from[a] = camera->position[a] - o.middle[a];
        length2 += from[a] * from[a];
    }
    o.distance = fmaxf(sqrtf(length2), 2 * near_plane);
    o.azimuth = atan2f(from[0], from[2]);
    o.elevation = asinf(fmaxf(-1, fminf(1, from[1] / o.distance)));
    return o;
}

static void place(const orbit *o, tyn_camera *camera)
{
    const float level = o->distance * cosf(o->elevation);
    const float from[3] = {o->middle[0] + level * sinf(o->azimuth),
                           o->middle[1] + o->distance * sinf(o->elevation),
                           o->middle[2] + level * cosf(o->azimuth)};
    check(tyn_camera_look_at(camera, from, o->middle), "tyn_camera_look_at");
}

static void on_pointer(GLFWwindow *window, double x, double y)
{
    orbit *o = glfwGetWindowUserPointer(window);
    if (glfwGetMouseButton(window, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS) {
        o->azimuth -= 0.008f * (float)(x - o->x);
        o->elevation = fmaxf(-1.5f, fminf(1.5f, o->elevation + 0.008f * (float)(y - o->y)));
    }
    o->x = x;
    o->y = y;
}

static void on_wheel(GLFWwindow *window, double x, double y)
{
    (void)x;
    orbit *o = glfwGetWindowUserPointer(window);
    o->distance = fmaxf(o->distance * powf(0.9f, (float)y), 2 * near_plane);
}

static void on_key(GLFWwindow *window, int key, int code, int action, int modifiers)
{
    (void)code;
    (void)modifiers;
    if (key == GLFW_KEY_ESCAPE && action == GLFW_PRESS) {
        glfwSetWindowShouldClose(window, GLFW_TRUE);
    }
}

// ---- frames ---------------------------------------------------------------------------------------

typedef struct app {
    host h;
    GLFWwindow *window;
    swapchain chain;
    frame_images images[HOST_SLOTS];
    tyn_scene scene;
    tyn_device *dev;
    tyn_context *ctx;
    tyn_view view;
    orbit orbit;
    bool stale;   // the window's size is another
    bool resized; // nothing of an earlier size is in use
} app;

static void open_window(app *a)
{
    if (!glfwInit()) {
        fprintf(stderr, "embed-window: no display\n");
        exit(77); // what a test runner takes for "skipped"
    }
    uint32_t count = 0;
    const char **names = glfwGetRequiredInstanceExtensions(&count), *list[9] = {NULL};
    for (uint32_t i = 0; names && i < count && i < 8; i++) {
        list[i] = names[i];
    }
    if (host_open_with(&a->h, &(host_wants){.validation = getenv("HOST_VALIDATION") != NULL,
                                            .instance_extensions = list,
                                            .device_extensions = swapchain_extensions}) !=
        HOST_OK) {
        exit(77);
    }
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    a->window = glfwCreateWindow(640, 480, "embed-window", NULL, NULL);
    VkSurfaceKHR surface;
    if (!a->window ||
        glfwCreateWindowSurface(a->h.instance, a->window, NULL, &surface) != VK_SUCCESS) {
        fprintf(stderr, "embed-window: no window with a Vulkan surface\n");
        exit(1);
    }
    swapchain_open(&a->h, &a->chain, surface);
    glfwSetWindowUserPointer(a->window, &a->orbit);
    glfwSetCursorPosCallback(a->window, on_pointer);
    glfwSetScrollCallback(a->window, on_wheel);
    glfwSetKeyCallback(a->window, on_key);
}

static void open_scene(app *a, const char *path)
{
    tyn_device_params device_params = {.struct_size = sizeof(device_params), .log = log_to_stderr};
    host_describe(&a->h, &device_params);
    check(tyn_device_create(&device_params, &a->dev), "tyn_device_create");
    tyn_scene_init(&a->scene);
    check(tyn_scene_load(&a->scene, path, NULL, &log_to_stderr), "tyn_scene_load");
    check(tyn_context_create(a->dev, tyn_context_params(.frames_in_flight = HOST_SLOTS), &a->ctx),
          "tyn_context_create");
    a->view = (tyn_view){.outputs = TYN_OUTPUT_COMPOSITE, .no_background = true};
    if (a->scene.num_cameras) {
        a->view.camera = a->scene.cameras[0];
    } else {
        tyn_camera_frame_scene(&a->view.camera, &a->scene);
    }
    a->view.camera.projection = TYN_PERSPECTIVE;
    a->orbit = orbit_of(&a->scene, &a->view.camera);
}

static void close_all(app *a)
{
    a->h.vk.DeviceWaitIdle(a->h.device);
    tyn_context_destroy(&a->ctx);
    tyn_device_destroy(&a->dev);
    tyn_scene_finish(&a->scene);
    for (int i = 0; i < HOST_SLOTS; i++) {
        free_images(&a->h, &a->images[i]);
    }
    swapchain_close(&a->h, &a->chain);
    host_close(&a->h);
    glfwDestroyWindow(a->window);
    glfwTerminate();
}

// All that is as large as the window; false: it has no area.
static bool resize(app *a)
{
    int width, height;
    glfwGetFramebufferSize(a->window, &width, &height);
    if (!swapchain_resize(&a->h, &a->chain, (VkExtent2D){(uint32_t)width, (uint32_t)height})) {
        return false;
    }
    for (int i = 0; i < HOST_SLOTS; i++) {
        free_images(&a->h, &a->images[i]);
        a->images[i] = new_images(&a->h, a->chain.extent);
    }
    a->view.width = a->chain.extent.width;
    a->view.height = a->chain.extent.height;
    a->stale = false;
    a->resized = true;
    return true;
}

// False: there is nothing to show it in, yet.
static bool show_frame(app *a, uint32_t slot)
{
    if (a->stale && !resize(a)) {
        return false;
    }
    uint32_t image;
    if (!swapchain_acquire(&a->h, &a->chain, slot, &image)) {
        a->stale = true;
        return false;
    }
    frame_images *f = &a->images[slot];
    place(&a->orbit, &a->view.camera);
    VkCommandBuffer cmd = host_begin(&a->h, slot);
    draw(&a->h, cmd, f, &a->scene, &a->view.camera, a->chain.extent);
    const tyn_image color = host_lend(&f->color, copied_from),
                    depth = host_lend(&f->depth, copied_to);
    tyn_frame frame = {.struct_size = sizeof(frame),
                       .cmd = cmd,
                       .scene = &a->scene,
                       .view = &a->view,
                       .color = &color,
                       .depth = &depth,
                       .idle = a->resized};
    projection(&a->view.camera, a->chain.extent, frame.view_to_clip);
    check(tyn_context_prepare(a->ctx, &frame), "tyn_context_prepare");
    check(tyn_context_record(a->ctx, &frame), "tyn_context_record");
    a->resized = false;
    swapchain_blit(&a->h, &a->chain, cmd, image, &f->color);
    host_download(&a->h, cmd, &f->color, &f->color_down);
    a->stale = !swapchain_present(&a->h, &a->chain, slot, image);
    return true;
}

int main(int argc, char **argv)
{
    if (argc == 3 || argc > 4) {
        fprintf(stderr, "usage: embed-window [SCENE [FRAMES PICTURE.png]]\n");
        return 2;
    }
    const long most = argc > 2 ? strtol(argv[2], NULL, 10) : 0;
    app a = {.stale = true};
    open_window(&a);
    open_scene(&a, argc > 1 ? argv[1] : "build/samples/scenes/smoke.gltf");
    long frames = 0, drawn = 0; // drawn: since the title was written
    double since = glfwGetTime();
    while (!glfwWindowShouldClose(a.window) && (most <= 0 || frames < most)) {
        glfwPollEvents();
        if (!show_frame(&a, (uint32_t)(frames % HOST_SLOTS))) {
            glfwWaitEventsTimeout(0.02); // minimised, or about to have another size
            continue;
        }
        frames++;
        drawn++;
        const double now = glfwGetTime();
        if (now - since > 1) {
            char title[64];
            snprintf(title, sizeof title, "embed-window, %.1f frames a second",
                     (double)drawn / (now - since));
            glfwSetWindowTitle(a.window, title);
            since = now;
            drawn = 0;
        }
    }
    bool ok = true;
    if (argc > 3 && frames && a.view.width) {
        const uint32_t last = (uint32_t)((frames - 1) % HOST_SLOTS);
        host_wait(&a.h, last);
        ok = write_picture(argv[3], a.chain.extent, a.images[last].color_down.data);
    }
    close_all(&a);
    printf("%ld frames\n", frames);
    return ok && a.h.messages == 0 ? 0 : 1;
}
