// path_run.c -- whole scenes through method `path`.
#include "path_run.h"
#include "numbers.h"
#include "offline_frame.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

uint32_t path_effort(uint32_t samples)
{
    const char *s = getenv("TYN_LONG");
    return s ? samples * (uint32_t)atoi(s) : samples;
}

void path_run_open(path_run *r, tyn_device *dev)
{
    *r = (path_run){.dev = dev};
    assert_int_equal(tyn_offline_create(dev, tyn_offline_params(.method = "path"), &r->off),
                     TYN_OK);
}

void path_run_close(path_run *r)
{
    tyn_offline_destroy(&r->off);
}

int path_run_setup(void **state)
{
    void *gpu = NULL;
    int result = gpu_setup(&gpu);
    if (result == 0) {
        path_run *r = malloc(sizeof *r);
        path_run_open(r, ((gpu_test *)gpu)->dev);
        r->gpu = gpu;
        *state = r;
    }
    return result;
}

int path_run_teardown(void **state)
{
    path_run *r = *state;
    void *gpu = r->gpu;
    path_run_close(r);
    free(r);
    return gpu_teardown(&gpu);
}

static void run(path_run *r, const tyn_scene *scene, tyn_view *view, uint32_t samples)
{
    view->num_samples = samples;
    view->seed = r->seed++;
    offline_frame(r->off, scene, view);
    assert_int_equal(tyn_device_validation_messages(r->dev), 0);
}

static float *copy_rgb(const float *rgba, size_t pixels)
{
    float *rgb = malloc(pixels * 3 * sizeof *rgb);
    for (size_t i = 0; i < pixels * 3; i++) {
        rgb[i] = rgba[i / 3 * 4 + i % 3];
    }
    return rgb;
}

void path_run_picture(path_run *r, picture *p, const tyn_scene *scene, const tyn_view *view,
                      uint32_t samples)
{
    tyn_view v = *view;
    v.outputs = TYN_OUTPUT_RADIANCE | TYN_OUTPUT_ERROR;
    run(r, scene, &v, samples);
    picture_free(p);
    *p = (picture){.width = v.width, .height = v.height};
    size_t pixels = (size_t)p->width * p->height;
    p->rgb = copy_rgb(tyn_offline_output(r->off, TYN_OUTPUT_RADIANCE), pixels);
    p->se = copy_rgb(tyn_offline_output(r->off, TYN_OUTPUT_ERROR), pixels);
}

const float *path_run_layer(path_run *r, const tyn_scene *scene, const tyn_view *view,
                            tyn_output output, uint32_t samples)
{
    tyn_view v = *view;
    v.outputs = TYN_OUTPUT_RADIANCE | output;
    run(r, scene, &v, samples);
    return tyn_offline_output(r->off, output);
}

const tyn_probe_result *path_run_probe(path_run *r, const tyn_scene *scene,
                                       const float (*points)[3], uint32_t num_points,
                                       bool scattered, uint32_t samples)
{
    tyn_view v = {.width = 1,
                  .height = 1,
                  .outputs = TYN_OUTPUT_PROBE,
                  .points = points,
                  .num_points = num_points,
                  .scattered_only = scattered};
    tyn_camera_frame_scene(&v.camera, scene);
    run(r, scene, &v, samples);
    return tyn_offline_output(r->off, TYN_OUTPUT_PROBE);
}

const tyn_balance *path_run_balance(path_run *r, const tyn_scene *scene, uint32_t samples)
{
    tyn_view v = {.width = 1, .height = 1, .outputs = TYN_OUTPUT_BALANCE};
    tyn_camera_frame_scene(&v.camera, scene);
    run(r, scene, &v, samples);
    return tyn_offline_output(r->off, TYN_OUTPUT_BALANCE);
}

const tyn_fluxes *path_run_fluxes(path_run *r, const tyn_scene *scene, uint32_t samples)
{
    tyn_view v = {.width = 1, .height = 1, .outputs = TYN_OUTPUT_FLUXES};
    tyn_camera_frame_scene(&v.camera, scene);
    run(r, scene, &v, samples);
    return tyn_offline_output(r->off, TYN_OUTPUT_FLUXES);
}

void view_perspective(tyn_view *view, const float from[3], const float at[3], float tangent,
                      uint32_t n)
{
    tyn_camera_look_at(&view->camera, from, at);
    view->camera.projection = TYN_PERSPECTIVE;
    view->camera.yfov = 2 * atanf(tangent);
    view->width = view->height = n;
}

void scene_add_lamp(tyn_scene *scene, const float position[3], float intensity)
{
    tyn_light *l = &scene->lights[scene->num_lights++];
    *l = (tyn_light){.kind = TYN_LIGHT_POINT,
                     .color = {intensity, intensity, intensity},
                     .direction = {0, -1, 0}};
    memcpy(l->position, position, sizeof l->position);
}

picture_score picture_z(const picture *a, const picture *reference, uint32_t block,
                        uint32_t channel)
{
    assert_int_equal(a->width, reference->width);
    assert_int_equal(a->height, reference->height);
    double sum = 0, sum_ref = 0, var = 0, z2 = 0, largest = 0;
    uint32_t blocks = 0;
    for (uint32_t y = 0; y + block <= a->height; y += block) {
        for (uint32_t x = 0; x + block <= a->width; x += block) {
            double off = 0, v = 0;
            for (uint32_t i = 0; i < block * block; i++) {
                size_t at = 3 * ((y + i / block) * a->width + x + i % block) + channel;
                double e = a->se ? a->se[at] : 0, er = reference->se ? reference->se[at] : 0;
                off += (double)a->rgb[at] - (double)reference->rgb[at];
                v += e * e + er * er;
                sum += a->rgb[at];
                sum_ref += reference->rgb[at];
            }
            var += v;
            if (!(v <= 0)) {
                z2 += off * off / v;
                largest = maximum(largest, fabs(off) / sqrt(v));
                blocks++;
            }
        }
    }
    return (picture_score){.bias = sum / sum_ref - 1,
                           .bias_se = sqrt(var) / sum_ref,
                           .rms = sqrt(z2 / fmax(blocks, 1)),
                           .largest = largest};
}
