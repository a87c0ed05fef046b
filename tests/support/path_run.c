// path_run.c -- whole scenes through method `path`.
#include "path_run.h"
#include "numbers.h"
#include "offline_frame.h"
#include "references.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

uint32_t path_effort(uint32_t samples)
{
    const char *s = getenv("TYN_LONG");
    return s ? samples * (uint32_t)atoi(s) : samples;
}

void path_run_open(path_run *r, tyn_device *dev)
{
    *r = (path_run){.dev = dev, .kept = true};
    assert_int_equal(tyn_offline_create(dev, tyn_offline_params(.method = "path"), &r->off),
                     TYN_OK);
}

void path_run_close(path_run *r)
{
    tyn_offline_destroy(&r->off);
    free(r->probes);
    r->probes = NULL;
}

static int set_up(void **state, bool kept)
{
    void *gpu = NULL;
    int result = gpu_setup(&gpu);
    if (result == 0) {
        path_run *r = malloc(sizeof *r);
        path_run_open(r, ((gpu_test *)gpu)->dev);
        r->gpu = gpu;
        r->kept = kept;
        *state = r;
    }
    return result;
}

int path_run_setup(void **state)
{
    return set_up(state, false);
}

int path_run_setup_kept(void **state)
{
    return set_up(state, true);
}

int path_run_teardown(void **state)
{
    path_run *r = *state;
    void *gpu = r->gpu;
    path_run_close(r);
    free(r);
    return gpu_teardown(&gpu);
}

// What `v` asks for with so many samples, and its key; 0 of results that are not kept.
static uint64_t next_key(path_run *r, const tyn_scene *scene, tyn_view *v, uint32_t samples)
{
    v->num_samples = samples;
    v->seed = r->seed++;
    return r->kept ? reference_key(scene, v) : 0;
}

// `key`: of a result that should have been kept, which tools/totals counts; else 0.
static void run(path_run *r, const tyn_scene *scene, const tyn_view *view, uint64_t key)
{
    if (key) {
        printf("reference: %016llx, not in tests/references, or of other kernels\n",
               (unsigned long long)key);
    }
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
    const uint64_t key = next_key(r, scene, &v, samples);
    picture_free(p);
    if (key && reference_read_picture(key, p)) {
        return;
    }
    run(r, scene, &v, key);
    *p = (picture){.width = v.width, .height = v.height};
    size_t pixels = (size_t)p->width * p->height;
    p->rgb = copy_rgb(tyn_offline_output(r->off, TYN_OUTPUT_RADIANCE), pixels);
    p->se = copy_rgb(tyn_offline_output(r->off, TYN_OUTPUT_ERROR), pixels);
    if (key) {
        reference_write_picture(key, p);
    }
}

void path_reference(picture *p, tyn_device *dev, const tyn_scene *scene, const tyn_view *view,
                    uint32_t samples)
{
    path_run r;
    path_run_open(&r, dev);
    r.seed = view->seed;
    *p = (picture){0};
    path_run_picture(&r, p, scene, view, samples);
    path_run_close(&r);
}

const float *path_run_layer(path_run *r, const tyn_scene *scene, const tyn_view *view,
                            tyn_output output, uint32_t samples)
{
    tyn_view v = *view;
    v.outputs = TYN_OUTPUT_RADIANCE | output;
    assert_false(r->kept);
    next_key(r, scene, &v, samples);
    run(r, scene, &v, 0);
    return tyn_offline_output(r->off, output);
}

// A view of no picture, in front of the scene.
static tyn_view view_of_numbers(const tyn_scene *scene, uint32_t outputs)
{
    tyn_view v = {.width = 1, .height = 1, .outputs = outputs};
    tyn_camera_frame_scene(&v.camera, scene);
    return v;
}

const tyn_probe_result *path_run_probe(path_run *r, const tyn_scene *scene,
                                       const float (*points)[3], uint32_t num_points,
                                       bool scattered, uint32_t samples)
{
    tyn_view v = view_of_numbers(scene, TYN_OUTPUT_PROBE);
    v.points = points;
    v.num_points = num_points;
    v.scattered_only = scattered;
    const uint64_t key = next_key(r, scene, &v, samples);
    const size_t count = num_points * sizeof *r->probes / sizeof(float);
    free(r->probes);
    r->probes = malloc(num_points * sizeof *r->probes);
    if (!key || !reference_read_floats(key, (float *)r->probes, count)) {
        run(r, scene, &v, key);
        memcpy(r->probes, tyn_offline_output(r->off, TYN_OUTPUT_PROBE), count * sizeof(float));
        if (key) {
            reference_write_floats(key, (const float *)r->probes, count);
        }
    }
    return r->probes;
}

const tyn_balance *path_run_balance(path_run *r, const tyn_scene *scene, uint32_t samples)
{
    tyn_view v = view_of_numbers(scene, TYN_OUTPUT_BALANCE);
    const uint64_t key = next_key(r, scene, &v, samples);
    const size_t count = sizeof r->balance / sizeof(double);
    if (!key || !reference_read_doubles(key, (double *)&r->balance, count)) {
        run(r, scene, &v, key);
        r->balance = *(const tyn_balance *)tyn_offline_output(r->off, TYN_OUTPUT_BALANCE);
        if (key) {
            reference_write_doubles(key, (const double *)&r->balance, count);
        }
    }
    return &r->balance;
}

const tyn_fluxes *path_run_fluxes(path_run *r, const tyn_scene *scene, uint32_t samples)
{
    tyn_view v = view_of_numbers(scene, TYN_OUTPUT_FLUXES);
    const uint64_t key = next_key(r, scene, &v, samples);
    const size_t count = sizeof r->fluxes / sizeof(float);
    if (!key || !reference_read_floats(key, (float *)&r->fluxes, count)) {
        run(r, scene, &v, key);
        r->fluxes = *(const tyn_fluxes *)tyn_offline_output(r->off, TYN_OUTPUT_FLUXES);
        if (key) {
            reference_write_floats(key, (const float *)&r->fluxes, count);
        }
    }
    return &r->fluxes;
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
