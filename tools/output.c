// output.c -- the pictures a frame gives: EXR layers and display-ready PNG.
#include "output.h"
#include "layers.h"
#include "sequence.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tyndall/io.h>

enum { COLOR_LAYER = 0, MAX_CHANNELS = 4 * NUM_PICTURE_LAYERS };

// ---- planning ---------------------------------------------------------------------------------

static void list_layers(uint32_t outputs, char *text, size_t size)
{
    size_t used = 0;
    text[0] = '\0';
    for (uint32_t i = COLOR_LAYER + 1; i < NUM_PICTURE_LAYERS && used < size; i++) {
        if (picture_layers[i].output & outputs && picture_layers[i].kind != LAYER_KEPT) {
            used += (size_t)snprintf(text + used, size - used, "%s%s", used ? ", " : "",
                                     picture_layers[i].name);
        }
    }
}

static bool add_layer(app *a, const tyn_method_info *info, const char *name, size_t length,
                      output_plan *plan)
{
    char known[256];
    for (uint32_t i = COLOR_LAYER + 1; i < NUM_PICTURE_LAYERS; i++) {
        if (picture_layers[i].kind == LAYER_KEPT || strlen(picture_layers[i].name) != length ||
            strncmp(picture_layers[i].name, name, length) != 0) {
            continue;
        }
        if (!(info->outputs & picture_layers[i].output)) {
            list_layers(info->outputs, known, sizeof known);
            app_error(a, "--aov: method '%s' does not make the layer '%s'; it makes: %s",
                      info->name, picture_layers[i].name, known[0] ? known : "none");
            return false;
        }
        plan->layers |= 1u << i;
        plan->outputs |= picture_layers[i].output;
        return true;
    }
    list_layers(UINT32_MAX, known, sizeof known);
    app_error(a, "--aov: there is no layer '%.*s'; there are: %s", (int)length, name, known);
    return false;
}

bool output_folder_is_writable(app *a, const char *path)
{
    const char *slash = strrchr(path, '/');
    char *folder = text_format("%.*s", slash ? (int)(slash - path) : 0, path);
    bool unknown = folder && sequence_has_number(folder);
    free(folder);
    return unknown || tyn_file_writable(path, &a->log) == TYN_OK;
}

int output_plan_make(app *a, const tyn_method_info *info, const opt_list *files, const char *aov,
                     bool full_float, output_plan *plan)
{
    bool layered = false;
    *plan = (output_plan){.layers = 1u << COLOR_LAYER, .full_float = full_float};
    for (uint32_t i = 0; i < files->count; i++) {
        bool exr = text_ends_with(files->items[i], ".exr");
        if (!exr && !text_ends_with(files->items[i], ".png")) {
            app_error(a, "-o: '%s' is neither .exr nor .png", files->items[i]);
            return EXIT_WRONG;
        }
        layered = layered || exr;
        // The exposure of a .png is judged by the radiance.
        plan->outputs |=
            TYN_OUTPUT_RADIANCE | (exr ? info->outputs & OUTPUT_SUMS : TYN_OUTPUT_DISPLAY);
    }
    if (aov && !layered) {
        app_error(a, "--aov: layers need an .exr file; give one with -o");
        return EXIT_WRONG;
    }
    while (aov && *aov) {
        size_t length = strcspn(aov, ",");
        if (!add_layer(a, info, aov, length, plan)) {
            return EXIT_WRONG;
        }
        aov += length + (aov[length] == ',');
    }
    for (uint32_t i = 0; i < files->count; i++) {
        if (!output_folder_is_writable(a, files->items[i])) {
            return EXIT_FAILED;
        }
    }
    return EXIT_DONE;
}

// ---- writing ----------------------------------------------------------------------------------

// Whether it was interrupted or not.
static int written(app *a, tyn_result result)
{
    return result == TYN_OK ? EXIT_DONE : app_exit_code(a, result, false);
}

static int write_exr(app *a, const output_plan *plan, tyn_offline *offline,
                     const picture_tags *tags, bool sums, const char *path)
{
    const size_t num = (size_t)tags->view->width * tags->view->height;
    tyn_channel channels[MAX_CHANNELS] = {0};
    tyn_image_file image = {.width = tags->view->width,
                            .height = tags->view->height,
                            .x = (int32_t)tags->view->corner[0],
                            .y = (int32_t)tags->view->corner[1],
                            .whole_width = tags->view->whole[0],
                            .whole_height = tags->view->whole[1],
                            .channels = channels};
    float *planes = malloc(num * MAX_CHANNELS * sizeof *planes);
    if (!planes) {
        app_error(a, "out of memory");
        return EXIT_FAILED;
    }
    for (uint32_t i = 0; i < NUM_PICTURE_LAYERS; i++) {
        const float *pixels = NULL;
        const bool kept = picture_layers[i].kind == LAYER_KEPT && sums &&
                          plan->outputs & picture_layers[i].output;
        if (plan->layers & 1u << i || kept) {
            pixels = tyn_offline_output(offline, picture_layers[i].output);
            if (!pixels) {
                app_error(a, "the method gave no layer '%s'", picture_layers[i].name);
                free(planes);
                return EXIT_FAILED;
            }
        }
        for (uint32_t c = 0; pixels && picture_layers[i].channels[c]; c++) {
            tyn_channel *channel = &channels[image.num_channels];
            channel->data = planes + num * image.num_channels++;
            layer_channel_name(&picture_layers[i], c, channel->name);
            channel->exact = picture_layers[i].kind >= LAYER_EXACT ||
                             (sums && picture_layers[i].kind <= LAYER_SUM);
            for (size_t k = 0; k < num; k++) {
                channel->data[k] = pixels[4 * k + picture_layers[i].first + c];
            }
        }
    }
    int code = tags_add(a, tags, &image);
    if (code == EXIT_DONE) {
        code = written(a, tyn_exr_write(&image, path, plan->full_float, &a->log));
    }
    image.channels = NULL; // are not its own
    image.num_channels = 0;
    tyn_image_file_finish(&image);
    free(planes);
    return code;
}

// Opaque, or with --no-background the medium alone with its alpha.
static int write_png(app *a, tyn_offline *offline, const tyn_view *view, const char *path)
{
    const size_t num = (size_t)view->width * view->height;
    const uint32_t channels = view->no_background ? 4 : 3;
    const uint8_t *rgba = tyn_offline_output(offline, TYN_OUTPUT_DISPLAY);
    uint8_t *pixels = rgba ? malloc(channels * num) : NULL;
    if (!pixels) {
        app_error(a, rgba ? "out of memory" : "the method gave no display image");
        return EXIT_FAILED;
    }
    for (size_t k = 0; k < num; k++) {
        memcpy(pixels + channels * k, rgba + 4 * k, channels);
    }
    tyn_result result = tyn_png_write(path, view->width, view->height, channels, pixels, &a->log);
    free(pixels);
    return written(a, result);
}

int output_write(app *a, const output_plan *plan, tyn_offline *offline, const picture_tags *tags,
                 bool sums, const char *path)
{
    return text_ends_with(path, ".png") ? write_png(a, offline, tags->view, path)
                                        : write_exr(a, plan, offline, tags, sums, path);
}
