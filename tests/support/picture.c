// picture.c -- scenes made in code, pictures of them, and how far apart two pictures are.
#include "picture.h"
#include "npy.h"
#include "numbers.h"
#include "offline_frame.h"
#include "vector.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

void picture_free(picture *p)
{
    free(p->rgb);
    free(p->se);
    *p = (picture){0};
}

// ---- scenes -----------------------------------------------------------------------------------

tyn_medium grey_medium(float sigma_s, float sigma_a, float g)
{
    tyn_medium m = {.density_scale = 1, .volume = -1};
    for (int c = 0; c < 3; c++) {
        m.sigma_s[c] = sigma_s;
        m.sigma_a[c] = sigma_a;
        m.phase[c].g = g;
    }
    return m;
}

tyn_shape *scene_add_box(tyn_scene *scene, const tyn_medium *medium, const float lo[3],
                         const float hi[3], const uint32_t size[3], const float *grid)
{
    uint32_t m = scene->num_media++;
    scene->media[m] = *medium;
    if (grid) {
        size_t count = (size_t)size[0] * size[1] * size[2];
        scene->volumes = realloc(scene->volumes, (scene->num_volumes + 1) * sizeof *scene->volumes);
        tyn_volume *v = &scene->volumes[scene->num_volumes];
        *v = (tyn_volume){.size = {size[0], size[1], size[2]},
                          .data = malloc(count * sizeof *grid),
                          .hash = 1 + scene->num_volumes};
        memcpy(v->data, grid, count * sizeof *grid);
        for (size_t i = 0; i < count; i++) {
            v->max_density = fmaxf(v->max_density, grid[i]);
        }
        scene->media[m].volume = (int32_t)scene->num_volumes++;
    }
    tyn_shape *s = &scene->shapes[scene->num_shapes++];
    *s = (tyn_shape){.kind = TYN_SHAPE_BOX, .medium = m};
    for (int i = 0; i < 3; i++) {
        s->to_world[5 * i] = hi[i] - lo[i];
        s->to_world[12 + i] = 0.5f * (lo[i] + hi[i]);
    }
    s->to_world[15] = 1;
    return s;
}

void scene_add_sun(tyn_scene *scene, float x, float y, float z, float r, float g, float b)
{
    tyn_light *l = &scene->lights[scene->num_lights++];
    *l = (tyn_light){.kind = TYN_LIGHT_DIRECTIONAL, .color = {r, g, b}, .direction = {x, y, z}};
    vector_normalisef(l->direction);
}

void scene_set_sky(tyn_scene *scene, float radiance)
{
    scene->environment = (tyn_environment){
        .present = true, .radiance = {radiance, radiance, radiance}, .strength = 1};
}

void view_orthographic(tyn_view *view, const float centre[3], float x, float y, float z,
                       const float up[3], float half, uint32_t n)
{
    tyn_camera *c = &view->camera;
    float d[3] = {x, y, z};
    vector_normalisef(d);
    vector_crossf(d, up, c->right);
    vector_normalisef(c->right);
    vector_crossf(c->right, d, c->up);
    for (int i = 0; i < 3; i++) {
        c->back[i] = -d[i];
        c->position[i] = centre[i] - 8 * half * d[i];
    }
    c->projection = TYN_ORTHOGRAPHIC;
    c->ymag = half;
    view->width = view->height = n;
}

// ---- pictures ---------------------------------------------------------------------------------

tyn_offline *scene_open(tyn_device *dev, const char *method, const char *settings)
{
    tyn_settings *values;
    assert_int_equal(tyn_settings_create(&values), TYN_OK);
    char text[256];
    snprintf(text, sizeof text, "%s", settings ? settings : "");
    for (char *word = strtok(text, " "); word; word = strtok(NULL, " ")) {
        char *equals = strchr(word, '=');
        assert_non_null(equals);
        *equals = 0;
        assert_int_equal(tyn_settings_set(values, word, equals + 1, NULL), TYN_OK);
    }
    tyn_offline *off;
    assert_int_equal(
        tyn_offline_create(dev, tyn_offline_params(.method = method, .settings = values), &off),
        TYN_OK);
    tyn_settings_destroy(&values);
    return off;
}

static float *copy_rgb(const float *rgba, size_t pixels)
{
    float *rgb = malloc(pixels * 3 * sizeof *rgb);
    for (size_t i = 0; i < pixels * 3; i++) {
        rgb[i] = rgba[i / 3 * 4 + i % 3];
    }
    return rgb;
}

void picture_frame(picture *p, tyn_device *dev, tyn_offline *off, const tyn_scene *scene,
                   const tyn_view *view, bool sampled)
{
    tyn_view v = *view;
    v.outputs = TYN_OUTPUT_RADIANCE | (sampled ? TYN_OUTPUT_ERROR : 0);
    offline_frame(off, scene, &v);
    *p = (picture){.width = v.width, .height = v.height};
    size_t pixels = (size_t)p->width * p->height;
    p->rgb = copy_rgb(tyn_offline_output(off, TYN_OUTPUT_RADIANCE), pixels);
    if (sampled) {
        p->se = copy_rgb(tyn_offline_output(off, TYN_OUTPUT_ERROR), pixels);
    }
    assert_int_equal(tyn_device_validation_messages(dev), 0);
}

void picture_render(picture *p, tyn_device *dev, const char *method, const tyn_scene *scene,
                    const tyn_view *view, const char *settings, uint32_t spp)
{
    tyn_method_info told;
    tyn_method_named(method, &told);
    tyn_offline *off = scene_open(dev, method, settings);
    tyn_view v = *view;
    v.num_samples = spp;
    picture_frame(p, dev, off, scene, &v, told.outputs & TYN_OUTPUT_ERROR);
    tyn_offline_destroy(&off);
}

bool picture_reference(picture *p, const char *name)
{
    char file[128], path[512];
    snprintf(file, sizeof file, "reference/images/%s.npy", name);
    npy_array a;
    if (!shared_path(path, sizeof path, file)) {
        return false;
    }
    assert_true(npy_read(&a, path));
    uint32_t h = a.shape[0], w = a.shape[1], k = a.shape[2] / 2;
    *p = (picture){.width = w, .height = h};
    p->rgb = malloc((size_t)w * h * 3 * sizeof *p->rgb);
    p->se = malloc((size_t)w * h * 3 * sizeof *p->se);
    for (uint32_t i = 0; i < w * h; i++) {
        const float *from = a.data + (size_t)(i / w * w + (w - 1 - i % w)) * 2 * k;
        for (uint32_t c = 0; c < 3; c++) {
            p->rgb[3 * i + c] = from[c % k];
            p->se[3 * i + c] = from[k + c % k];
        }
    }
    npy_free(&a);
    return true;
}

// Mean over a block; of standard errors: that of the mean.
static double block_mean(const picture *p, const float *values, uint32_t x0, uint32_t y0,
                         uint32_t block, uint32_t c, bool squares)
{
    double sum = 0;
    for (uint32_t i = 0; i < block * block; i++) {
        double v = values[3 * ((y0 + i / block) * p->width + x0 + i % block) + c];
        sum += squares ? v * v : v;
    }
    return (squares ? sqrt(sum) : sum) / (block * block);
}

picture_error picture_compare(const picture *a, const picture *reference, uint32_t block)
{
    assert_int_equal(a->width, reference->width);
    assert_int_equal(a->height, reference->height);
    double off = 0, sum = 0, sum_abs = 0, sum_a = 0, se = 0, worst = 0;
    for (int pass = 0; pass < 2; pass++) {
        double mean = sum_abs / (3.0 * (a->width / block) * (a->height / block));
        for (uint32_t y = 0; y + block <= a->height; y += block) {
            for (uint32_t x = 0; x + block <= a->width; x += block) {
                for (uint32_t c = 0; c < 3; c++) {
                    double va = block_mean(a, a->rgb, x, y, block, c, false);
                    double vr = block_mean(a, reference->rgb, x, y, block, c, false);
                    if (pass) {
                        worst = maximum(worst, fabs(va - vr) / (fabs(vr) + 0.01 * mean));
                        continue;
                    }
                    double ea = a->se ? block_mean(a, a->se, x, y, block, c, true) : 0;
                    double er =
                        reference->se ? block_mean(a, reference->se, x, y, block, c, true) : 0;
                    off += fabs(va - vr);
                    sum += vr;
                    sum_abs += fabs(vr);
                    sum_a += va;
                    se += sqrt(ea * ea + er * er);
                }
            }
        }
    }
    picture_error e = {.rel_l1 = off / sum_abs, .bias = sum_a / sum - 1, .worst = worst};
    e.noise = sqrt(2 / 3.14159265358979) * se / sum_abs;
    e.reported = sqrt(maximum(0, e.rel_l1 * e.rel_l1 - e.noise * e.noise));
    return e;
}

const tyn_probe_result *scene_probes(tyn_device *dev, tyn_offline *off, const tyn_scene *scene,
                                     const float (*points)[3], uint32_t n)
{
    tyn_view view = {
        .width = 1, .height = 1, .outputs = TYN_OUTPUT_PROBE, .points = points, .num_points = n};
    tyn_camera_frame_scene(&view.camera, scene);
    offline_frame(off, scene, &view);
    assert_int_equal(tyn_device_validation_messages(dev), 0);
    return tyn_offline_output(off, TYN_OUTPUT_PROBE);
}

double scene_imbalance(tyn_device *dev, const char *method, const tyn_scene *scene,
                       const char *settings)
{
    tyn_offline *off = scene_open(dev, method, settings);
    tyn_view view = {.width = 1, .height = 1, .outputs = TYN_OUTPUT_BALANCE};
    tyn_camera_frame_scene(&view.camera, scene);
    offline_frame(off, scene, &view);
    const tyn_balance *balance = tyn_offline_output(off, TYN_OUTPUT_BALANCE);
    assert_non_null(balance);
    double worst = 0;
    for (int c = 0; c < 3; c++) {
        worst = maximum(worst, fabs(balance->imbalance[c]));
    }
    tyn_offline_destroy(&off);
    return worst;
}

const char *picture_bias_why(const picture_error *e)
{
    return fabs(e->bias) < 0.2 * e->noise ? "the reference's mean is no surer" : NULL;
}
