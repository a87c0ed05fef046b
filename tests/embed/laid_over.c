// laid_over.c -- the medium over the host's picture: up to what the host has drawn, and at half the resolution.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "bound.h"
#include "built_in.h"
#include "fog_host.h"
#include "numbers.h"
#include "states.h"

// What becomes of a picture of the host, four floats a pixel, with its hardware depth in that format, or without (`deep` NULL); the
// caller frees it.
static float *lay_over(fixture *f, tyn_context *ctx, tyn_frame frame, const host_buffer *up,
                       const host_buffer *deep, VkFormat depth_format)
{
    const VkExtent3D size = {WIDTH, HEIGHT, 1};
    frame.struct_size = sizeof frame;
    host_image color = host_image_new(&f->host, VK_FORMAT_R32G32B32A32_SFLOAT, size,
                                      VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                          VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    host_image depth = host_image_new(&f->host, depth_format, size,
                                      VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    host_buffer down = host_buffer_new(&f->host, PIXELS * 16);
    frame.cmd = host_begin(&f->host, 0);
    color.state = depth.state = nothing_yet;
    host_transition(&f->host, frame.cmd, &color, copy_target);
    host_transition(&f->host, frame.cmd, &depth, copy_target);
    host_upload(&f->host, frame.cmd, up, &color);
    if (deep) {
        host_upload(&f->host, frame.cmd, deep, &depth);
    }
    const tyn_image lent_color = host_lend(&color, copy_source),
                    lent_depth = host_lend(&depth, sampled);
    frame.color = &lent_color, frame.depth = deep ? &lent_depth : NULL;
    assert_int_equal(tyn_context_prepare(ctx, &frame), TYN_OK);
    assert_int_equal(tyn_context_record(ctx, &frame), TYN_OK);
    host_download(&f->host, frame.cmd, &color, &down);
    host_submit(&f->host, 0);
    host_wait(&f->host, 0);
    float *copy = malloc(PIXELS * 16);
    memcpy(copy, down.data, PIXELS * 16);
    host_image_free(&f->host, &color);
    host_image_free(&f->host, &depth);
    host_buffer_free(&f->host, &down);
    return copy;
}

// ---- depth --------------------------------------------------------------------------------------

// A ray of the host in its view space, by its own matrix: the way to pixel (x, y), moved.
typedef struct view_ray {
    double from[3], to[3]; // to: a direction
} view_ray;

static view_ray ray_of(const tyn_frame *frame, int x, int y)
{
    const float *m = frame->view_to_clip;
    const double ndc[2] = {2 * (x + 0.5 + (double)frame->jitter[0]) / WIDTH - 1,
                           2 * (y + 0.5 + (double)frame->jitter[1]) / HEIGHT - 1};
    view_ray r = {{0, 0, 0}, {0, 0, -1}};
    for (int a = 0; a < 2; a++) {
        const double scale = (double)m[5 * a];
        if (m[11] != 0) {
            r.to[a] = (ndc[a] + (double)m[8 + a]) / scale;
        } else {
            r.from[a] = (ndc[a] - (double)m[12 + a]) / scale;
        }
    }
    return r;
}

static void to_world(const tyn_camera *c, const double v[3], double w, double out[3])
{
    for (int a = 0; a < 3; a++) {
        out[a] = (double)c->right[a] * v[0] + (double)c->up[a] * v[1] + (double)c->back[a] * v[2] +
                 w * (double)c->position[a];
    }
}

// Where a ray, `from` + t `to`, meets the host's wall, which stands askew in the fog.
static double meet_wall(const double from[3], const double to[3])
{
    static const double normal[3] = {0.3, 0.2, 1}, at[3] = {0.15, -0.1, 0.2};
    double along = 0, left = 0;
    for (int a = 0; a < 3; a++) {
        along += normal[a] * to[a];
        left += normal[a] * (at[a] - from[a]);
    }
    return left / along;
}

// The part of a ray up to t = `most` that is in the box of make_scene.
static double way_in_fog(const float m[16], const double from[3], const double to[3], double most)
{
    double first = 0, last = most;
    for (int i = 0; i < 3; i++) {
        double start = 0, step = 0, length2 = 0;
        for (int a = 0; a < 3; a++) {
            const double column = (double)m[4 * i + a];
            start += column * (from[a] - (double)m[12 + a]);
            step += column * to[a];
            length2 += column * column;
        }
        const double near = (-0.5 * length2 - start) / step, far = (0.5 * length2 - start) / step;
        first = maximum(first, minimum(near, far));
        last = minimum(last, maximum(near, far));
    }
    return last > first ? last - first : 0;
}

static double length_of(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

// Largest error of what the fog lets pass in front of the wall: e to the minus sigma_t times the way to the depth that the
// host hands over. `cut`: how many pixels have fog before the wall and behind it.
static double depth_error(fixture *f, tyn_context *ctx, const tyn_scene *scene,
                          const tyn_frame *frame, const tyn_camera *camera, int *cut)
{
    host_buffer white = host_buffer_new(&f->host, PIXELS * 16),
                black = host_buffer_new(&f->host, PIXELS * 16),
                deep = host_buffer_new(&f->host, PIXELS * 4);
    static double way[PIXELS];
    const float *m = frame->view_to_clip;
    *cut = 0;
    for (int i = 0; i < PIXELS; i++) {
        const view_ray r = ray_of(frame, i % WIDTH, i / WIDTH);
        double from[3], to[3];
        to_world(camera, r.from, 1, from);
        to_world(camera, r.to, 0, to);
        const double t = meet_wall(from, to), z = r.from[2] + t * r.to[2];
        ((float *)deep.data)[i] =
            (float)(((double)m[10] * z + (double)m[14]) / ((double)m[11] * z + (double)m[15]));
        way[i] = length_of(to) * way_in_fog(scene->shapes[0].to_world, from, to, t);
        *cut += way[i] > 0 && way_in_fog(scene->shapes[0].to_world, from, to, 1e3) >
                                  way_in_fog(scene->shapes[0].to_world, from, to, t);
        for (int c = 0; c < 4; c++) {
            ((float *)white.data)[4 * i + c] = 1;
            ((float *)black.data)[4 * i + c] = 0;
        }
    }
    float *over_white = lay_over(f, ctx, *frame, &white, &deep, VK_FORMAT_D32_SFLOAT);
    float *over_black = lay_over(f, ctx, *frame, &black, &deep, VK_FORMAT_D32_SFLOAT);
    double worst = 0;
    for (int i = 0; i < PIXELS; i++) {
        for (int c = 0; c < 3; c++) {
            const tyn_medium *fog = &scene->media[0];
            const double right = exp(-(double)(fog->sigma_s[c] + fog->sigma_a[c]) * way[i]);
            const double found = (double)over_white[4 * i + c] - (double)over_black[4 * i + c];
            worst = maximum(worst, fabs(found - right));
        }
    }
    free(over_white);
    free(over_black);
    host_buffer_free(&f->host, &white);
    host_buffer_free(&f->host, &black);
    host_buffer_free(&f->host, &deep);
    return worst;
}

void depth_under_matrices(void **state)
{
    fixture *f = *state;
    tyn_scene scene;
    make_scene(&scene);
    tyn_context *ctx = new_context(f, "single");
    // A ray through the middle of every pixel.
    assert_int_equal(tyn_context_set(ctx, "raymarch.sparse", "0"), TYN_OK);
    assert_int_equal(tyn_context_set(ctx, "raymarch.antialias", "0"), TYN_OK);
    tyn_view view = make_view(TYN_OUTPUT_COMPOSITE);
    memset(&view.camera, 0, sizeof view.camera); // it is not read
    for (int kind = 0; kind < 4; kind++) {
        const bool parallel = kind >= 2;
        const tyn_camera camera = make_camera(parallel);
        tyn_frame frame = {.scene = &scene, .view = &view, .jitter = {0.35f, -0.45f}};
        set_world_to_view(&frame, &camera, 1);
        set_view_to_clip(&frame, &camera, (float)WIDTH / HEIGHT,
                         kind % 2 ? REVERSED_INFINITE : NEAR_FAR);
        // Off-axis: the picture's middle is beside the view's.
        frame.view_to_clip[parallel ? 12 : 8] = 0.3f;
        frame.view_to_clip[parallel ? 13 : 9] = -0.2f;
        int cut = 0;
        const double off = depth_error(f, ctx, &scene, &frame, &camera, &cut);
        print_message("%s, kind %d: transmittance off by %.2g, %d pixels cut\n",
                      parallel ? "parallel" : "off-axis", kind, off, cut);
        assert_true(cut > PIXELS / 10);
        assert_true(off <= 1e-4);
    }
    tyn_context_destroy(&ctx);
    tyn_scene_finish(&scene);
    assert_int_equal(f->lines, 0);
}

// ---- half resolution ----------------------------------------------------------------------------

// Black, with a card in front of a part of the fog: what is laid over it with a view of half the size, against one of the
// whole size.
static float *composite(fixture *f, tyn_context *ctx, const tyn_scene *scene, uint32_t divisor,
                        VkFormat depth_format)
{
    tyn_view view = make_view(TYN_OUTPUT_COMPOSITE);
    view.width /= divisor, view.height /= divisor;
    tyn_frame frame = {.scene = scene, .view = &view};
    set_view_to_clip(&frame, &view.camera, (float)WIDTH / HEIGHT, REVERSED_INFINITE);
    host_buffer up = host_buffer_new(&f->host, PIXELS * 16),
                deep = host_buffer_new(&f->host, PIXELS * 4);
    const host_card cards[2] = {{0, 0, WIDTH, HEIGHT, {0, 0, 0, 1}, 0},
                                {21, 13, 19, 23, {0, 0, 0, 1}, 0.5f / 4.6f}};
    host_paint(&up, &deep, WIDTH, HEIGHT, cards, 2);
    float *laid = lay_over(f, ctx, frame, &up, &deep, depth_format);
    host_buffer_free(&f->host, &up);
    host_buffer_free(&f->host, &deep);
    return laid;
}

void half_resolution(void **state)
{
    fixture *f = *state;
    tyn_scene scene;
    make_scene(&scene);
    tyn_context *ctx = new_context(f, "pop");
    float *whole = composite(f, ctx, &scene, 1, VK_FORMAT_D32_SFLOAT),
          *half = composite(f, ctx, &scene, 2, VK_FORMAT_D32_SFLOAT);
    double sum = 0, edges = 0, mean = 0;
    uint32_t pixels = 0, near_edge = 0;
    for (uint32_t y = 8; y < HEIGHT - 8; y++) { // within the fog
        for (uint32_t x = 16; x < WIDTH - 16; x++) {
            const size_t i = 4 * ((size_t)y * WIDTH + x);
            const double off = fabs((double)half[i] - (double)whole[i]);
            const bool beside = (x >= 20 && x <= 21) || (x >= 39 && x <= 40);
            if (beside && y > 14 && y < 34) {
                edges += off;
                near_edge++;
            }
            sum += off;
            mean += (double)whole[i];
            pixels++;
        }
    }
    mean /= pixels;
    const double all = sum / pixels / mean, at_edges = edges / near_edge / mean;
    print_message("half resolution: %.2g of the mean off, %.2g at edges of depth\n", all, at_edges);
    assert_true(mean > 0.01);
    assert_within(all, 5e-2, NULL); // most of it at the outline of the fog
    assert_within(at_edges, 6e-2, NULL);
    free(whole);
    free(half);
    tyn_context_destroy(&ctx);
    tyn_scene_finish(&scene);
    assert_int_equal(f->lines, 0);
}

// A depth image with stencil beside it does the same, and Vulkan's checks find nothing wrong with its barriers.
void depth_with_stencil(void **state)
{
    fixture *f = *state;
    tyn_scene scene;
    make_scene(&scene);
    tyn_context *ctx = new_context(f, "pop");
    for (uint32_t divisor = 1; divisor <= 2; divisor++) {
        float *plain = composite(f, ctx, &scene, divisor, VK_FORMAT_D32_SFLOAT);
        float *stencil = composite(f, ctx, &scene, divisor, VK_FORMAT_D32_SFLOAT_S8_UINT);
        assert_memory_equal(plain, stencil, PIXELS * 16);
        free(plain);
        free(stencil);
    }
    tyn_context_destroy(&ctx);
    tyn_scene_finish(&scene);
    assert_int_equal(f->lines, 0);
}

static void refuse_depth(fixture *f, tyn_context *ctx, const tyn_scene *scene)
{
    const VkExtent3D size = {WIDTH, HEIGHT, 1};
    host_image color =
        host_image_new(&f->host, VK_FORMAT_R32G32B32A32_SFLOAT, size, VK_IMAGE_USAGE_STORAGE_BIT);
    host_image depth =
        host_image_new(&f->host, VK_FORMAT_D32_SFLOAT, size, VK_IMAGE_USAGE_SAMPLED_BIT);
    const tyn_image lent_color = host_lend(&color, general),
                    lent_depth = host_lend(&depth, sampled);
    const tyn_view view = make_view(TYN_OUTPUT_COMPOSITE);
    tyn_frame frame = {.struct_size = sizeof frame,
                       .scene = scene,
                       .view = &view,
                       .color = &lent_color,
                       .depth = &lent_depth};
    set_view_to_clip(&frame, &view.camera, (float)WIDTH / HEIGHT, REVERSED_INFINITE);
    assert_int_equal(tyn_context_prepare(ctx, &frame), TYN_ERR_UNSUPPORTED);
    assert_int_equal(f->lines, 1);
    assert_non_null(strstr(f->last_line, "'pop' takes depth"));
    f->lines = 0;
    host_image_free(&f->host, &color);
    host_image_free(&f->host, &depth);
}

// Method refined is laid over a picture as its own picture and transmittance say, without the sky behind and with samples of larger
// squares too. Where there is depth it is refused, as paths do not end at the host's surfaces.
void refined_without_depth(void **state)
{
    fixture *f = *state;
    if (!is_built_in("refined")) {
        return;
    }
    tyn_scene scene;
    make_scene(&scene);
    scene.environment = (tyn_environment){.present = true, .radiance = {1, 2, 3}, .strength = 1};
    host_buffer up = host_buffer_new(&f->host, PIXELS * 16);
    for (int i = 0; i < 4 * PIXELS; i++) {
        ((float *)up.data)[i] = 0.5f;
    }
    static const char *const grids[] = {"1", "2"};
    for (int k = 0; k < 2; k++) {
        tyn_context *ctx = new_context(f, "refined");
        assert_int_equal(tyn_context_set(ctx, "refine.grid", grids[k]), TYN_OK);
        tyn_view view =
            make_view(TYN_OUTPUT_COMPOSITE | TYN_OUTPUT_RADIANCE | TYN_OUTPUT_TRANSMITTANCE);
        view.num_samples = 16;
        const tyn_frame frame = {.scene = &scene, .view = &view};
        float *laid = lay_over(f, ctx, frame, &up, NULL, VK_FORMAT_D32_SFLOAT);
        const float *light = tyn_context_output(ctx, TYN_OUTPUT_RADIANCE);
        const float *left = tyn_context_output(ctx, TYN_OUTPUT_TRANSMITTANCE);
        double worst = 0;
        for (int i = 0; i < 4 * PIXELS; i++) {
            if (i % 4 < 3) {
                const double right = (double)light[i] + 0.5 * (double)left[i];
                worst = maximum(worst, fabs((double)laid[i] - right));
            }
        }
        assert_true(worst <= 1e-6);
        assert_true(light[0] == 0); // no fog, and none of the sky
        free(laid);
        assert_int_equal(f->lines, 0);
        refuse_depth(f, ctx, &scene);
        tyn_context_destroy(&ctx);
    }
    host_buffer_free(&f->host, &up);
    tyn_scene_finish(&scene);
}
