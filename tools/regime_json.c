// regime_json.c -- a scene's regime as JSON, and back.
#include "regime.h"
#include <math.h>
#include <stdio.h>

const char *const regime_light_names[REGIME_NUM_LIGHTS] = {"sun",   "sky",      "map",
                                                           "lamps", "emission", "surfaces"};

// Where each figure stands: one table for both ways.
#define FIGURE(name, field)                                                                        \
    {                                                                                              \
        name, offsetof(regime, field), 1                                                           \
    }
#define FIGURES(name, field)                                                                       \
    {                                                                                              \
        name, offsetof(regime, field), 3                                                           \
    }
static const struct {
    const char *name;
    size_t offset;
    int count; // of doubles
} figures[] = {
    FIGURE("optical_depth", optical_depth),
    FIGURES("optical_depth_rgb", depth_rgb),
    FIGURES("optical_depth_axes", depth_axis),
    FIGURE("optical_depth_densest", depth_densest),
    FIGURE("optical_depth_deepest", depth_deepest),
    FIGURE("albedo", albedo),
    FIGURES("albedo_rgb", albedo_rgb),
    FIGURE("g", g),
    FIGURES("g_rgb", g_rgb),
    FIGURE("least_g", least_g),
    FIGURE("most_g", most_g),
    FIGURE("mean_free_path", mean_free_path),
    FIGURE("transport_mean_free_path", transport_mean_free_path),
    FIGURE("scaled_mean_free_path", scaled_mean_free_path),
    FIGURES("sides", sides),
    FIGURE("thickness", thickness),
    FIGURE("cell", cell),
    FIGURE("cell_depth", cell_depth),
    FIGURE("cell_depth_max", cell_depth_max),
    FIGURE("contrast", contrast),
    FIGURE("fill", fill),
    FIGURE("box_share", box_share),
    FIGURE("view_fill", view_fill),
    FIGURE("view_depth", view_depth),
};
enum { NUM_FIGURES = sizeof figures / sizeof figures[0] };

// Four digits: the sampling is not better.
static cJSON *number(double value)
{
    if (!isfinite(value)) {
        return cJSON_CreateNull();
    }
    char text[32];
    snprintf(text, sizeof text, "%.4g", value);
    return cJSON_CreateRaw(text);
}

cJSON *regime_json(const regime *r)
{
    cJSON *json = cJSON_CreateObject();
    for (int i = 0; i < NUM_FIGURES; i++) {
        const double *values = (const double *)((const char *)r + figures[i].offset);
        if (figures[i].count == 1) {
            cJSON_AddItemToObject(json, figures[i].name, number(*values));
            continue;
        }
        cJSON *array = cJSON_AddArrayToObject(json, figures[i].name);
        for (int k = 0; k < figures[i].count; k++) {
            cJSON_AddItemToArray(array, number(values[k]));
        }
    }
    cJSON *lights = cJSON_AddArrayToObject(json, "lights");
    cJSON *shares = cJSON_AddObjectToObject(json, "light_share");
    for (int i = 0; i < REGIME_NUM_LIGHTS; i++) {
        if (r->share[i] > 0) {
            cJSON_AddItemToArray(lights, cJSON_CreateString(regime_light_names[i]));
            cJSON_AddItemToObject(shares, regime_light_names[i], number(r->share[i]));
        }
    }
    cJSON_AddNumberToObject(json, "channels", r->channels);
    cJSON_AddNumberToObject(json, "voxels", (double)r->voxels);
    cJSON_AddNumberToObject(json, "suns", r->num_suns);
    cJSON_AddNumberToObject(json, "lamps", r->num_lamps);
    cJSON_AddNumberToObject(json, "triangles", r->num_triangles);
    cJSON_AddBoolToObject(json, "periodic", r->periodic);
    cJSON_AddBoolToObject(json, "camera_inside", r->camera_inside);
    return json;
}

static double value_of(const cJSON *item)
{
    return cJSON_IsNumber(item) ? item->valuedouble : 0;
}

static double value_at(const cJSON *object, const char *name)
{
    return value_of(cJSON_GetObjectItemCaseSensitive(object, name));
}

bool regime_read(const cJSON *json, regime *r)
{
    *r = (regime){0};
    if (!cJSON_IsObject(json)) {
        return false;
    }
    for (int i = 0; i < NUM_FIGURES; i++) {
        const cJSON *item = cJSON_GetObjectItemCaseSensitive(json, figures[i].name);
        double *values = (double *)((char *)r + figures[i].offset);
        for (int k = 0; k < figures[i].count; k++) {
            values[k] = value_of(figures[i].count == 1 ? item : cJSON_GetArrayItem(item, k));
        }
    }
    const cJSON *shares = cJSON_GetObjectItemCaseSensitive(json, "light_share");
    for (int i = 0; i < REGIME_NUM_LIGHTS; i++) {
        r->share[i] = value_at(shares, regime_light_names[i]);
    }
    r->channels = value_at(json, "channels") == 1 ? 1 : 3;
    r->voxels = (uint64_t)fmax(value_at(json, "voxels"), 0);
    r->num_suns = (uint32_t)fmax(value_at(json, "suns"), 0);
    r->num_lamps = (uint32_t)fmax(value_at(json, "lamps"), 0);
    r->num_triangles = (uint32_t)fmax(value_at(json, "triangles"), 0);
    r->periodic = cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(json, "periodic"));
    r->camera_inside = cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(json, "camera_inside"));
    return true;
}
