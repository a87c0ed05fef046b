// resume.c -- a picture that a method samples, taken up again from its .exr.
#include "resume.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// Images of tyn_resume, RGBA, and where their components are in the file; "": 0.
typedef struct image_source {
    size_t at; // of the pointer in tyn_resume
    const char *layer;
    bool alpha;
    uint32_t output; // the layer is needed with it; 0: always
} image_source;

static const image_source images[] = {
    {offsetof(tyn_resume, radiance), "", false, 0},
    {offsetof(tyn_resume, low), RESUME_LOW, true, 0},
    {offsetof(tyn_resume, deviation), RESUME_DEVIATION, true, 0},
    {offsetof(tyn_resume, single), "single", false, TYN_OUTPUT_SINGLE},
    {offsetof(tyn_resume, multiple), "multiple", false, TYN_OUTPUT_MULTIPLE},
    {offsetof(tyn_resume, transmittance), "transmittance", false, TYN_OUTPUT_TRANSMITTANCE},
};

static int wrong(app *a, const char *path, const char *why)
{
    app_error(a, "--resume: %s: %s", path, why);
    return EXIT_WRONG;
}

// One image, from the file's planes.
static int take(app *a, const char *path, const tyn_image_file *file, const image_source *from,
                float *rgba)
{
    const size_t pixels = (size_t)file->width * file->height;
    for (int c = 0; c < (from->alpha ? 4 : 3); c++) {
        char name[48];
        snprintf(name, sizeof name, "%s%s%c", from->layer, from->layer[0] ? "." : "", "RGBA"[c]);
        const float *plane = tyn_image_file_channel(file, name);
        if (!plane) {
            app_error(a,
                      "--resume: %s: has no channel %s, of what its samples have left; 'render' "
                      "keeps that with --resume, or when it is interrupted",
                      path, name);
            return EXIT_WRONG;
        }
        for (size_t i = 0; i < pixels; i++) {
            rgba[4 * i + (size_t)c] = plane[i];
        }
    }
    return EXIT_DONE;
}

int resume_check_sums(app *a, const char *path, const tyn_image_file *file)
{
    static const struct {
        const char *layer;
        bool spread; // may not be negative
    } layers[] = {
        {"", false}, {RESUME_LOW ".", false}, {RESUME_DEVIATION ".", true}, {"error.", true}};
    const size_t pixels = (size_t)file->width * file->height;
    for (size_t k = 0; k < 4 * ARRAY_SIZE(layers); k++) {
        char name[48];
        snprintf(name, sizeof name, "%s%c", layers[k / 4].layer, "RGBA"[k % 4]);
        const float *plane = tyn_image_file_channel(file, name);
        for (size_t i = 0; plane && i < pixels; i++) {
            if (!isfinite(plane[i]) || (layers[k / 4].spread && plane[i] < 0)) {
                app_error(a, "%s: channel %s is %g at pixel %zu, %zu: must be finite%s", path, name,
                          (double)plane[i], i % file->width, i / file->width,
                          layers[k / 4].spread ? " and not negative" : "");
                return EXIT_WRONG;
            }
        }
    }
    return EXIT_DONE;
}

// Is the file of the picture that is wanted?
static int check(app *a, const char *path, const tyn_image_file *file, const picture_tags *tags,
                 uint32_t *samples)
{
    char hash[17];
    const char *by = tyn_image_file_text(file, TAG_METHOD);
    const char *scene = tyn_image_file_text(file, TAG_SCENE);
    uint32_t count;
    sample_range *parts = tags_parts(file, &count);
    const sample_range part = parts && count == 1 ? parts[0] : (sample_range){0};
    free(parts);
    tags_hash(tags, hash);
    if (!by || !scene || count == 0) {
        return wrong(a, path,
                     "does not say which samples it has: it is not of a method that "
                     "samples, or another program's");
    }
    if (count > 1) {
        return wrong(a, path, "is merged of several pictures, which cannot be gone on with");
    }
    if (strcmp(by, tags->method->info.name) != 0 || strcmp(scene, hash) != 0 ||
        file->width != tags->view->width || file->height != tags->view->height) {
        return wrong(a, path,
                     "is another picture: scene, camera, size, method and settings must be those "
                     "it was begun with (or give another -o)");
    }
    if (part.seed != tags->view->seed || part.first != tags->view->sample_offset) {
        app_error(a, "--resume: %s: was begun with --seed %u --sample-offset %u", path, part.seed,
                  part.first);
        return EXIT_WRONG;
    }
    *samples = part.count;
    return EXIT_DONE;
}

static int take_images(app *a, const char *path, const tyn_image_file *file, uint32_t outputs,
                       resumed *r)
{
    const size_t floats = 4 * (size_t)file->width * file->height;
    r->planes = calloc(ARRAY_SIZE(images) * floats, sizeof *r->planes);
    if (!r->planes) {
        return app_exit_code(a, TYN_ERR_MEMORY, false);
    }
    for (size_t i = 0; i < ARRAY_SIZE(images); i++) {
        float *rgba = r->planes + i * floats;
        if (images[i].output && !(outputs & images[i].output)) {
            continue;
        }
        int code = take(a, path, file, &images[i], rgba);
        if (code != EXIT_DONE) {
            return code;
        }
        memcpy((char *)&r->resume + images[i].at, &rgba, sizeof rgba);
    }
    r->resume.hash = text_hash(r->planes, ARRAY_SIZE(images) * floats * sizeof *r->planes, 1) | 1;
    return EXIT_DONE;
}

int resumed_read(app *a, const char *path, const picture_tags *tags, resumed *r)
{
    tyn_image_file file = {0};
    uint32_t samples = 0;
    *r = (resumed){0};
    if (access(path, F_OK) != 0) {
        return EXIT_DONE;
    }
    int code = app_exit_code(a, tyn_exr_read(&file, path, &a->log), true);
    if (code == EXIT_DONE) {
        code = check(a, path, &file, tags, &samples);
    }
    if (code == EXIT_DONE) {
        code = resume_check_sums(a, path, &file);
    }
    if (code == EXIT_DONE) {
        code = take_images(a, path, &file, tags->view->outputs, r);
    }
    if (code == EXIT_DONE) {
        r->resume.num_samples = samples;
    }
    tyn_image_file_finish(&file);
    return code;
}

void resumed_finish(resumed *r)
{
    free(r->planes);
    *r = (resumed){0};
}
