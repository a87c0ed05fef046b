// reference.c -- converged pictures by `path`, kept in a cache by what they depend on.
#include "bench.h"
#include "cache.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { REFERENCE_SEED = 1000003 }; // of its own: a baseline's samples must not be the reference's

static uint64_t hash_text(const char *text, uint64_t seed)
{
    return text ? text_hash(text, strlen(text), seed) : seed;
}

static uint64_t hash_file(const char *path, uint64_t seed)
{
    void *data = NULL;
    size_t size = 0;
    if (path && tyn_file_read(path, UINT64_C(1) << 32, &data, &size, NULL) == TYN_OK) {
        seed = text_hash(data, size, seed);
    }
    free(data);
    return seed;
}

// The scene's files, the suite's entry, the picture's size, and the code that renders it.
static uint64_t reference_key(const bench_case *c, const tyn_method_info *path)
{
    uint64_t key = hash_file(c->spec->path, 1);
    key = hash_file(c->spec->scene.env, key);
    for (uint32_t i = 0; i < c->scene.num_volumes; i++) {
        key = text_hash(&c->scene.volumes[i].hash, sizeof c->scene.volumes[i].hash, key);
    }
    key = text_hash(&c->scene.environment.hash, sizeof c->scene.environment.hash, key);
    char *entry = cJSON_PrintUnformatted(c->spec->json);
    key = hash_text(entry, key);
    free(entry);
    const uint32_t numbers[] = {c->view.width, c->view.height, c->spec->reference_spp};
    key = text_hash(numbers, sizeof numbers, key);
    for (const tyn_pass_desc *const *pass = path->passes; *pass; pass++) {
        for (uint32_t k = 0; k < (*pass)->num_kernels; k++) {
            const tyn_kernel *kernel = &(*pass)->kernels[k];
            key = text_hash(kernel->spirv, kernel->spirv_size, key);
        }
    }
    return key;
}

static char *cached_path(uint64_t key)
{
    char name[48];
    snprintf(name, sizeof name, "references/%016llx.exr", (unsigned long long)key);
    return cache_path(name);
}

static const char *const names[6] = {"R", "G", "B", "error.R", "error.G", "error.B"};

static bool take_channels(const bench_case *c, bench_reference *r)
{
    r->image = (metrics_image){.width = r->file.width, .height = r->file.height};
    bool whole = r->file.width == c->view.width && r->file.height == c->view.height;
    for (int i = 0; i < 3; i++) {
        r->image.rgb[i] = tyn_image_file_channel(&r->file, names[i]);
        r->image.se[i] = tyn_image_file_channel(&r->file, names[3 + i]);
        whole = whole && r->image.rgb[i] && r->image.se[i];
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

static int render_reference(bench_case *c, const method *m, bench_reference *r)
{
    const size_t num = (size_t)c->view.width * c->view.height;
    tyn_view view = c->view;
    view.outputs = TYN_OUTPUT_RADIANCE | TYN_OUTPUT_ERROR;
    view.num_samples = c->spec->reference_spp;
    view.seed = REFERENCE_SEED;
    r->file = (tyn_image_file){.width = view.width, .height = view.height};
    r->file.channels = calloc(6, sizeof *r->file.channels);
    for (int i = 0; r->file.channels && i < 6; i++) {
        tyn_channel *channel = &r->file.channels[r->file.num_channels];
        snprintf(channel->name, sizeof channel->name, "%s", names[i]);
        channel->data = malloc(num * sizeof(float));
        r->file.num_channels += channel->data != NULL;
    }
    float *planes = malloc(6 * num * sizeof *planes);
    if (r->file.num_channels < 6 || !planes) {
        free(planes);
        return app_exit_code(c->a, TYN_ERR_MEMORY, false);
    }
    renderer render = {0};
    char label[128];
    snprintf(label, sizeof label, "%.80s: reference, %u samples", c->spec->name, view.num_samples);
    double start = app_seconds();
    int code = renderer_open(c->a, c->device, m, &render);
    if (code == EXIT_DONE) {
        code = renderer_frame(c->a, &render, &c->scene, &view, false, label);
    }
    if (code == EXIT_DONE) {
        metrics_image image;
        bench_planes(render.offline, &view, planes, &image);
        for (int i = 0; i < 6; i++) {
            memcpy(r->file.channels[i].data, planes + i * num, num * sizeof *planes);
        }
        r->seconds = app_seconds() - start;
        take_channels(c, r);
    }
    renderer_close(&render);
    free(planes);
    return code;
}

static void measure_noise(const bench_case *c, bench_reference *r)
{
    for (int i = 0; i < BENCH_BLOCKS; i++) {
        metrics m = {0};
        // of itself against an exact copy: n is then the noise of one of the two
        metrics_image exact = r->image;
        exact.se[0] = exact.se[1] = exact.se[2] = NULL;
        metrics_compare(&exact, &r->image, c->blocks[i], &m);
        r->noise[i] = m.n;
    }
}

int bench_reference_get(bench_case *c)
{
    bench_reference *r = &c->reference;
    *r = (bench_reference){0};
    method m = {0};
    int code = method_open(c->a, &(method_options){.method = "path"}, &m);
    if (code == EXIT_DONE) {
        char *cached = cached_path(reference_key(c, &m.info));
        bool found =
            cached && tyn_exr_read(&r->file, cached, NULL) == TYN_OK && take_channels(c, r);
        if (!found) {
            tyn_image_file_finish(&r->file);
            code = render_reference(c, &m, r);
            if (code == EXIT_DONE && cached) {
                tyn_exr_write(&r->file, cached, true, NULL);
            }
        }
        free(cached);
    }
    if (code == EXIT_DONE) {
        measure_noise(c, r);
    }
    method_finish(&m);
    return code;
}

void bench_reference_finish(bench_reference *r)
{
    tyn_image_file_finish(&r->file);
    *r = (bench_reference){0};
}
