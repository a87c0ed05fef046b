// resume.c -- a picture that a method samples, taken up again from its .exr.
#include "resume.h"
#include "layers.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// Images of tyn_resume, and the outputs whose layers they are in.
typedef struct image_source {
    size_t at; // of the pointer in tyn_resume
    tyn_output output;
    int channels;
    bool always; // else with its output
} image_source;

static const image_source images[] = {
    {offsetof(tyn_resume, radiance), TYN_OUTPUT_RADIANCE, 3, true},
    {offsetof(tyn_resume, low), TYN_OUTPUT_LOW, 4, true},
    {offsetof(tyn_resume, deviation), TYN_OUTPUT_DEVIATION, 4, true},
    {offsetof(tyn_resume, single), TYN_OUTPUT_SINGLE, 3, false},
    {offsetof(tyn_resume, multiple), TYN_OUTPUT_MULTIPLE, 3, false},
    {offsetof(tyn_resume, transmittance), TYN_OUTPUT_TRANSMITTANCE, 3, false},
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
    for (int c = 0; c < from->channels; c++) {
        char name[48];
        layer_channel_name(layer_of_output(from->output), (size_t)c, name);
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
    // True: may not be negative.
    static const struct {
        tyn_output output;
        bool spread;
    } checked[] = {{TYN_OUTPUT_RADIANCE, false},
                   {TYN_OUTPUT_LOW, false},
                   {TYN_OUTPUT_DEVIATION, true},
                   {TYN_OUTPUT_ERROR, true}};
    const size_t pixels = (size_t)file->width * file->height;
    for (size_t k = 0; k < file->num_channels; k++) {
        const tyn_channel *channel = &file->channels[k];
        const picture_layer *layer = layer_of_channel(channel->name);
        for (size_t l = 0; layer && l < ARRAY_SIZE(checked); l++) {
            const bool spread = checked[l].spread;
            for (size_t i = 0; layer->output == checked[l].output && i < pixels; i++) {
                const float x = channel->data[i];
                if (!isfinite(x) || (spread && x < 0)) {
                    app_error(a, "%s: channel %s is %g at pixel %zu, %zu: must be finite%s", path,
                              channel->name, (double)x, i % file->width, i / file->width,
                              spread ? " and not negative" : "");
                    return EXIT_WRONG;
                }
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
        if (!images[i].always && !(outputs & images[i].output)) {
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
