// cmd_compare.c -- `tyndall compare`: error of one image against another.
#include "app.h"
#include "flip.h"
#include "metrics.h"
#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <tyndall/io.h>

enum { MAX_EXPOSURES = 100 };

typedef struct compare_args {
    const char *image, *reference;
    uint32_t block;
    const char *heat, *flip_map;
    bool hdr_flip;
    opt_vector exposures;
    bool json, quiet;
} compare_args;

// Are the standard errors of channel c, of the layer `name`, what they must be?
static bool check_errors(app *a, const metrics_image *image, int c, const char *path,
                         const char *name)
{
    const size_t num = (size_t)image->width * image->height;
    for (size_t i = 0; image->se[c] && i < num; i++) {
        if (!(image->se[c][i] >= 0 && isfinite(image->se[c][i]))) {
            app_error(a,
                      "%s: %s is %g at pixel (%zu, %zu); standard errors must be finite and not "
                      "negative",
                      path, name, (double)image->se[c][i], i % image->width, i / image->width);
            return false;
        }
    }
    return true;
}

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
        if (!check_errors(a, image, c, path, errors[c])) {
            return false;
        }
    }
    return true;
}

// Black, violet, red, orange, yellow, white from 0 to 1; not a number is green.
static void ramp_color(double value, uint8_t rgb[3])
{
    static const uint8_t ramp[6][3] = {{0, 0, 0},      {74, 18, 110},  {170, 36, 80},
                                       {240, 110, 30}, {250, 210, 60}, {255, 255, 255}};
    if (isnan(value)) {
        rgb[0] = rgb[2] = 0;
        rgb[1] = 255;
        return;
    }
    double t = 5 * fmin(fmax(value, 0), 1);
    int i = t < 5 ? (int)t : 4;
    for (int c = 0; c < 3; c++) {
        rgb[c] = (uint8_t)lround(ramp[i][c] + (t - i) * (ramp[i + 1][c] - ramp[i][c]));
    }
}

// One value a pixel as colours: 0 to 1, or with `logarithmic` 0.001 to 1.
static int write_ramp(app *a, const char *path, const metrics_image *image, const float *values,
                      bool logarithmic)
{
    const size_t num = (size_t)image->width * image->height;
    uint8_t *pixels = malloc(3 * num);
    if (!pixels) {
        return app_exit_code(a, TYN_ERR_MEMORY, false);
    }
    for (size_t i = 0; i < num; i++) {
        const double decades = log10(fmax(values[i], 1e-3));
        ramp_color(logarithmic && !isnan(values[i]) ? (decades + 3) / 3 : values[i],
                   &pixels[3 * i]);
    }
    const tyn_result result = tyn_png_write(path, image->width, image->height, 3, pixels, &a->log);
    free(pixels);
    return app_exit_code(a, result, false);
}

static int write_heat(app *a, const compare_args *args, const metrics_image *image,
                      const metrics_image *reference)
{
    size_t num = (size_t)image->width * image->height;
    float *heat = malloc(num * sizeof *heat);
    int code = EXIT_FAILED;
    if (heat && metrics_heat(image, reference, args->block, heat) == METRICS_OK) {
        code = write_ramp(a, args->heat, image, heat, true);
    } else {
        app_error(a, "out of memory");
    }
    free(heat);
    return code;
}

// Every value that is printed, in order: text and JSON.
typedef struct row {
    const char *name;
    double value;
    bool known;
} row;

static void print_rows(const row *rows, size_t num, bool json)
{
    cJSON *object = json ? cJSON_CreateObject() : NULL;
    for (size_t i = 0; i < num; i++) {
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

// ---- FLIP -------------------------------------------------------------------------------------

typedef struct flip_values {
    double ldr, hdr; // hdr: with --hdr-flip
} flip_values;

static bool is_png(const char *path)
{
    return text_ends_with(path, ".png");
}

static bool find_exposures(const compare_args *args, const metrics_image *reference,
                           flip_exposures *exposures)
{
    const float *given = args->exposures.v;
    *exposures = (flip_exposures){given[0], given[1], (uint32_t)given[2]};
    return args->exposures.given || flip_find_exposures(reference, exposures);
}

// `scale`: of the tone map; a .png has gone through one.
static int measure_flip(app *a, const compare_args *args, const metrics_image *image,
                        const metrics_image *reference, float scale, flip_values *out)
{
    const size_t num = (size_t)image->width * image->height;
    float *map = args->flip_map ? malloc(num * sizeof *map) : NULL;
    flip_exposures exposures;
    bool done = (map || !args->flip_map) && flip_ldr(image, reference, scale, map, &out->ldr);
    if (done && args->hdr_flip) {
        done = find_exposures(args, reference, &exposures) &&
               flip_hdr(image, reference, &exposures, map, &out->hdr);
    }
    int code = done ? EXIT_DONE : app_exit_code(a, TYN_ERR_MEMORY, false);
    if (done && map) {
        code = write_ramp(a, args->flip_map, image, map, false);
    }
    free(map);
    return code;
}

static bool same_size(app *a, const compare_args *args, const metrics_image *image,
                      const metrics_image *reference)
{
    const bool same = image->width == reference->width && image->height == reference->height;
    if (!same) {
        app_error(a, "%s is %ux%u and %s is %ux%u; both need the same size", args->image,
                  image->width, image->height, args->reference, reference->width,
                  reference->height);
    }
    return same;
}

// ---- .exr -------------------------------------------------------------------------------------

static int compare_files(app *a, const compare_args *args, const tyn_image_file *file,
                         const tyn_image_file *reference_file)
{
    metrics_image image, reference;
    if (!find_channels(a, file, args->image, &image) ||
        !find_channels(a, reference_file, args->reference, &reference)) {
        return EXIT_WRONG;
    }
    if (!same_size(a, args, &image, &reference)) {
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
    flip_values flip = {0};
    float scale;
    if (!flip_scale(&reference, &scale)) {
        return app_exit_code(a, TYN_ERR_MEMORY, false);
    }
    const int code = measure_flip(a, args, &image, &reference, scale, &flip);
    if (code != EXIT_DONE) {
        return code;
    }
    const row rows[] = {
        {"rel_l1", m.rel_l1, true},
        {"rmse", m.rmse, true},
        {"rel_rmse", m.rel_rmse, true},
        {"rel_mse", m.rel_mse, true},
        {"smape", m.smape, true},
        {"bias", m.bias, true},
        {"n", m.n, m.has_n},
        {"error", m.error, m.has_n},
        {"p95", m.p95, true},
        {"flip", flip.ldr, true},
        {"hdr_flip", flip.hdr, args->hdr_flip},
        {"nan", (double)m.nan, true},
    };
    print_rows(rows, ARRAY_SIZE(rows), args->json);
    return m.nan ? EXIT_FAILED : EXIT_DONE;
}

static int compare_exr(app *a, const compare_args *args)
{
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

// ---- .png -------------------------------------------------------------------------------------

// Linear planes of a .png over black, in `planes`, which are freed by the caller.
static int read_png(app *a, const char *path, float **planes, metrics_image *image)
{
    uint8_t *rgba;
    *image = (metrics_image){0};
    int code =
        app_exit_code(a, tyn_png_read(path, &image->width, &image->height, &rgba, &a->log), true);
    if (code != EXIT_DONE) {
        return code;
    }
    const size_t num = (size_t)image->width * image->height;
    *planes = malloc(3 * num * sizeof **planes);
    float linear[256]; // IEC 61966-2-1
    for (int i = 0; i < 256; i++) {
        const double x = i / 255.0;
        linear[i] = (float)(x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4));
    }
    for (size_t c = 0; *planes && c < 3; c++) {
        float *plane = *planes + c * num;
        for (size_t i = 0; i < num; i++) {
            plane[i] = linear[rgba[4 * i + c]] * (float)rgba[4 * i + 3] / 255;
        }
        image->rgb[c] = plane;
    }
    free(rgba);
    return *planes ? EXIT_DONE : app_exit_code(a, TYN_ERR_MEMORY, false);
}

// What radiance is needed for.
static bool check_png(app *a, const compare_args *args)
{
    const char *given = args->block > 1  ? "--block"
                        : args->heat     ? "--heat"
                        : args->hdr_flip ? "--hdr-flip"
                                         : NULL;
    if (!is_png(args->image) || !is_png(args->reference)) {
        app_error(a, "%s, %s: compare two .exr files or two .png files, not one of each",
                  args->image, args->reference);
        return false;
    }
    if (given) {
        app_error(a, "%s: is for .exr files; a .png holds no radiance", given);
    }
    return !given;
}

static int compare_png(app *a, const compare_args *args)
{
    float *planes[2] = {NULL, NULL};
    metrics_image image, reference;
    flip_values flip = {0};
    int code = check_png(a, args) ? read_png(a, args->image, &planes[0], &image) : EXIT_WRONG;
    if (code == EXIT_DONE) {
        code = read_png(a, args->reference, &planes[1], &reference);
    }
    if (code == EXIT_DONE) {
        code = same_size(a, args, &image, &reference)
                   ? measure_flip(a, args, &image, &reference, 1, &flip)
                   : EXIT_WRONG;
    }
    if (code == EXIT_DONE) {
        print_rows(&(row){"flip", flip.ldr, true}, 1, args->json);
    }
    free(planes[0]);
    free(planes[1]);
    return code;
}

// ---- the command ------------------------------------------------------------------------------

static bool check_options(app *a, const compare_args *args)
{
    const float *e = args->exposures.v;
    const struct {
        const char *option, *file;
    } pictures[] = {{"--heat", args->heat}, {"--flip-map", args->flip_map}};
    for (size_t i = 0; i < ARRAY_SIZE(pictures); i++) {
        if (pictures[i].file && !is_png(pictures[i].file)) {
            app_error(a, "%s: '%s' is not a .png file name", pictures[i].option, pictures[i].file);
            return false;
        }
    }
    if (!args->exposures.given) {
        return true;
    }
    if (!args->hdr_flip) {
        app_error(a, "--exposures: is for --hdr-flip");
        return false;
    }
    if (!(fabsf(e[0]) <= 100 && e[1] >= e[0] && e[1] <= 100 && e[2] >= 2 && e[2] <= MAX_EXPOSURES &&
          e[2] == floorf(e[2]))) {
        app_error(a,
                  "--exposures: '%g,%g,%g' must be START,STOP,COUNT with -100 <= START <= STOP <= "
                  "100 and a COUNT of 2 to %d",
                  (double)e[0], (double)e[1], (double)e[2], MAX_EXPOSURES);
        return false;
    }
    return true;
}

static int run_compare(app *a, const void *arguments)
{
    const compare_args *args = arguments;
    a->quiet = args->quiet;
    if (!check_options(a, args)) {
        return EXIT_WRONG;
    }
    const bool png = is_png(args->image) || is_png(args->reference);
    return png ? compare_png(a, args) : compare_exr(a, args);
}

#define AT(field) offsetof(compare_args, field)
static const opt_positional positionals[] = {
    {"A.exr", "the image; or a .png, beside a .png", true, AT(image)},
    {"REF.exr", "the reference, of the same size", true, AT(reference)},
};
static const option options[] = {
    {0, "block", OPT_UINT, AT(block), "N", "average NxN pixels first (noisy references)", 1, 1, 0},
    {0, "heat", OPT_TEXT, AT(heat), "FILE.png",
     "picture of |x - r| / (|r| + 0.01 m), 0.1 % to 100 %", .file = OPT_WRITES},
    {0, "flip-map", OPT_TEXT, AT(flip_map), "FILE.png",
     "picture of flip, 0 to 1; of hdr_flip with --hdr-flip", .file = OPT_WRITES},
    {0, "hdr-flip", OPT_FLAG, AT(hdr_flip), NULL, "hdr_flip as well"},
    {0, "exposures", OPT_VECTOR, AT(exposures), "START,STOP,COUNT",
     "of --hdr-flip, in stops; else from the reference"},
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
               "    flip      mean of LDR-FLIP (2020), 67 pixels per degree: how different the two "
               "look\n"
               "    hdr_flip  mean of HDR-FLIP (2021), with --hdr-flip\n"
               "    nan       values that are not finite in either image; where there are any, the "
               "others are\n"
               "              nan (--json: null), and the exit code is 1\n"
               "\n"
               "Where the size is not a multiple of the block, the blocks at the right and bottom "
               "edge hold\n"
               "fewer pixels; every block weighs as many pixels as it holds.\n"
               "\n"
               "flip and hdr_flip are of single pixels whatever the block: 0 where nobody sees a "
               "difference,\n"
               "1 at most. Two .png files have flip alone, as they are (over black where they are "
               "not opaque).\n"
               "The tone map of .exr files divides both by what 99.5 % of the R, G and B of the "
               "reference do\n"
               "not exceed, and cuts at 0 and 1. hdr_flip takes the largest flip of each pixel "
               "over exposures\n"
               "of a filmic curve (ACES), one a stop, from the one that shows the reference's "
               "largest luminance\n"
               "at 0.85 to the one that shows its median there (of pixels that are not black). "
               "Both are nan\n"
               "where a value is not finite.",
    .positionals = positionals,
    .num_positionals = ARRAY_SIZE(positionals),
    .groups = groups,
    .num_groups = ARRAY_SIZE(groups),
    .args_size = sizeof(compare_args),
    .run = run_compare,
};
