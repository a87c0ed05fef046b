// save.c -- the picture at rest as scene-linear EXR and the camera as glTF.
#include "output.h"
#include "view/viewer.h"
#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tyndall/io.h>
#include <unistd.h>

static bool exists(const char *path)
{
    return path && access(path, F_OK) == 0;
}

// STEM-1.exr and STEM-1.gltf, or the first number of which neither is there.
static bool choose_names(const viewer *v, char **exr, char **gltf)
{
    char *stem = v->args->output ? text_format("%s", v->args->output) : text_stem(v->source.scene);
    *exr = *gltf = NULL;
    for (uint32_t n = 1; stem && n < 10000; n++) {
        free(*exr);
        free(*gltf);
        *exr = text_format("%s-%u.exr", stem, n);
        *gltf = text_format("%s-%u.gltf", stem, n);
        if (!*exr || !*gltf || (!exists(*exr) && !exists(*gltf))) {
            break;
        }
    }
    free(stem);
    return *exr && *gltf;
}

static tyn_result write_exr(viewer *v, const char *path)
{
    const size_t count = (size_t)v->pixels_width * v->pixels_height;
    float *planes = malloc(4 * count * sizeof *planes);
    if (!planes) {
        return TYN_ERR_MEMORY;
    }
    tyn_channel channels[4] = {{.name = "R"}, {.name = "G"}, {.name = "B"}, {.name = "A"}};
    for (size_t c = 0; c < 4; c++) {
        channels[c].data = planes + c * count;
        for (size_t i = 0; i < count; i++) {
            channels[c].data[i] = v->pixels[4 * i + c];
        }
    }
    const tyn_image_file image = {.width = v->pixels_width,
                                  .height = v->pixels_height,
                                  .num_channels = 4,
                                  .channels = channels};
    const tyn_result result = tyn_exr_write(&image, path, false, &v->app->log);
    free(planes);
    return result;
}

static cJSON *camera_json(const viewer *v)
{
    const tyn_camera *camera = &v->camera.camera;
    const double near = 1e-3 * v->camera.size, far = 1e3 * v->camera.size;
    cJSON *json = cJSON_CreateObject();
    const bool parallel = camera->projection == TYN_ORTHOGRAPHIC;
    cJSON_AddStringToObject(json, "type", parallel ? "orthographic" : "perspective");
    cJSON *lens = cJSON_AddObjectToObject(json, parallel ? "orthographic" : "perspective");
    cJSON_AddNumberToObject(lens, "znear", near);
    if (parallel) {
        cJSON_AddNumberToObject(lens, "zfar", far);
        cJSON_AddNumberToObject(lens, "ymag", camera->ymag);
        cJSON_AddNumberToObject(lens, "xmag", camera->ymag * viewer_aspect(v));
    } else {
        cJSON_AddNumberToObject(lens, "yfov", camera->yfov);
        cJSON_AddNumberToObject(lens, "aspectRatio", viewer_aspect(v));
    }
    return json;
}

static cJSON *array_of(cJSON *item)
{
    cJSON *array = cJSON_CreateArray();
    cJSON_AddItemToArray(array, item);
    return array;
}

static tyn_result write_gltf(viewer *v, const char *path)
{
    const tyn_camera *camera = &v->camera.camera;
    const float *axes[] = {camera->right, camera->up, camera->back, camera->position};
    double matrix[16];
    for (int i = 0; i < 16; i++) {
        matrix[i] = i % 4 < 3 ? axes[i / 4][i % 4] : i == 15;
    }
    cJSON *root = cJSON_CreateObject(), *node = cJSON_CreateObject();
    cJSON *asset = cJSON_AddObjectToObject(root, "asset");
    cJSON_AddStringToObject(asset, "version", "2.0");
    cJSON_AddStringToObject(asset, "generator", "tyndall view");
    cJSON_AddNumberToObject(root, "scene", 0);
    cJSON *scene = cJSON_CreateObject();
    const int first = 0;
    cJSON_AddItemToObject(scene, "nodes", cJSON_CreateIntArray(&first, 1));
    cJSON_AddItemToObject(root, "scenes", array_of(scene));
    cJSON_AddStringToObject(node, "name", "view");
    cJSON_AddNumberToObject(node, "camera", 0);
    cJSON_AddItemToObject(node, "matrix", cJSON_CreateDoubleArray(matrix, 16));
    cJSON_AddItemToObject(root, "nodes", array_of(node));
    cJSON_AddItemToObject(root, "cameras", array_of(camera_json(v)));
    char *text = cJSON_Print(root);
    cJSON_Delete(root);
    const tyn_result result =
        text ? tyn_file_write(path, text, strlen(text), &v->app->log) : TYN_ERR_MEMORY;
    free(text);
    return result;
}

void save_picture(viewer *v)
{
    char *exr, *gltf;
    const bool named = choose_names(v, &exr, &gltf);
    if (named && v->pixels && write_exr(v, exr) == TYN_OK && write_gltf(v, gltf) == TYN_OK) {
        const float *p = v->camera.camera.position, *t = v->camera.target;
        viewer_note(v, "saved %s and %s", exr, gltf);
        printf("%s %s --size %ux%u --look-from=%.9g,%.9g,%.9g --look-at=%.9g,%.9g,%.9g", exr, gltf,
               v->pixels_width, v->pixels_height, p[0], p[1], p[2], t[0], t[1], t[2]);
        if (v->camera.camera.projection == TYN_PERSPECTIVE) {
            printf(" --fov %.9g", v->camera.camera.yfov * 180 / 3.14159265358979323846);
        }
        if (v->layer) { // it may change how pixels are marched
            printf(" --aov %s", picture_layers[v->layer].name);
        }
        printf("\n");
        fflush(stdout);
    } else {
        viewer_note(v, "the picture cannot be saved: %s", v->app->last_error);
    }
    free(exr);
    free(gltf);
}
