// main.c -- a renderer whose own grains and balls are lit by the medium that floats around them.
//
// usage: lit-particles SCENE PICTURE.png [LIST.csv]     HOST_VALIDATION in the environment: under the validation layers,
//     of which one message is a failure
//
// In each frame the host draws with the light field that the frame before has left in its images, and Tyndall lays the medium
// over it and leaves the field anew; so the first frame has the backdrop alone. LIST is of what was drawn before the medium
// came over it: the place whose light was looked up, the direction towards the eye (balls: the normal), albedo, mean cosine
// of the lobe (balls: 2), and the radiance in the picture.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <tyndall/context.h>
#include <tyndall/io.h>

#include "painter.h"

enum { FRAMES = 3, GRAINS = 200, BALLS = 6, NUM_PARTICLES = GRAINS + BALLS };

static const tyn_sync copied_from = {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                                     VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
static const tyn_sync sampled = {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                 VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                                 VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};

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
        fprintf(stderr, "lit-particles: %s failed\n", what);
        exit(1);
    }
}

// ---- the host's scene ---------------------------------------------------------------------------

// Balls and grains on spirals up through the box [lo, hi].
static void place_particles(particle *out, const float lo[3], const float hi[3])
{
    for (int i = 0; i < NUM_PARTICLES; i++) {
        const bool ball = i < BALLS;
        const int k = ball ? i : i - BALLS;
        const float t = ((float)k + 0.5f) / (ball ? BALLS : GRAINS);
        const float turn = (ball ? 7.0f : 75.0f) * t,
                    width = ball ? 0.3f : 0.1f + 0.25f * (float)(k % 7) / 6;
        const float size = 0.5f * (hi[0] - lo[0] + hi[2] - lo[2]);
        out[i] = (particle){
            .position = {0.5f * (lo[0] + hi[0]) + width * size * cosf(turn),
                         lo[1] + t * (hi[1] - lo[1]),
                         0.5f * (lo[2] + hi[2]) + width * size * sinf(turn)},
            .radius = (ball ? 0.06f : 0.008f) * size,
            .albedo = {ball ? 0.8f : 0.95f, ball ? 0.5f : 0.85f, ball ? 0.4f : 0.5f},
            .g = ball ? SURFACE : 0.3f,
        };
    }
}

static camera_args see(const tyn_camera *camera, uint32_t num_particles)
{
    const float half = tanf(0.5f * camera->yfov);
    camera_args args = {.near_plane = 0.1f, .num_particles = num_particles};
    for (int a = 0; a < 3; a++) {
        args.eye[a] = camera->position[a];
        args.right[a] = half * camera->right[a];
        args.up[a] = half * camera->up[a];
        args.back[a] = camera->back[a];
    }
    return args;
}

static void projection(const tyn_camera *camera, float near_plane, float m[16])
{
    const float focal = 1 / tanf(0.5f * camera->yfov);
    memset(m, 0, 16 * sizeof(float));
    m[0] = focal * HEIGHT / WIDTH;
    m[5] = -focal; // Vulkan's y points down
    m[11] = -1;
    m[14] = near_plane;
}

// ---- what was drawn -----------------------------------------------------------------------------

// One line, if the particle is seen in the pixel that its middle falls in.
static void list_particle(FILE *to, const particle *p, const camera_args *c, const float *rgba,
                          const float *depths)
{
    const float tan2 = c->up[0] * c->up[0] + c->up[1] * c->up[1] + c->up[2] * c->up[2];
    float way[3], x = 0, y = 0, z = 0;
    for (int a = 0; a < 3; a++) {
        way[a] = p->position[a] - c->eye[a];
        x += way[a] * c->right[a] / tan2;
        y += way[a] * c->up[a] / tan2;
        z -= way[a] * c->back[a];
    }
    const int column = (int)floorf(0.5f * (WIDTH + x / z * HEIGHT)),
              row = (int)floorf(0.5f * (HEIGHT - y / z * HEIGHT));
    if (z <= 0 || column < 0 || row < 0 || column >= WIDTH || row >= HEIGHT) {
        return;
    }
    // The ray of that pixel and where it meets what is nearest.
    const int pixel = row * WIDTH + column;
    const float u = (2 * (float)column + 1 - WIDTH) / HEIGHT,
                v = (2 * (float)row + 1 - HEIGHT) / HEIGHT;
    const float distance = depths[pixel] > 0 ? c->near_plane / depths[pixel] : 0;
    float hit[3], aside[3], off2 = 0, length = 0;
    for (int a = 0; a < 3; a++) {
        way[a] = u * c->right[a] - v * c->up[a] - c->back[a];
        hit[a] = c->eye[a] + distance * way[a];
        aside[a] = hit[a] - p->position[a];
        off2 += aside[a] * aside[a];
        length += way[a] * way[a];
    }
    if (!(fabsf(sqrtf(off2) - p->radius) < 0.02f * p->radius)) {
        return; // something is before it
    }
    const float *at = p->g == SURFACE ? hit : p->position;
    fprintf(to, "%g,%g,%g", (double)at[0], (double)at[1], (double)at[2]);
    for (int a = 0; a < 3; a++) {
        fprintf(to, ",%g",
                (double)(p->g == SURFACE ? aside[a] / p->radius : -way[a] / sqrtf(length)));
    }
    const float *seen = rgba + 4 * pixel;
    fprintf(to, ",%g,%g,%g,%g,%g,%g,%g\n", (double)p->albedo[0], (double)p->albedo[1],
            (double)p->albedo[2], (double)p->g, (double)seen[0], (double)seen[1], (double)seen[2]);
}

static bool write_list(const char *path, const particle *particles, const camera_args *c,
                       const float *rgba, const float *depths)
{
    FILE *to = fopen(path, "w");
    if (!to) {
        fprintf(stderr, "lit-particles: %s cannot be written\n", path);
        return false;
    }
    fprintf(to, "x,y,z,to_x,to_y,to_z,albedo_r,albedo_g,albedo_b,g,r,g,b\n");
    for (int i = 0; i < NUM_PARTICLES; i++) {
        list_particle(to, &particles[i], c, rgba, depths);
    }
    return fclose(to) == 0;
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
    const tyn_log log = {print_log, NULL, TYN_LOG_WARN};
    if (argc < 3 || argc > 4) {
        fprintf(stderr, "usage: lit-particles SCENE PICTURE.png [LIST.csv]\n");
        return 2;
    }
    host h;
    if (host_open(&h, getenv("HOST_VALIDATION") != NULL) != HOST_OK) {
        return 77; // what a test runner takes for "skipped"
    }
    painter paint = painter_new(&h);
    host_buffer drawn = host_buffer_new(&h, WIDTH * HEIGHT * 16),
                done = host_buffer_new(&h, WIDTH * HEIGHT * 16);

    tyn_device_params device_params = {.struct_size = sizeof(device_params), .log = log};
    host_describe(&h, &device_params);
    tyn_device *dev = NULL;
    check(tyn_device_create(&device_params, &dev), "tyn_device_create");
    tyn_context *ctx = NULL;
    check(tyn_context_create(dev, tyn_context_params(.frames_in_flight = 1), &ctx),
          "tyn_context_create");
    tyn_scene scene;
    tyn_scene_init(&scene);
    check(tyn_scene_load(&scene, argv[1], NULL, &log), "tyn_scene_load");
    tyn_view view = {.width = WIDTH,
                     .height = HEIGHT,
                     .outputs = TYN_OUTPUT_COMPOSITE | TYN_OUTPUT_LIGHT,
                     .no_background = true};
    if (scene.num_cameras) {
        view.camera = scene.cameras[0];
    } else {
        tyn_camera_frame_scene(&view.camera, &scene);
    }
    float lo[3], hi[3];
    tyn_scene_bounds(&scene, lo, hi);
    place_particles(paint.particles.data, lo, hi);

    camera_args args = {0};
    for (uint32_t i = 0; i < FRAMES; i++) {
        VkCommandBuffer cmd = host_begin(&h, 0);
        args = see(&view.camera, i ? NUM_PARTICLES : 0);
        if (i) {
            check(tyn_context_light(ctx, args.world_to_texture), "tyn_context_light");
        } else { // there is no field yet
            for (int c = 0; c < 3; c++) {
                host_transition(&h, cmd, &paint.light[c], sampled);
            }
        }
        painter_draw(&h, &paint, cmd, &args);
        host_transition(&h, cmd, &paint.color, copied_from);
        host_download(&h, cmd, &paint.color, &drawn); // for the list

        tyn_image light[3];
        for (int c = 0; c < 3; c++) {
            light[c] = host_lend(&paint.light[c], sampled);
        }
        const tyn_image color = host_lend(&paint.color, copied_from),
                        depth = host_lend(&paint.depth, sampled);
        tyn_frame frame = {
            .struct_size = sizeof frame,
            .cmd = cmd,
            .scene = &scene,
            .view = &view,
            .color = &color,
            .depth = &depth,
            // With what comes straight from lights: nothing else lights the particles.
            .light = {&light[0], &light[1], &light[2], .unscattered = true}};
        projection(&view.camera, args.near_plane, frame.view_to_clip);
        check(tyn_context_prepare(ctx, &frame), "tyn_context_prepare");
        check(tyn_context_record(ctx, &frame), "tyn_context_record");
        host_download(&h, cmd, &paint.color, &done);
        host_submit(&h, 0);
        host_wait(&h, 0);
    }
    bool ok = write_picture(argv[2], done.data, &log);
    if (argc > 3) {
        ok = write_list(argv[3], paint.particles.data, &args, drawn.data, paint.depths.data) && ok;
    }
    tyn_context_destroy(&ctx);
    tyn_device_destroy(&dev);
    tyn_scene_finish(&scene);
    painter_free(&h, &paint);
    host_buffer_free(&h, &drawn);
    host_buffer_free(&h, &done);
    host_close(&h);
    return ok && h.messages == 0 ? 0 : 1;
}
