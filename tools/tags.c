// tags.c -- what an .exr says of its picture: camera, method, settings, samples, and what it is a picture of.
#include "tags.h"
#include "bench/reference.h"
#include "json_at.h"
#include "stats.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- the camera -------------------------------------------------------------------------------

// Half sides of the picture, at distance 1 of a perspective camera, in m of an orthographic one.
static void half_sides(const tyn_view *view, double *width, double *height)
{
    const tyn_camera *c = &view->camera;
    *height = c->projection == TYN_PERSPECTIVE ? tan((double)c->yfov / 2) : (double)c->ymag;
    *width = view->whole[0] ? *height * view->whole[0] / view->whole[1]
                            : *height * view->width / view->height;
}

// Row vectors times it are x to the right, y up, z along the view: left-handed, as OpenEXR and RenderMan have it.
static void world_to_camera(const tyn_camera *c, double m[16])
{
    const float *axes[3] = {c->right, c->up, c->back};
    memset(m, 0, 16 * sizeof *m);
    for (int column = 0; column < 3; column++) {
        const double sign = column == 2 ? -1 : 1;
        for (int row = 0; row < 3; row++) {
            const double axis = sign * (double)axes[column][row] + 0.0; // no -0
            m[4 * row + column] = axis;
            m[12 + column] -= axis * (double)c->position[row];
        }
    }
    m[15] = 1;
}

// After a division by w: x and y from (0, 0) in the upper left corner of the picture to (1, 1) in the lower right one.
static void world_to_ndc(const tyn_view *view, double m[16])
{
    double camera[16], width, height;
    world_to_camera(&view->camera, camera);
    half_sides(view, &width, &height);
    const bool perspective = view->camera.projection == TYN_PERSPECTIVE;
    for (int row = 0; row < 4; row++) {
        const double *v = &camera[4 * row];
        const double w = perspective ? v[2] : v[3];
        m[4 * row] = 0.5 * v[0] / width + 0.5 * w;
        m[4 * row + 1] = -0.5 * v[1] / height + 0.5 * w;
        m[4 * row + 2] = perspective ? v[2] - v[3] : v[2]; // 0 at 1 m, 1 far away; or the distance
        m[4 * row + 3] = w;
    }
}

static char *camera_json(const tyn_camera *c)
{
    cJSON *json = cJSON_CreateObject();
    const char *name = c->name ? c->name : c->camera_name;
    const bool perspective = c->projection == TYN_PERSPECTIVE;
    if (name) {
        cJSON_AddStringToObject(json, "name", name);
    }
    cJSON_AddStringToObject(json, "projection", perspective ? "perspective" : "orthographic");
    json_add_float(json, perspective ? "yfov" : "ymag", perspective ? c->yfov : c->ymag);
    cJSON_AddItemToObject(json, "position", json_floats(c->position, 3));
    cJSON_AddItemToObject(json, "right", json_floats(c->right, 3));
    cJSON_AddItemToObject(json, "up", json_floats(c->up, 3));
    char *text = cJSON_PrintUnformatted(json);
    cJSON_Delete(json);
    return text;
}

// ---- what it is a picture of ------------------------------------------------------------------

void tags_hash(const picture_tags *tags, char hash[17])
{
    cJSON *settings = stats_settings(tags->method, tags->view);
    cJSON_DeleteItemFromObject(settings, "seed");
    cJSON_DeleteItemFromObject(settings, "spp");
    for (cJSON *at = settings ? settings->child : NULL, *next; at; at = next) {
        next = at->next;
        if (strncmp(at->string, "tonemap.", 8) == 0) { // the .exr is before it
            cJSON_Delete(cJSON_DetachItemViaPointer(settings, at));
        }
    }
    char *text = cJSON_PrintUnformatted(settings);
    uint64_t key = bench_scene_hash(tags->scene, tags->view);
    key = text_hash(tyn_version_string(), strlen(tyn_version_string()), key);
    key = text_hash(tags->method->info.name, strlen(tags->method->info.name), key);
    key = text ? text_hash(text, strlen(text), key) : key;
    snprintf(hash, 17, "%016llx", (unsigned long long)key);
    free(text);
    cJSON_Delete(settings);
}

// A whole number that somebody else may have written; 0 where it is none.
static uint32_t whole(const cJSON *object, const char *name)
{
    const double value = json_number_at(object, name, 0);
    return value >= 0 && value <= (double)UINT32_MAX ? (uint32_t)value : 0;
}

sample_range *tags_parts(const tyn_image_file *file, uint32_t *count)
{
    cJSON *json = cJSON_Parse(tyn_image_file_text(file, TAG_PARTS));
    const int size = cJSON_IsArray(json) ? cJSON_GetArraySize(json) : 0;
    sample_range *parts = size > 0 ? calloc((size_t)size, sizeof *parts) : NULL;
    uint32_t n = 0;
    for (const cJSON *p = json ? json->child : NULL; parts && p; p = p->next) {
        parts[n++] = (sample_range){whole(p, "seed"), whole(p, "first"), whole(p, "count")};
    }
    cJSON_Delete(json);
    *count = n;
    return parts;
}

bool tags_set_parts(tyn_image_file *file, const sample_range *parts, uint32_t count)
{
    cJSON *json = cJSON_CreateArray();
    for (uint32_t i = 0; i < count; i++) {
        cJSON *part = cJSON_CreateObject();
        cJSON_AddNumberToObject(part, "seed", parts[i].seed);
        cJSON_AddNumberToObject(part, "first", parts[i].first);
        cJSON_AddNumberToObject(part, "count", parts[i].count);
        cJSON_AddItemToArray(json, part);
    }
    char *text = cJSON_PrintUnformatted(json);
    const bool done = tyn_image_file_set_text(file, TAG_PARTS, text);
    free(text);
    cJSON_Delete(json);
    return done;
}

// ---- all of them ------------------------------------------------------------------------------

static bool set_json(tyn_image_file *file, const char *name, char *text)
{
    const bool done = tyn_image_file_set_text(file, name, text);
    free(text);
    return done;
}

static bool set_samples(tyn_image_file *file, const picture_tags *tags)
{
    const double samples = tags->samples;
    const sample_range part = {tags->view->seed, tags->view->sample_offset, tags->samples};
    char seed[16];
    snprintf(seed, sizeof seed, "%u", tags->view->seed);
    return tyn_image_file_set_text(file, TAG_SEED, seed) &&
           tyn_image_file_set_numbers(file, TAG_SAMPLES, TYN_ATTRIBUTE_INTEGER, &samples) &&
           tags_set_parts(file, &part, 1);
}

int tags_add(app *a, const picture_tags *tags, tyn_image_file *file)
{
    // Rec.709 primaries, D65.
    static const double primaries[8] = {0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290};
    const tyn_camera *camera = &tags->view->camera;
    double to_camera[16], to_ndc[16], width, height;
    char hash[17], *software = text_format("Tyndall %s", tyn_version_string());
    cJSON *settings = stats_settings(tags->method, tags->view);
    world_to_camera(camera, to_camera);
    world_to_ndc(tags->view, to_ndc);
    tags_hash(tags, hash);
    half_sides(tags->view, &width, &height);
    file->screen_width = camera->projection == TYN_PERSPECTIVE ? (float)(2 * width) : 1;
    const bool done =
        set_json(file, "software", software) &&
        tyn_image_file_set_numbers(file, "chromaticities", TYN_ATTRIBUTE_CHROMATICITIES,
                                   primaries) &&
        tyn_image_file_set_numbers(file, "worldToCamera", TYN_ATTRIBUTE_MATRIX, to_camera) &&
        tyn_image_file_set_numbers(file, "worldToNDC", TYN_ATTRIBUTE_MATRIX, to_ndc) &&
        set_json(file, TAG_CAMERA, camera_json(camera)) &&
        tyn_image_file_set_text(file, TAG_METHOD, tags->method->info.name) &&
        set_json(file, TAG_SETTINGS, cJSON_PrintUnformatted(settings)) &&
        tyn_image_file_set_text(file, TAG_SCENE, hash) &&
        (tags->samples == 0 || set_samples(file, tags));
    cJSON_Delete(settings);
    return done ? EXIT_DONE : app_exit_code(a, TYN_ERR_MEMORY, false);
}
