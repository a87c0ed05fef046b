// reference.c -- converged pictures with their standard errors: by `path`, cached by what they depend on, or a
// file of the user's.
#include "reference.h"
#include "cache.h"
#include "renderer.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- what it depends on -----------------------------------------------------------------------

#define HASH(value, seed) text_hash(&(value), sizeof(value), seed)

static uint64_t hash_media(const tyn_scene *scene, uint64_t key)
{
    for (uint32_t i = 0; i < scene->num_volumes; i++) {
        key = HASH(scene->volumes[i].hash, HASH(scene->volumes[i].size, key));
    }
    for (uint32_t i = 0; i < scene->num_media; i++) {
        const tyn_medium *m = &scene->media[i];
        key = HASH(m->sigma_s, HASH(m->sigma_a, HASH(m->phase, HASH(m->emission, key))));
        key = HASH(m->density_scale, HASH(m->volume, key));
    }
    for (uint32_t i = 0; i < scene->num_shapes; i++) {
        const tyn_shape *s = &scene->shapes[i];
        key = HASH(s->kind, HASH(s->medium, HASH(s->to_world, HASH(s->repeat, key))));
    }
    return key;
}

static uint64_t hash_lights(const tyn_scene *scene, uint64_t key)
{
    for (uint32_t i = 0; i < scene->num_lights; i++) {
        const tyn_light *l = &scene->lights[i];
        key = HASH(l->kind, HASH(l->color, HASH(l->position, HASH(l->direction, key))));
        key = HASH(l->cos_inner, HASH(l->cos_outer, key));
    }
    const tyn_environment *e = &scene->environment;
    if (e->present) {
        key = HASH(e->hash, HASH(e->size, HASH(e->radiance, HASH(e->rotation, key))));
        key = HASH(e->strength, key);
    }
    return key;
}

static uint64_t hash_surfaces(const tyn_surfaces *s, uint64_t key)
{
    if (s->num_triangles == 0) {
        return key;
    }
    key = text_hash(s->vertices, s->num_vertices * sizeof *s->vertices, key);
    key = text_hash(s->triangles, s->num_triangles * sizeof *s->triangles, key);
    key = text_hash(s->materials, s->num_materials * sizeof *s->materials, key);
    for (uint32_t i = 0; i < s->num_textures; i++) {
        const tyn_texture *t = &s->textures[i];
        key = text_hash(t->texels, (size_t)4 * t->size[0] * t->size[1], HASH(t->wrap, key));
        // The number of texels tells the size of a square; others may share it.
        key = t->size[0] == t->size[1] ? key : HASH(t->size, key);
    }
    return key;
}

uint64_t bench_scene_hash(const tyn_scene *scene, const tyn_view *view)
{
    uint64_t key = hash_media(scene, 1);
    key = hash_lights(scene, key);
    key = hash_surfaces(&scene->surfaces, key);
    const tyn_camera *c = &view->camera;
    key = HASH(c->projection, HASH(c->position, HASH(c->right, HASH(c->up, HASH(c->back, key)))));
    key = HASH(c->yfov, HASH(c->ymag, key));
    return HASH(view->width, HASH(view->height, HASH(view->no_background, key)));
}

// The scene, the samples and the code that renders it.
static uint64_t reference_key(const bench_scene *spec, const tyn_scene *scene, const tyn_view *view,
                              const tyn_method_info *path)
{
    uint64_t key = HASH(spec->reference_spp, bench_scene_hash(scene, view));
    for (const tyn_pass_desc *const *pass = path->passes; *pass; pass++) {
        for (uint32_t k = 0; k < (*pass)->num_kernels; k++) {
            const tyn_kernel *kernel = &(*pass)->kernels[k];
            key = text_hash(kernel->spirv, kernel->spirv_size, key);
        }
    }
    return key;
}

static char *cached_path(const char *key)
{
    char name[48];
    snprintf(name, sizeof name, "references/%s.exr", key);
    return cache_path(name);
}

// ---- pictures ---------------------------------------------------------------------------------

static const char *const names[6] = {"R", "G", "B", "error.R", "error.G", "error.B"};

// False: not of that size, or a channel is missing; errors may be.
static bool take_channels(bench_reference *r, const tyn_view *view)
{
    r->image = (metrics_image){.width = r->file.width, .height = r->file.height};
    r->known_noise = true;
    bool whole = r->file.width == view->width && r->file.height == view->height;
    for (int i = 0; i < 3; i++) {
        r->image.rgb[i] = tyn_image_file_channel(&r->file, names[i]);
        r->image.se[i] = tyn_image_file_channel(&r->file, names[3 + i]);
        whole = whole && r->image.rgb[i];
        r->known_noise = r->known_noise && r->image.se[i];
    }
    return whole;
}

void bench_planes(tyn_offline *offline, const tyn_view *view, float *planes, metrics_image *image)
{
    const size_t num = (size_t)view->width * view->height;
    const float *color = tyn_offline_output(offline, TYN_OUTPUT_RADIANCE);
    const float *error = tyn_offline_output(offline, TYN_OUTPUT_ERROR);
    *image = (metrics_image){.width = view->width, .height = view->height};
    for (int i = 0; i < 3; i++) {
        for (size_t k = 0; k < num; k++) {
            planes[i * num + k] = color ? color[4 * k + i] : NAN;
            planes[(3 + i) * num + k] = error ? error[4 * k + i] : 0;
        }
        image->rgb[i] = planes + i * num;
        image->se[i] = error ? planes + (3 + i) * num : NULL;
    }
}

int bench_picture_write(app *a, const metrics_image *image, bool errors, const char *path)
{
    tyn_channel channels[6];
    tyn_image_file file = {.width = image->width, .height = image->height, .channels = channels};
    for (int i = 0; i < 6; i++) {
        const float *data = i < 3 ? image->rgb[i] : errors ? image->se[i - 3] : NULL;
        tyn_channel *channel = &channels[file.num_channels];
        if (data) {
            snprintf(channel->name, sizeof channel->name, "%s", names[i]);
            channel->data = (float *)(uintptr_t)data; // only read
            file.num_channels++;
        }
    }
    return app_exit_code(a, tyn_exr_write(&file, path, errors, &a->log), false);
}

// ---- rendering --------------------------------------------------------------------------------

static int allocate(app *a, const tyn_view *view, tyn_image_file *file)
{
    *file = (tyn_image_file){.width = view->width, .height = view->height};
    file->channels = calloc(6, sizeof *file->channels);
    for (int i = 0; file->channels && i < 6; i++) {
        tyn_channel *channel = &file->channels[file->num_channels];
        snprintf(channel->name, sizeof channel->name, "%s", names[i]);
        channel->data = malloc((size_t)view->width * view->height * sizeof(float));
        file->num_channels += channel->data != NULL;
    }
    return file->num_channels == 6 ? EXIT_DONE : app_exit_code(a, TYN_ERR_MEMORY, false);
}

static int render(app *a, tyn_device *device, const method *m, const bench_scene *spec,
                  const tyn_scene *scene, const tyn_view *asked, bench_reference *r)
{
    const size_t num = (size_t)asked->width * asked->height;
    tyn_view view = *asked;
    view.outputs = TYN_OUTPUT_RADIANCE | TYN_OUTPUT_ERROR;
    view.num_samples = spec->reference_spp;
    view.seed = BENCH_REFERENCE_SEED; // of its own: a run's samples must not be the reference's
    int code = allocate(a, &view, &r->file);
    float *planes = malloc(6 * num * sizeof *planes);
    if (code != EXIT_DONE || !planes) {
        free(planes);
        return app_exit_code(a, TYN_ERR_MEMORY, false);
    }
    renderer renders = {0};
    char label[128];
    snprintf(label, sizeof label, "%.80s: reference, %u samples", spec->name, view.num_samples);
    const double start = app_seconds();
    code = renderer_open(a, device, m, &renders);
    if (code == EXIT_DONE) {
        code = renderer_frame(a, &renders, scene, &view, false, label);
    }
    if (code == EXIT_DONE) {
        metrics_image image;
        bench_planes(renders.offline, &view, planes, &image);
        for (int i = 0; i < 6; i++) {
            memcpy(r->file.channels[i].data, planes + i * num, num * sizeof *planes);
        }
        r->seconds = app_seconds() - start;
        take_channels(r, &view);
    }
    renderer_close(&renders);
    free(planes);
    return code;
}

// What cannot be kept is rendered again by every call, which somebody who waits for it should know.
static void keep(app *a, const bench_reference *r, const char *cached)
{
    if (!cached) {
        app_warn(a, "the reference is not kept: XDG_CACHE_HOME or HOME must be an absolute path");
    } else if (tyn_exr_write(&r->file, cached, true, NULL) != TYN_OK) {
        app_warn(a, "%s: cannot be written; the reference is rendered again next time", cached);
    }
}

static int from_path(app *a, tyn_device *device, const bench_scene *spec, const tyn_scene *scene,
                     const tyn_view *view, bench_reference *r)
{
    method m = {0};
    int code = method_open(a, &(method_options){.method = tyn_method_reference()}, &m);
    if (code == EXIT_DONE) {
        snprintf(r->key, sizeof r->key, "%016llx",
                 (unsigned long long)reference_key(spec, scene, view, &m.info));
        char *cached = cached_path(r->key);
        r->cached = cached && tyn_exr_read(&r->file, cached, NULL) == TYN_OK &&
                    take_channels(r, view) && r->known_noise;
        if (!r->cached) {
            tyn_image_file_finish(&r->file);
            code = render(a, device, &m, spec, scene, view, r);
            if (code == EXIT_DONE) {
                keep(a, r, cached);
            }
        }
        free(cached);
    }
    method_finish(&m);
    return code;
}

// Is one value what it must be? `channel`: of `names`.
static bool is_sound(app *a, const bench_reference *r, const char *file, int channel, size_t i)
{
    const float *values = channel < 3 ? r->image.rgb[channel] : r->image.se[channel - 3];
    const uint32_t x = (uint32_t)(i % r->image.width), y = (uint32_t)(i / r->image.width);
    if (!values || (isfinite(values[i]) && (channel < 3 || values[i] >= 0))) {
        return true;
    }
    app_error(a, "%s: %s is %g at pixel (%u, %u); values of a reference must be finite%s", file,
              names[channel], (double)values[i], x, y,
              channel < 3 ? "" : ", and standard errors not negative");
    return false;
}

// A file may hold anything, and every error would be relative to it. Values below 0 are what filters leave.
static bool check_values(app *a, const bench_reference *r, const char *file)
{
    const size_t num = (size_t)r->image.width * r->image.height;
    double sum = 0;
    for (size_t i = 0; i < num; i++) {
        for (int c = 0; c < 6; c++) {
            if (!is_sound(a, r, file, c, i)) {
                return false;
            }
            sum += c < 3 ? r->image.rgb[c][i] : 0;
        }
    }
    if (!(sum > 0)) {
        app_error(a,
                  "%s: R, G and B sum to %g over all pixels; errors are relative to that: it must "
                  "be above 0",
                  file, sum);
    }
    return sum > 0;
}

static int from_file(app *a, const bench_scene *spec, const tyn_view *view, bench_reference *r)
{
    void *data = NULL;
    size_t size = 0;
    tyn_result result = tyn_file_read(spec->reference, UINT64_C(1) << 32, &data, &size, &a->log);
    if (result == TYN_OK) {
        snprintf(r->key, sizeof r->key, "%016llx", (unsigned long long)text_hash(data, size, 0));
        result = tyn_exr_read(&r->file, spec->reference, &a->log);
    }
    free(data);
    if (result == TYN_OK && !take_channels(r, view)) {
        app_error(a, "%s: must have the channels R, G, B and the size of '%s', %ux%u, not %ux%u",
                  spec->reference, spec->name, view->width, view->height, r->file.width,
                  r->file.height);
        return EXIT_WRONG;
    }
    if (result == TYN_OK && !check_values(a, r, spec->reference)) {
        return EXIT_WRONG;
    }
    r->cached = true;
    return app_exit_code(a, result, true);
}

// ---- what it is worth -------------------------------------------------------------------------

static void measure_noise(const uint32_t blocks[BENCH_BLOCKS], bench_reference *r)
{
    if (!r->known_noise) {
        return;
    }
    metrics_image exact = r->image; // against an exact copy: n is then the noise of one of the two
    exact.se[0] = exact.se[1] = exact.se[2] = NULL;
    for (int i = 0; i < BENCH_BLOCKS; i++) {
        metrics m = {0};
        metrics_compare(&exact, &r->image, blocks[i], &m);
        r->noise[i] = m.n;
    }
    double sum = 0, variance = 0;
    const size_t num = (size_t)r->image.width * r->image.height;
    for (int c = 0; c < 3; c++) {
        for (size_t i = 0; i < num; i++) {
            const double x = r->image.rgb[c][i], se = r->image.se[c][i];
            sum += isfinite(x) ? x : 0;
            variance += isfinite(se) ? se * se : 0;
        }
    }
    r->bias_se = sum != 0 ? sqrt(variance) / fabs(sum) : 0;
}

int bench_reference_get(app *a, tyn_device *device, const bench_scene *spec, const tyn_scene *scene,
                        const tyn_view *view, const uint32_t blocks[BENCH_BLOCKS],
                        bench_reference *r)
{
    *r = (bench_reference){0};
    const int code =
        spec->reference ? from_file(a, spec, view, r) : from_path(a, device, spec, scene, view, r);
    if (code == EXIT_DONE) {
        measure_noise(blocks, r);
    }
    return code;
}

void bench_reference_finish(bench_reference *r)
{
    tyn_image_file_finish(&r->file);
    *r = (bench_reference){0};
}
