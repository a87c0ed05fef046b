// cmd_merge.c -- `tyndall merge`: pictures of one thing by other samples, as one.
#include "app.h"
#include "layers.h"
#include "resume.h"
#include "tags.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct merge_args {
    opt_list pictures;
    const char *output;
    bool quiet, full_float;
} merge_args;

// One of the pictures.
typedef struct part {
    const char *path;
    tyn_image_file file;
    sample_range *ranges; // whose samples it has
    uint32_t num_ranges;
    double samples;
} part;

// ---- what may be merged -----------------------------------------------------------------------

static int part_open(app *a, const char *path, part *p)
{
    p->path = path;
    int code = app_exit_code(a, tyn_exr_read(&p->file, path, &a->log), true);
    if (code != EXIT_DONE) {
        return code;
    }
    p->ranges = tags_parts(&p->file, &p->num_ranges);
    for (uint32_t i = 0; i < p->num_ranges; i++) {
        p->samples += p->ranges[i].count;
    }
    if (!tyn_image_file_text(&p->file, TAG_SCENE) || !(p->samples > 0)) {
        app_error(a,
                  "%s: does not say which samples it has: must be an .exr that 'tyndall render' "
                  "has written of a method that samples",
                  path);
        return EXIT_WRONG;
    }
    return resume_check_sums(a, path, &p->file);
}

static bool same_text(const part *p, const part *q, const char *name)
{
    const char *a = tyn_image_file_text(&p->file, name), *b = tyn_image_file_text(&q->file, name);
    return a && b && strcmp(a, b) == 0;
}

static bool overlap(const sample_range *a, const sample_range *b)
{
    return a->seed == b->seed && (uint64_t)a->first < (uint64_t)b->first + b->count &&
           (uint64_t)b->first < (uint64_t)a->first + a->count;
}

// Do two pictures show the same thing, by different samples?
static int check_pair(app *a, const part *p, const part *q)
{
    if (!same_text(p, q, TAG_SCENE) || !same_text(p, q, TAG_METHOD) ||
        p->file.width != q->file.width || p->file.height != q->file.height) {
        app_error(a,
                  "%s and %s are different pictures: scene, camera, size, method and settings must "
                  "be the same",
                  p->path, q->path);
        return EXIT_WRONG;
    }
    for (uint32_t i = 0; i < p->num_ranges; i++) {
        for (uint32_t k = 0; k < q->num_ranges; k++) {
            if (overlap(&p->ranges[i], &q->ranges[k])) {
                app_error(a,
                          "%s and %s have the same samples, of seed %u: must be rendered with "
                          "another --seed or --sample-offset",
                          p->path, q->path, p->ranges[i].seed);
                return EXIT_WRONG;
            }
        }
    }
    return EXIT_DONE;
}

static bool is_kind(const char *channel, layer_kind kind)
{
    const picture_layer *layer = layer_of_channel(channel);
    return layer && layer->kind == kind;
}

static bool is_kept(const char *name)
{
    return is_kind(name, LAYER_KEPT);
}

// Sums may be missing in some: then they are left out.
static int check_channels(app *a, const part *p, const part *q)
{
    for (uint32_t i = 0; i < p->file.num_channels; i++) {
        const char *name = p->file.channels[i].name;
        if (!is_kept(name) && !tyn_image_file_channel(&q->file, name)) {
            app_error(a,
                      "%s: has no channel %s, which %s has: must be rendered with the same --aov",
                      q->path, name, p->path);
            return EXIT_WRONG;
        }
    }
    return EXIT_DONE;
}

static int check_all(app *a, const part *parts, uint32_t count)
{
    int code = EXIT_DONE;
    double samples = 0;
    for (uint32_t i = 0; code == EXIT_DONE && i < count; i++) {
        samples += parts[i].samples;
        for (uint32_t k = i + 1; code == EXIT_DONE && k < count; k++) {
            code = check_pair(a, &parts[i], &parts[k]);
        }
        if (code == EXIT_DONE && i > 0) {
            code = check_channels(a, &parts[0], &parts[i]);
            code = code == EXIT_DONE ? check_channels(a, &parts[i], &parts[0]) : code;
        }
    }
    if (code == EXIT_DONE && samples > INT32_MAX) {
        app_error(a, "%.0f samples of each pixel: must be 2147483647 at most", samples);
        code = EXIT_WRONG;
    }
    return code;
}

// ---- merging ----------------------------------------------------------------------------------

static float *plane_of(const part *p, tyn_output output, size_t channel)
{
    char name[48];
    layer_channel_name(layer_of_output(output), channel, name);
    return tyn_image_file_channel(&p->file, name);
}

static bool has_sums(const part *p)
{
    for (size_t c = 0; c < 4; c++) {
        if (!plane_of(p, TYN_OUTPUT_LOW, c) || !plane_of(p, TYN_OUTPUT_DEVIATION, c)) {
            return false;
        }
    }
    return true;
}

// What a part has of one colour. Without sums of all parts: no `low` and no `deviation`.
typedef struct colour_planes {
    float *mean, *error, *low, *deviation; // NULL: not there
    double samples;
} colour_planes;

// Mean radiance of the samples.
static double mean_of(const colour_planes *p, size_t i)
{
    return p->low ? (double)p->mean[i] - (double)p->low[i] : (double)p->mean[i];
}

// Sum of squared deviations of the samples; of one sample its error says nothing.
static double deviation_of(const colour_planes *p, size_t i)
{
    const double n = p->samples, error = p->error ? (double)p->error[i] : 0;
    return p->deviation ? (double)p->deviation[i] : n > 1 ? error * error * n * (n - 1) : 0;
}

// What the samples of all parts give together: Chan, Golub and LeVeque's merge of means and sums of squared deviations.
typedef struct merged {
    double mean, deviation, samples;
} merged;

static merged merge_pixel(const colour_planes *parts, uint32_t count, size_t i)
{
    merged m = {0};
    for (uint32_t k = 0; k < count; k++) {
        const double n = parts[k].samples, total = m.samples + n;
        const double delta = mean_of(&parts[k], i) - m.mean;
        m.mean += delta * n / total;
        m.deviation += deviation_of(&parts[k], i) + delta * delta * m.samples * n / total;
        m.samples = total;
    }
    return m;
}

// A colour, its error and sums, into the first part's planes. False: no memory.
static bool merge_colour(const part *parts, uint32_t count, size_t colour, bool sums)
{
    const size_t pixels = (size_t)parts[0].file.width * parts[0].file.height;
    colour_planes *planes = calloc(count, sizeof *planes);
    for (uint32_t k = 0; planes && k < count; k++) {
        planes[k] = (colour_planes){plane_of(&parts[k], TYN_OUTPUT_RADIANCE, colour),
                                    plane_of(&parts[k], TYN_OUTPUT_ERROR, colour),
                                    sums ? plane_of(&parts[k], TYN_OUTPUT_LOW, colour) : NULL,
                                    sums ? plane_of(&parts[k], TYN_OUTPUT_DEVIATION, colour) : NULL,
                                    parts[k].samples};
    }
    for (size_t i = 0; planes && planes->mean && i < pixels; i++) {
        const merged m = merge_pixel(planes, count, i);
        planes->mean[i] = (float)m.mean;
        if (planes->error && m.samples > 1) {
            planes->error[i] = (float)sqrt(m.deviation / (m.samples * (m.samples - 1)));
        }
        if (sums) {
            planes->low[i] = (float)((double)planes->mean[i] - m.mean);
            planes->deviation[i] = (float)m.deviation;
        }
    }
    free(planes);
    return planes != NULL;
}

// A mean without a spread.
static void merge_plane(const part *parts, uint32_t count, const char *name)
{
    const size_t pixels = (size_t)parts[0].file.width * parts[0].file.height;
    float *out = tyn_image_file_channel(&parts[0].file, name);
    double samples = parts[0].samples;
    for (uint32_t k = 1; k < count; k++) {
        const float *plane = tyn_image_file_channel(&parts[k].file, name);
        samples += parts[k].samples;
        for (size_t i = 0; i < pixels; i++) {
            out[i] += (float)(((double)plane[i] - (double)out[i]) * parts[k].samples / samples);
        }
    }
}

// Means over samples, which have no error of their own.
static bool is_mean(const char *name)
{
    return is_kind(name, LAYER_SUM) || strcmp(name, "A") == 0;
}

static void drop_sums(tyn_image_file *file)
{
    uint32_t left = 0;
    for (uint32_t i = 0; i < file->num_channels; i++) {
        if (is_kept(file->channels[i].name)) {
            free(file->channels[i].data);
        } else {
            file->channels[left++] = file->channels[i];
        }
    }
    file->num_channels = left;
}

// All into the first part's file. What no sample decides (depth, albedo, normal) is as in the first one. False: no memory.
static bool merge_all(part *parts, uint32_t count)
{
    tyn_image_file *file = &parts[0].file;
    bool sums = true;
    uint32_t num_ranges = 0;
    double samples = 0;
    for (uint32_t k = 0; k < count; k++) {
        sums = sums && has_sums(&parts[k]);
        num_ranges += parts[k].num_ranges;
    }
    for (size_t c = 0; c < 3; c++) {
        if (!merge_colour(parts, count, c, sums)) {
            return false;
        }
    }
    for (uint32_t i = 0; i < file->num_channels; i++) {
        if (is_mean(file->channels[i].name)) {
            merge_plane(parts, count, file->channels[i].name);
        }
    }
    if (sums) {
        const size_t pixels = (size_t)file->width * file->height;
        char mean_alpha[48];
        layer_channel_name(layer_of_output(TYN_OUTPUT_DEVIATION), 3, mean_alpha);
        merge_plane(parts, count, mean_alpha);
        memset(plane_of(&parts[0], TYN_OUTPUT_LOW, 3), 0, pixels * sizeof(float));
    } else {
        drop_sums(file);
    }
    for (uint32_t i = 0; i < file->num_channels; i++) {
        const char *name = file->channels[i].name;
        const bool sum = is_kind(name, LAYER_COLOR) || is_kind(name, LAYER_SUM);
        file->channels[i].exact = is_kept(name) || is_kind(name, LAYER_EXACT) || (sums && sum);
    }
    sample_range *all = calloc(num_ranges, sizeof *all);
    num_ranges = 0;
    for (uint32_t k = 0; all && k < count; k++) {
        samples += parts[k].samples;
        memcpy(all + num_ranges, parts[k].ranges, parts[k].num_ranges * sizeof *all);
        num_ranges += parts[k].num_ranges;
    }
    const bool done =
        all && tags_set_parts(file, all, num_ranges) &&
        tyn_image_file_set_numbers(file, TAG_SAMPLES, TYN_ATTRIBUTE_INTEGER, &samples);
    free(all);
    return done;
}

static int run_merge(app *a, const void *arguments)
{
    const merge_args *args = arguments;
    const uint32_t count = args->pictures.count;
    a->quiet = args->quiet;
    if (count < 2) {
        app_error(a, "two pictures at least are merged; see 'tyndall merge --help'");
        return EXIT_WRONG;
    }
    if (!args->output || !text_ends_with(args->output, ".exr")) {
        app_error(a, "-o: must be given, and end with .exr");
        return EXIT_WRONG;
    }
    part *parts = calloc(count, sizeof *parts);
    int code = parts ? EXIT_DONE : app_exit_code(a, TYN_ERR_MEMORY, false);
    for (uint32_t i = 0; code == EXIT_DONE && i < count; i++) {
        code = part_open(a, args->pictures.items[i], &parts[i]);
    }
    if (code == EXIT_DONE) {
        code = check_all(a, parts, count);
    }
    if (code == EXIT_DONE) {
        code = app_exit_code(a, merge_all(parts, count) ? TYN_OK : TYN_ERR_MEMORY, false);
    }
    if (code == EXIT_DONE) {
        code = app_exit_code(
            a, tyn_exr_write(&parts[0].file, args->output, args->full_float, &a->log), false);
    }
    for (uint32_t i = 0; parts && i < count; i++) {
        tyn_image_file_finish(&parts[i].file);
        free(parts[i].ranges);
    }
    free(parts);
    return code;
}

#define AT(field) offsetof(merge_args, field)
static const opt_positional positionals[] = {
    {"PICTURE...", "two .exr or more of the same scene, by 'tyndall render' with other seeds", true,
     AT(pictures), true},
};

static const option table[] = {
    {'o', "output", OPT_TEXT, AT(output), "OUT.exr", "where the picture of all samples goes",
     .file = OPT_WRITES},
    {0, "float", OPT_FLAG, AT(full_float), NULL, "32-bit .exr instead of 16-bit"},
    {'q', "quiet", OPT_FLAG, AT(quiet), NULL, "errors only"},
};

static const opt_group groups[] = {{"options", table, ARRAY_SIZE(table), 0}};

const command cmd_merge = {
    .name = "merge",
    .summary = "Merge pictures of one scene with other samples into one, weighted by samples.",
    .details = "Pictures must have been rendered by a method that samples, with the same settings "
               "and with "
               "other seeds or sample\noffsets; the same samples twice are refused. Errors are "
               "those of all "
               "samples. Depth, albedo and normal are the first\npicture's. Pictures rendered with "
               "--resume "
               "carry sums, by which nothing is rounded on the way.",
    .positionals = positionals,
    .num_positionals = ARRAY_SIZE(positionals),
    .groups = groups,
    .num_groups = ARRAY_SIZE(groups),
    .args_size = sizeof(merge_args),
    .run = run_merge,
};
