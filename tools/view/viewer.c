// viewer.c -- the window's life: opening, the loop of frames, a lost device, closing.
#include "view/viewer.h"
#include "view/panel.h"
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "stats.h"

const char *const viewer_qualities[] = {"draft", "normal", "high", NULL};
enum { MAX_LOST = 3 }; // devices, before it is given up

void viewer_note(viewer *v, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(v->note, sizeof v->note, format, arguments);
    va_end(arguments);
}

void viewer_touch(viewer *v)
{
    v->outdated = true;
    v->last_change = app_seconds();
    v->comparison.started = v->comparison.measured = false;
    v->probe.state = v->probe.state == PROBE_KNOWN ? PROBE_ASKED : v->probe.state;
}

float viewer_aspect(const viewer *v)
{
    return (float)v->view.width / (float)v->view.height;
}

// ---- method -----------------------------------------------------------------------------------

// False: the method that was there stays.
static bool use_method(viewer *v, const method_options *how)
{
    method made;
    v->asked_at = app_seconds();
    const uint32_t errors = v->app->num_errors;
    method_options own = *how;
    char samples[16];
    if (own.method && strcmp(own.method, "refined") == 0 && !own.refine && !own.spp) {
        snprintf(samples, sizeof samples, "%d", VIEWER_SAMPLES);
        own.refine = samples; // so many that no path may end in pop's field
    }
    bool works = method_open(v->app, &own, &made) == EXIT_DONE;
    if (works && scene_prepare(v->app, &made.info, &v->scene) != EXIT_DONE) {
        works = false;
    }
    if (!works) {
        method_finish(&made);
        viewer_note(v, "%s", v->app->num_errors > errors ? v->app->last_error : "out of memory");
        return false;
    }
    pictures_close(v);
    method_finish(&v->method);
    v->method = made;
    v->how = *how;
    v->note[0] = '\0';
    if (!(picture_layers[v->layer].output & made.info.outputs)) {
        v->layer = 0;
    }
    for (uint32_t i = 0; i < tyn_num_methods(); i++) {
        tyn_method_info info;
        tyn_method_at(i, &info);
        v->method_index = strcmp(info.name, made.info.name) == 0 ? i : v->method_index;
    }
    return true;
}

void viewer_set_method(viewer *v, uint32_t index)
{
    tyn_method_info info;
    if (index < tyn_num_methods() && index != v->method_index) {
        tyn_method_at(index, &info);
        method_options how = v->how;
        how.method = info.name;
        use_method(v, &how);
    }
}

void viewer_set_quality(viewer *v, uint32_t index)
{
    method_options how = v->how;
    how.quality = viewer_qualities[index];
    if (use_method(v, &how)) {
        v->quality = index;
    }
}

void viewer_set_layer(viewer *v, uint32_t layer)
{
    v->layer = layer;
    v->outdated = true;
    v->comparison.started = false;
    v->woken = true;
}

// ---- window and device ------------------------------------------------------------------------

static char window_error[256];

static void on_window_error(int code, const char *text)
{
    snprintf(window_error, sizeof window_error, "%s (%d)", text, code);
}

static int open_window(viewer *v)
{
    glfwSetErrorCallback(on_window_error);
    if (!glfwInit()) {
        app_error(v->app, "there is no display to open a window on: %s", window_error);
        return EXIT_WRONG;
    }
    if (!glfwVulkanSupported()) {
        app_error(v->app, "there is no Vulkan loader that presents to windows");
        return EXIT_FAILED;
    }
    char *stem = text_stem(v->source.scene);
    v->title = text_format("%s - tyndall", stem ? stem : "");
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    v->window = glfwCreateWindow((int)v->view.width, (int)v->view.height,
                                 v->title ? v->title : "tyndall", NULL, NULL);
    free(stem);
    if (!v->window) {
        app_error(v->app, "no window can be opened: %s", window_error);
        return EXIT_WRONG;
    }
    glfwSetWindowSizeLimits(v->window, 64, 64, GLFW_DONT_CARE, GLFW_DONT_CARE);
    input_open(v);
    panel_open(v->window);
    return EXIT_DONE;
}

static bool open_panel(viewer *v)
{
    gpu *g = &v->gpu;
    const VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1};
    const VkDescriptorPoolCreateInfo pool = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
        .flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT,
        .maxSets = 1,
        .poolSizeCount = 1,
        .pPoolSizes = &size,
    };
    if (!gpu_check(g, vkCreateDescriptorPool(g->device, &pool, NULL, &v->panel_pool),
                   "vkCreateDescriptorPool")) {
        return false;
    }
    const panel_device device = {
        .instance = g->instance,
        .physical_device = g->physical_device,
        .device = g->device,
        .queue_family = g->queue_family,
        .queue = g->queue,
        .pool = v->panel_pool,
        .pass = v->surface.pass,
        .min_images = 2,
        .num_images = SURFACE_MAX_IMAGES,
    };
    gpu_commands *commands = &v->surface.commands;
    if (!panel_open_device(&device) || !gpu_begin(g, commands)) {
        return false;
    }
    panel_record_font(commands->cmd);
    const bool done =
        gpu_submit(g, commands, VK_NULL_HANDLE, VK_NULL_HANDLE) && gpu_wait(g, commands);
    panel_font_is_done();
    return done;
}

static int open_device(viewer *v)
{
    int code = gpu_open(&v->gpu, v->app, &v->args->machine, v->args->validate);
    if (code == EXIT_DONE) {
        code = gpu_open_library(&v->library, &v->gpu);
    }
    if (code != EXIT_DONE) {
        return code;
    }
    const bool open = surface_open(&v->surface, &v->gpu, v->window) &&
                      picture_open(&v->picture, &v->gpu, v->surface.pass) && open_panel(v);
    return open ? EXIT_DONE : EXIT_FAILED;
}

static void close_device(viewer *v)
{
    gpu_wait_idle(&v->gpu);
    gpu_wait_idle(&v->library);
    pictures_close(v);
    rendering_close(&v->retired);
    panel_close_device();
    if (v->gpu.device) {
        vkDestroyDescriptorPool(v->gpu.device, v->panel_pool, NULL);
    }
    v->panel_pool = VK_NULL_HANDLE;
    picture_close(&v->picture);
    surface_close(&v->surface);
    gpu_close(&v->library);
    gpu_close(&v->gpu);
    v->has_picture = false;
}

// Everything on the device is made anew; what the user sees and set stays.
static int recover(viewer *v)
{
    v->stats.num_lost++;
    if (v->stats.num_lost > MAX_LOST) {
        app_error(v->app, "the device was lost %u times", v->stats.num_lost);
        return EXIT_FAILED;
    }
    app_warn(v->app, "the device is lost and opened again");
    close_device(v);
    const int code = open_device(v);
    viewer_note(v, "the device was lost and opened again");
    return code;
}

// ---- frames -----------------------------------------------------------------------------------

static void record(viewer *v)
{
    VkCommandBuffer cmd = v->surface.commands.cmd;
    struct picture_args args;
    pictures_args(v, &args);
    picture_record_upload(&v->picture, cmd);
    surface_begin_pass(&v->surface);
    picture_record_draw(&v->picture, cmd, &args);
    panel_record(cmd);
}

static void draw_panel(viewer *v)
{
    panel_begin();
    controls_draw_marks(v);
    if (v->show_panel) {
        controls_draw(v);
    }
    panel_end();
}

static surface_state step_frame(viewer *v)
{
    surface_state state = surface_begin(&v->surface);
    if (state != SURFACE_READY) {
        return state;
    }
    draw_panel(v);
    record(v);
    state = surface_end(&v->surface);
    return state;
}

// The size of the pictures follows that of the window.
static void follow_size(viewer *v)
{
    int width, height;
    glfwGetFramebufferSize(v->window, &width, &height);
    if (width > 0 && height > 0 &&
        ((uint32_t)width != v->view.width || (uint32_t)height != v->view.height)) {
        v->view.width = (uint32_t)width;
        v->view.height = (uint32_t)height;
        v->small = (resolution){0};
        v->rest_divisor = 0;
        v->woken = true;
        viewer_touch(v);
    }
}

static bool hidden(const viewer *v)
{
    return glfwGetWindowAttrib(v->window, GLFW_ICONIFIED) ||
           !glfwGetWindowAttrib(v->window, GLFW_VISIBLE);
}

static void take_input(viewer *v)
{
    const double now = app_seconds();
    const bool woken = v->woken; // the panel answers an event in the second frame after it
    v->woken = false;
    if (hidden(v)) {
        glfwWaitEventsTimeout(0.25);
    } else if (pictures_pending(v)) {
        glfwWaitEventsTimeout(0.02);
    } else if (pictures_computing(v)) {
        glfwPollEvents();
        if (!v->woken && !woken) {
            pictures_wait(v, 0.01);
        }
    } else if (woken || v->args->busy || pictures_working(v)) {
        glfwPollEvents();
    } else {
        glfwWaitEventsTimeout(0.1);
    }
    v->woken = v->woken || woken;
    input_step(v, fmin(now - v->last_frame, 0.25));
    v->last_frame = now;
    follow_size(v);
}

// The window's title says how many kernels are still to be compiled, and which picture takes long: the panel may be hidden.
static void say_work(viewer *v)
{
    const uint32_t pending = pictures_pending(v);
    char work[64] = "";
    if (pending) {
        snprintf(work, sizeof work, "compiling %u", pending);
    } else {
        pictures_say(v, work, sizeof work);
    }
    char *title = work[0] && v->title ? text_format("%s - %s", work, v->title) : NULL;
    const bool same = title && v->said ? strcmp(title, v->said) == 0 : title == v->said;
    if (same || !v->title) {
        free(title);
        return;
    }
    glfwSetWindowTitle(v->window, title ? title : v->title);
    free(v->said);
    v->said = title;
}

// While a picture is computed the window is drawn for what comes in and ten times a second, not all the time: it
// takes the processor from a device that is one.
static bool to_be_drawn(const viewer *v)
{
    return v->woken || !pictures_computing(v) || app_seconds() - v->last_drawn > 0.1;
}

// False: the device is lost, or `*code` says what failed.
static bool step(viewer *v, int *code)
{
    source_step(v);
    rebuild_step(v);
    pictures_step(v);
    say_work(v);
    if (v->gpu.lost || v->library.lost || !to_be_drawn(v)) {
        return !v->gpu.lost && !v->library.lost;
    }
    v->woken = false;
    v->last_drawn = app_seconds();
    const bool failed = step_frame(v) == SURFACE_FAILED;
    *code = failed && !v->gpu.lost ? EXIT_FAILED : EXIT_DONE;
    return !failed;
}

static int loop(viewer *v)
{
    const double end = v->args->seconds > 0 ? app_seconds() + v->args->seconds : INFINITY;
    int code = EXIT_DONE;
    v->last_frame = v->last_change = app_seconds();
    while (code == EXIT_DONE && !v->rebuild.restart && !glfwWindowShouldClose(v->window) &&
           !app_interrupted() && app_seconds() < end) {
        take_input(v);
        if (hidden(v)) {
            continue;
        }
        if (!step(v, &code) && code == EXIT_DONE) {
            code = recover(v);
        }
        v->stats.deaf_ms = fmax(v->stats.deaf_ms, 1e3 * (app_seconds() - v->last_frame));
    }
    return app_interrupted() ? EXIT_INTERRUPTED : code;
}

// Nothing is left to do but to wait for a picture that nobody will see: the system takes the device back.
static void leave(viewer *v, int code)
{
    glfwHideWindow(v->window);
    glfwPollEvents();
    if (!v->library.lost && !pictures_wait(v, 1)) {
        pipeline_cache_write(&v->library.cache, v->library.tyn);
        fflush(NULL);
        _exit(code == EXIT_DONE && v->gpu.messages ? EXIT_FAILED : code);
    }
}

// ---- life -------------------------------------------------------------------------------------

static int load(viewer *v)
{
    int code = source_open(v);
    if (code == EXIT_DONE) {
        code = use_method(v, &v->how) ? EXIT_DONE : EXIT_WRONG;
    }
    if (code == EXIT_DONE) {
        code = view_setup(v->app, &v->args->view, &v->scene, &v->view);
    }
    if (code == EXIT_DONE) {
        camera_control_start(&v->camera, &v->view.camera, &v->scene);
        v->first_camera = v->camera;
        controls_reset(v);
    }
    return code;
}

void viewer_frame_scene(viewer *v)
{
    tyn_camera camera;
    if (v->scene.num_cameras) {
        camera = v->scene.cameras[0];
    } else {
        tyn_camera_frame_scene(&camera, &v->scene);
    }
    camera_control_start(&v->camera, &camera, &v->scene);
    v->first_camera = v->camera;
    viewer_touch(v);
}

static double per_second(uint32_t frames, double seconds)
{
    return seconds > 0 ? frames / seconds : NAN;
}

static int write_stats(const viewer *v)
{
    cJSON *root = cJSON_CreateObject();
    cJSON_AddStringToObject(root, "tyndall", tyn_version_string());
    cJSON_AddStringToObject(root, "device", v->gpu.info.name);
    cJSON_AddStringToObject(root, "method", v->method.info.name);
    const int size[2] = {(int)v->view.width, (int)v->view.height};
    cJSON_AddItemToObject(root, "size", cJSON_CreateIntArray(size, 2));
    json_add_float(root, "moving_fps", per_second(v->stats.moving_frames, v->stats.moving_seconds));
    json_add_float(root, "rest_fps", per_second(v->stats.rest_frames, v->stats.rest_seconds));
    cJSON_AddNumberToObject(root, "moving_frames", v->stats.moving_frames);
    cJSON_AddNumberToObject(root, "rest_frames", v->stats.rest_frames);
    cJSON_AddNumberToObject(root, "divisor", v->small.divisor);
    cJSON_AddNumberToObject(root, "rest_divisor", v->rest_shown);
    json_add_float(root, "sharp_ms", v->stats.sharp_ms);
    json_add_float(root, "first_ms", v->stats.first_ms);
    json_add_float(root, "deaf_ms", v->stats.deaf_ms);
    cJSON_AddNumberToObject(root, "most_pending", v->stats.most_pending);
    cJSON_AddNumberToObject(root, "swapchains", v->surface.num_recreated);
    cJSON_AddNumberToObject(root, "devices_lost", v->stats.num_lost);
    cJSON_AddNumberToObject(root, "validation_messages", v->gpu.messages);
    const comparison *c = &v->comparison;
    if (c->measured) {
        cJSON *compared = cJSON_AddObjectToObject(root, "comparison");
        cJSON_AddNumberToObject(compared, "samples", c->rendering.samples);
        cJSON_AddNumberToObject(compared, "block", COMPARISON_BLOCK);
        json_add_float(compared, "rel_l1", c->error.rel_l1);
        json_add_float(compared, "n", c->error.n);
    }
    if (v->estimate.samples) {
        cJSON *told = cJSON_AddObjectToObject(root, "estimate");
        cJSON_AddNumberToObject(told, "samples", v->estimate.samples);
        json_add_float(told, "error", v->estimate.error);
        json_add_float(told, "bias", v->estimate.bias);
    }
    if (v->probe.state == PROBE_KNOWN) {
        cJSON *probe = cJSON_AddObjectToObject(root, "probe");
        cJSON_AddItemToObject(probe, "point", json_floats(v->probe.position, 3));
        cJSON_AddItemToObject(probe, "fluence", json_floats(v->probe.result.fluence, 3));
        cJSON_AddItemToObject(probe, "flux", json_floats(v->probe.result.flux, 9));
    }
    return json_write(v->app, root, v->args->stats);
}

int viewer_run(app *a, const view_args *args)
{
    viewer *v = calloc(1, sizeof *v);
    if (!v) {
        return app_exit_code(a, TYN_ERR_MEMORY, false);
    }
    v->app = a;
    v->args = args;
    v->source = args->scene;
    v->how = args->method;
    v->quality = VIEWER_NORMAL;
    for (uint32_t i = 0; args->method.quality && viewer_qualities[i]; i++) {
        v->quality = strcmp(viewer_qualities[i], args->method.quality) == 0 ? i : v->quality;
    }
    v->view.seed = args->method.seed;
    v->view.max_depth = args->method.max_depth;
    v->view.rr_depth = args->method.rr_depth;
    v->exposure = args->exposure;
    v->show_panel = !args->no_panel;
    v->turntable = args->orbit;
    tyn_scene_init(&v->scene);
    int code = rebuild_open(v);
    if (code == EXIT_DONE) {
        code = load(v);
    }
    if (code == EXIT_DONE) {
        code = open_window(v);
    }
    if (code == EXIT_DONE) {
        code = open_device(v);
    }
    if (code == EXIT_DONE) {
        code = loop(v);
        if (args->stats) {
            const int written = write_stats(v);
            code = code == EXIT_DONE ? written : code;
        }
        if (!v->rebuild.restart) {
            leave(v, code);
        }
    }
    char **again = code == EXIT_DONE && v->rebuild.restart ? rebuild_arguments(v) : NULL;
    close_device(v);
    if (code == EXIT_DONE && v->gpu.messages) {
        code = EXIT_FAILED;
    }
    panel_close();
    if (v->window) {
        glfwDestroyWindow(v->window);
    }
    glfwTerminate();
    if (again) {
        rebuild_restart(again);
        app_error(a, "'%s' cannot be started", again[0]);
        code = EXIT_FAILED;
    }
    rebuild_close(v);
    method_finish(&v->method);
    source_close(v);
    free(v->pixels);
    free(v->title);
    free(v->said);
    free(v);
    return code;
}
