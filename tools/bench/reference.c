// reference.c -- where a reference comes from: a file of the user's, the suite's stored ones, the cache, `path`.
#include "reference.h"
#include "cache.h"
#include "converge.h"
#include "flip.h"
#include "json.h"
#include "stats.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const bench_reference_channels[6] = {"R", "G", "B", "error.R", "error.G", "error.B"};

// ---- pictures ---------------------------------------------------------------------------------

// False: not of that size, or a channel is missing; errors may be.
static bool take_channels(bench_reference *r, const tyn_view *view)
{
    r->image = (metrics_image){.width = r->file.width, .height = r->file.height};
    r->known_noise = true;
    bool whole = r->file.width == view->width && r->file.height == view->height;
    for (int i = 0; i < 3; i++) {
        r->image.rgb[i] = tyn_image_file_channel(&r->file, bench_reference_channels[i]);
        r->image.se[i] = tyn_image_file_channel(&r->file, bench_reference_channels[3 + i]);
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
        if (data) {
            tyn_channel *channel = &channels[file.num_channels++];
            *channel = (tyn_channel){.data = (float *)(uintptr_t)data}; // only read
            snprintf(channel->name, sizeof channel->name, "%s", bench_reference_channels[i]);
        }
    }
    return app_exit_code(a, tyn_exr_write(&file, path, errors, &a->log), false);
}

// ---- what it is worth -------------------------------------------------------------------------

void bench_reference_measure(bench_reference *r)
{
    if (!r->known_noise) {
        return;
    }
    metrics_image exact = r->image; // against an exact copy: n is then the noise of one of the two
    exact.se[0] = exact.se[1] = exact.se[2] = NULL;
    for (int i = 0; i < BENCH_BLOCKS; i++) {
        metrics m = {0};
        metrics_compare(&exact, &r->image, r->blocks[i], &m);
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

// A number with the distribution N(0, 1), the same ones in every call: by Box and Muller, of splitmix64's bits.
static double normal(uint64_t *state)
{
    double u[2];
    for (int i = 0; i < 2; i++) {
        uint64_t z = *state += UINT64_C(0x9E3779B97F4A7C15);
        z = (z ^ (z >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
        z = (z ^ (z >> 27)) * UINT64_C(0x94D049BB133111EB);
        u[i] = ((double)((z ^ (z >> 31)) >> 11) + 0.5) * 0x1p-53;
    }
    return sqrt(-2 * log(u[0])) * cos(2 * 3.14159265358979323846 * u[1]);
}

// What FLIP says of noise alone: the reference against itself with noise of its standard errors added.
static bool measure_flip(bench_reference *r)
{
    const size_t num = (size_t)r->image.width * r->image.height;
    float *noisy = malloc(3 * num * sizeof *noisy), scale;
    metrics_image image = {.width = r->image.width, .height = r->image.height};
    uint64_t state = 0;
    for (int c = 0; noisy && c < 3; c++) {
        image.rgb[c] = noisy + c * num;
        for (size_t i = 0; i < num; i++) {
            noisy[c * num + i] = r->image.rgb[c][i] + (float)(r->image.se[c][i] * normal(&state));
        }
    }
    const bool done = noisy && flip_scale(&r->image, &scale) &&
                      flip_ldr(&image, &r->image, scale, NULL, &r->flip_noise);
    free(noisy);
    return done;
}

// ---- files that hold what `path` gave ---------------------------------------------------------

// What such a file says of itself, as JSON in the attribute "comments".
static char *comments_of(const bench_reference *r, uint64_t scene)
{
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "schema", "tyndall-reference");
    cJSON_AddNumberToObject(json, "version", 1);
    json_add_hash(json, "scene", scene);
    cJSON_AddStringToObject(json, "method", tyn_method_reference());
    cJSON_AddNumberToObject(json, "spp", r->spp);
    json_add_float(json, "seconds", r->seconds);
    char *text = cJSON_PrintUnformatted(json);
    cJSON_Delete(json);
    return text;
}

static void content_key(bench_reference *r)
{
    const size_t bytes = (size_t)r->file.width * r->file.height * sizeof(float);
    uint64_t key = r->spp;
    for (int i = 0; i < 6; i++) {
        key = text_hash(tyn_image_file_channel(&r->file, bench_reference_channels[i]), bytes, key);
    }
    snprintf(r->key, sizeof r->key, "%016llx", (unsigned long long)key);
}

// Gives the hash of a file's bytes, or "".
static void hash_file(const char *path, char key[17])
{
    void *data = NULL;
    size_t size = 0;
    key[0] = '\0';
    if (tyn_file_read(path, UINT64_C(1) << 32, &data, &size, NULL) == TYN_OK) {
        snprintf(key, 17, "%016llx", (unsigned long long)text_hash(data, size, 0));
    }
    free(data);
}

typedef enum found { FOUND_NOT, FOUND_OTHER, FOUND } found;

// Reads such a file, if it is of this scene.
static found read_own(const char *path, const tyn_view *view, uint64_t scene, bench_reference *r)
{
    char hash[17];
    snprintf(hash, sizeof hash, "%016llx", (unsigned long long)scene);
    if (!path || tyn_exr_read(&r->file, path, NULL) != TYN_OK) {
        return FOUND_NOT;
    }
    cJSON *json = cJSON_Parse(tyn_image_file_text(&r->file, "comments"));
    const double spp = json_figure(json, "spp"), seconds = json_figure(json, "seconds");
    const bool ours = take_channels(r, view) && r->known_noise && spp >= 2 && seconds >= 0 &&
                      strcmp(json_text(json, "scene"), hash) == 0;
    cJSON_Delete(json);
    if (!ours) {
        tyn_image_file_finish(&r->file);
        return FOUND_OTHER;
    }
    r->spp = (uint32_t)spp;
    r->seconds = seconds;
    r->cached = true;
    bench_reference_measure(r);
    return FOUND;
}

// Where a reference is kept, and of what.
typedef struct keeper {
    app *a;
    uint64_t scene;
    char *cached, *stored; // NULL: not there
} keeper;

static int write_own(const keeper *k, const bench_reference *r, const char *path, bool whole)
{
    tyn_image_file file = {.width = r->file.width,
                           .height = r->file.height,
                           .num_channels = r->file.num_channels,
                           .channels = r->file.channels};
    char *comments = comments_of(r, k->scene);
    tyn_result result =
        tyn_image_file_set_text(&file, "comments", comments) ? TYN_OK : TYN_ERR_MEMORY;
    result = result ? result : tyn_exr_write(&file, path, whole, whole ? NULL : &k->a->log);
    file.channels = NULL; // are the reference's
    file.num_channels = 0;
    tyn_image_file_finish(&file);
    free(comments);
    return app_exit_code(k->a, result, false);
}

// What the cache does not take is rendered again by every call, which somebody who waits for it should know.
static int keep(void *user, const bench_reference *r)
{
    const keeper *k = user;
    if (!k->cached) {
        app_warn(k->a,
                 "the reference is not kept: XDG_CACHE_HOME or HOME must be an absolute path");
    } else if (write_own(k, r, k->cached, true) != EXIT_DONE) {
        app_warn(k->a, "%s: cannot be written; the reference is rendered again next time",
                 k->cached);
    }
    return k->stored ? write_own(k, r, k->stored, false) : EXIT_DONE;
}

// In the cache: by the scene and the code that renders it.
static char *cached_path(uint64_t scene, const tyn_method_info *path)
{
    char name[48];
    uint64_t key = scene;
    for (const tyn_pass_desc *const *pass = path->passes; *pass; pass++) {
        for (uint32_t k = 0; k < (*pass)->num_kernels; k++) {
            const tyn_kernel *kernel = &(*pass)->kernels[k];
            key = text_hash(kernel->spirv, kernel->spirv_size, key);
        }
    }
    snprintf(name, sizeof name, "references/%016llx.exr", (unsigned long long)key);
    return cache_path(name);
}

// The better of what is stored and what is in the cache; a stored one of another scene is of no use, and is named.
static void look(const keeper *k, const char *stored, const tyn_view *view, bench_reference *r)
{
    bench_reference other = {.blocks = {r->blocks[0], r->blocks[1]}};
    const found there = read_own(stored, view, k->scene, r);
    if (there == FOUND_OTHER) {
        app_warn(k->a, "%s: is of another scene, view or size: rendered anew", stored);
    }
    if (read_own(k->cached, view, k->scene, &other) == FOUND && other.spp > r->spp) {
        tyn_image_file_finish(&r->file);
        *r = other;
    } else {
        tyn_image_file_finish(&other.file);
    }
}

static int from_path(app *a, const bench_machine *on, const bench_suite *suite,
                     const bench_scene *spec, const tyn_scene *scene, const tyn_view *view,
                     bool make, bench_reference *r)
{
    method m = {0};
    char *stored = suite->references ? text_format("%s/%s-%ux%u.exr", suite->references, spec->slug,
                                                   view->width, view->height)
                                     : NULL;
    int code = method_open(a, &(method_options){.method = tyn_method_reference()}, &m);
    if (code == EXIT_DONE) {
        keeper k = {.a = a, .scene = bench_scene_hash(scene, view), .stored = make ? stored : NULL};
        if (!make && read_own(stored, view, k.scene, r) == FOUND) {
            r->stored = true;
            hash_file(stored, r->file_key);
        } else {
            k.cached = cached_path(k.scene, &m.info);
            look(&k, stored, view, r);
            const double before = r->seconds;
            if (!converge_is_done(r, &spec->goal)) {
                code = converge(a, on, &m, scene, view, &spec->goal, spec->name, keep, &k, r);
            } else if (make) {
                code = keep(&k, r);
            }
            r->spent = r->seconds - before;
            free(k.cached);
        }
        if (code == EXIT_DONE) {
            take_channels(r, view);
            content_key(r);
        }
    }
    free(stored);
    method_finish(&m);
    return code;
}

// ---- a file -----------------------------------------------------------------------------------

// Is one value what it must be? `channel`: of `names`.
static bool is_sound(app *a, const bench_reference *r, const char *file, int channel, size_t i)
{
    const float *values = channel < 3 ? r->image.rgb[channel] : r->image.se[channel - 3];
    const uint32_t x = (uint32_t)(i % r->image.width), y = (uint32_t)(i / r->image.width);
    if (!values || (isfinite(values[i]) && (channel < 3 || values[i] >= 0))) {
        return true;
    }
    app_error(a, "%s: %s is %g at pixel (%u, %u); values of a reference must be finite%s", file,
              bench_reference_channels[channel], (double)values[i], x, y,
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
    const tyn_result result = tyn_exr_read(&r->file, spec->reference, &a->log);
    hash_file(spec->reference, r->file_key);
    snprintf(r->key, sizeof r->key, "%s", r->file_key);
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

int bench_reference_get(app *a, const bench_machine *on, const bench_suite *suite,
                        const bench_scene *spec, const tyn_scene *scene, const tyn_view *view,
                        bool make, bench_reference *r)
{
    *r = (bench_reference){.blocks = {suite->block, 1}};
    const int code = spec->reference ? from_file(a, spec, view, r)
                                     : from_path(a, on, suite, spec, scene, view, make, r);
    if (code == EXIT_DONE) {
        bench_reference_measure(r);
    }
    const bool flip = code != EXIT_DONE || !r->known_noise || measure_flip(r);
    return flip ? code : app_exit_code(a, TYN_ERR_MEMORY, false);
}

void bench_reference_finish(bench_reference *r)
{
    tyn_image_file_finish(&r->file);
    *r = (bench_reference){0};
}
