// cmd_compare.c -- `tyndall compare`: error of one image against another.
#include "app.h"
#include "metrics.h"
#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <tyndall/io.h>

typedef struct compare_args {
    const char *image, *reference;
    uint32_t block;
    const char *heat;
    bool json, quiet;
} compare_args;

// The channels by their names; `image` borrows from `file`. A grey image has one channel Y.
static bool find_channels(app *a, const tyn_image_file *file, const char *path,
                          metrics_image *image)
{
    static const char *const names[3] = {"R", "G", "B"};
    static const char *const errors[3] = {"error.R", "error.G", "error.B"};
    *image = (metrics_image){.width = file->width, .height = file->height};
    for (int c = 0; c < 3; c++) {
        image->rgb[c] = tyn_image_file_channel(file, names[c]);
        if (!image->rgb[c]) {
            image->rgb[c] = tyn_image_file_channel(file, "Y");
        }
        if (!image->rgb[c]) {
            app_error(a, "%s: has no channel '%s'; an image needs R, G and B, or Y", path,
                      names[c]);
            return false;
        }
        image->se[c] = tyn_image_file_channel(file, errors[c]);
    }
    return true;
}

// Black, violet, red, orange, yellow, white from 0.1 % to 100 % difference, logarithmic; not a number
// is green.
static void heat_color(float difference, uint8_t rgb[3])
{
    static const uint8_t ramp[6][3] = {{0, 0, 0},      {74, 18, 110},  {170, 36, 80},
                                       {240, 110, 30}, {250, 210, 60}, {255, 255, 255}};
    if (isnan(difference)) {
        rgb[0] = rgb[2] = 0;
        rgb[1] = 255;
        return;
    }
    double t = 5 * (log10(fmax(difference, 1e-3)) + 3) / 3;
    int i = t < 5 ? (int)t : 4;
    double f = fmin(t - i, 1);
    for (int c = 0; c < 3; c++) {
        rgb[c] = (uint8_t)lround(ramp[i][c] + f * (ramp[i + 1][c] - ramp[i][c]));
    }
}

static int write_heat(app *a, const compare_args *args, const metrics_image *image,
                      const metrics_image *reference)
{
    size_t num = (size_t)image->width * image->height;
    float *heat = malloc(num * sizeof *heat);
    uint8_t *pixels = malloc(3 * num);
    int code = EXIT_FAILED;
    if (heat && pixels && metrics_heat(image, reference, args->block, heat) == METRICS_OK) {
        for (size_t i = 0; i < num; i++) {
            heat_color(heat[i], &pixels[3 * i]);
        }
        code = app_exit_code(
            a, tyn_png_write(args->heat, image->width, image->height, 3, pixels, &a->log), false);
    } else {
        app_error(a, "out of memory");
    }
    free(heat);
    free(pixels);
    return code;
}

// Every value that is printed, in order: text and JSON.
static void print_metrics(const metrics *m, bool json)
{
    const struct {
        const char *name;
        double value;
        bool known;
    } rows[] = {
        {"rel_l1", m->rel_l1, true},     {"rmse", m->rmse, true},
        {"rel_rmse", m->rel_rmse, true}, {"rel_mse", m->rel_mse, true},
        {"smape", m->smape, true},       {"bias", m->bias, true},
        {"n", m->n, m->has_n},           {"error", m->error, m->has_n},
        {"p95", m->p95, true},           {"nan", (double)m->nan, true},
    };
    cJSON *object = json ? cJSON_CreateObject() : NULL;
    for (size_t i = 0; i < ARRAY_SIZE(rows); i++) {
        if (!rows[i].known) {
            continue;
        }
        if (json) {
            cJSON_AddNumberToObject(object, rows[i].name, rows[i].value);
        } else {
            printf("%s %.9g\n", rows[i].name, rows[i].value);
        }
    }
    if (json) {
        char *text = cJSON_Print(object);
        printf("%s\n", text ? text : "{}");
        free(text);
        cJSON_Delete(object);
    }
}

static int compare_files(app *a, const compare_args *args, const tyn_image_file *file,
                         const tyn_image_file *reference_file)
{
    metrics_image image, reference;
    if (!find_channels(a, file, args->image, &image) ||
        !find_channels(a, reference_file, args->reference, &reference)) {
        return EXIT_WRONG;
    }
    if (image.width != reference.width || image.height != reference.height) {
        app_error(a, "%s is %ux%u and %s is %ux%u; both need the same size", args->image,
                  image.width, image.height, args->reference, reference.width, reference.height);
        return EXIT_WRONG;
    }
    metrics m;
    metrics_status status = metrics_compare(&image, &reference, args->block, &m);
    if (status == METRICS_ZERO_REFERENCE) {
        app_error(a, "%s: R, G and B sum to 0; nothing can be relative to it", args->reference);
        return EXIT_WRONG;
    }
    if (status == METRICS_MEMORY) {
        app_error(a, "out of memory");
        return EXIT_FAILED;
    }
    if (args->heat) {
        int code = write_heat(a, args, &image, &reference);
        if (code != EXIT_DONE) {
            return code;
        }
    }
    print_metrics(&m, args->json);
    return m.nan ? EXIT_FAILED : EXIT_DONE;
}

static int run_compare(app *a, const void *arguments)
{
    const compare_args *args = arguments;
    a->quiet = args->quiet;
    if (args->heat && !text_ends_with(args->heat, ".png")) {
        app_error(a, "--heat: '%s' is not a .png file name", args->heat);
        return EXIT_WRONG;
    }
    tyn_image_file image = {0}, reference = {0};
    int code = app_exit_code(a, tyn_exr_read(&image, args->image, &a->log), true);
    if (code == EXIT_DONE) {
        code = app_exit_code(a, tyn_exr_read(&reference, args->reference, &a->log), true);
    }
    if (code == EXIT_DONE) {
        code = compare_files(a, args, &image, &reference);
    }
    tyn_image_file_finish(&image);
    tyn_image_file_finish(&reference);
    return code;
}

#define AT(field) offsetof(compare_args, field)
static const opt_positional positionals[] = {
    {"A.exr", "the image", true, AT(image)},
    {"REF.exr", "the reference, of the same size", true, AT(reference)},
};
static const option options[] = {
    {0, "block", OPT_UINT, AT(block), "N", "average NxN pixels first (noisy references)", 1, 1, 0},
    {0, "heat", OPT_TEXT, AT(heat), "FILE.png",
     "picture of |x - r| / (|r| + 0.01 m), 0.1 % to 100 %"},
    {0, "json", OPT_FLAG, AT(json), NULL, "print JSON"},
    {'q', "quiet", OPT_FLAG, AT(quiet), NULL, "errors only"},
};
static const opt_group groups[] = {{"options", options, ARRAY_SIZE(options), 0}};

const command cmd_compare = {
    .name = "compare",
    .summary = "Error of image A against the reference REF, over R, G and B together.",
    .details = "Prints one `name value` a line; x = image, r = reference, m = mean of r:\n"
               "\n"
               "    rel_l1    sum |x-r| / sum |r|\n"
               "    rmse      sqrt(mean (x-r)^2)\n"
               "    rel_rmse  sqrt(sum (x-r)^2 / sum r^2)\n"
               "    rel_mse   mean((x-r)^2 / (r^2 + 0.01 m^2))\n"
               "    smape     mean(2 |x-r| / (|x| + |r|)), 0/0 = 0\n"
               "    bias      sum x / sum r - 1\n"
               "    n         sqrt(2/pi) sum se / sum |r|, where an image has `error` layers:\n"
               "              the part of rel_l1 that noise alone explains\n"
               "    error     sqrt(max(0, rel_l1^2 - n^2)), beside n\n"
               "    p95       95th percentile of |x-r| / (|r| + 0.01 m)\n"
               "    nan       values that are not finite in either image; they are left out, and "
               "the exit\n"
               "              code is 1\n"
               "\n"
               "Where the size is not a multiple of the block, the blocks at the right and bottom "
               "edge hold\n"
               "fewer pixels; every block weighs as many pixels as it holds.",
    .positionals = positionals,
    .num_positionals = ARRAY_SIZE(positionals),
    .groups = groups,
    .num_groups = ARRAY_SIZE(groups),
    .args_size = sizeof(compare_args),
    .run = run_compare,
};
