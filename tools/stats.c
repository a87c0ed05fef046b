// stats.c -- what a run did, as JSON.
#include "stats.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tyndall/io.h>

// ---- JSON -------------------------------------------------------------------------------------

// The shortest decimal that reads back as the same float.
static cJSON *float_item(double value)
{
    if (!isfinite(value)) {
        return cJSON_CreateNull();
    }
    char text[32];
    for (int digits = 6; digits <= 9; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, value);
        if ((float)strtod(text, NULL) == (float)value) {
            break;
        }
    }
    return cJSON_CreateRaw(text);
}

void json_add_float(cJSON *object, const char *name, double value)
{
    cJSON_AddItemToObject(object, name, float_item(value));
}

cJSON *json_floats(const float *values, int count)
{
    cJSON *array = cJSON_CreateArray();
    for (int i = 0; i < count; i++) {
        cJSON_AddItemToArray(array, float_item(values[i]));
    }
    return array;
}

int json_write(app *a, cJSON *object, const char *path)
{
    char *text = object ? cJSON_Print(object) : NULL;
    cJSON_Delete(object);
    if (!text) {
        app_error(a, "out of memory");
        return EXIT_FAILED;
    }
    int code = EXIT_DONE;
    if (path) {
        char *line = text_format("%s\n", text);
        tyn_result result =
            line ? tyn_file_write(path, line, strlen(line), &a->log) : TYN_ERR_MEMORY;
        code = app_exit_code(a, result, false);
        free(line);
    } else {
        printf("%s\n", text);
    }
    free(text);
    return code;
}

// ---- the stats --------------------------------------------------------------------------------

cJSON *stats_report_nodes(const tyn_report *report)
{
    cJSON *nodes = cJSON_CreateArray();
    for (uint32_t i = 0; i < report->num_nodes; i++) {
        const tyn_node_report *n = &report->nodes[i];
        cJSON *node = cJSON_CreateObject(), *work = cJSON_CreateObject();
        cJSON_AddStringToObject(node, "name", n->name);
        cJSON_AddStringToObject(node, "state", n->state);
        cJSON_AddBoolToObject(node, "setup", n->media_only);
        json_add_float(node, "gpu_ms", n->gpu_ms);
        json_add_float(node, "cpu_ms", n->cpu_ms);
        cJSON_AddNumberToObject(node, "dispatches", n->dispatches);
        cJSON_AddNumberToObject(node, "barriers", n->barriers);
        cJSON_AddNumberToObject(node, "bytes", (double)n->bytes);
        cJSON_AddNumberToObject(node, "shared_bytes", (double)n->shared_bytes);
        cJSON_AddNumberToObject(node, "flops", n->flops);
        for (uint32_t k = 0; k < n->num_work; k++) {
            cJSON_AddNumberToObject(work, n->work[k].name, n->work[k].amount);
        }
        cJSON_AddItemToObject(node, "work", work);
        cJSON_AddItemToArray(nodes, node);
    }
    return nodes;
}

static void add_param(cJSON *settings, const tyn_pass_desc *pass, const tyn_param *param,
                      const void *params)
{
    char name[128];
    snprintf(name, sizeof name, "%s.%s", pass->name, param->name);
    const void *at = (const char *)params + param->offset;
    int32_t whole;
    float real;
    memcpy(&whole, at, sizeof whole);
    memcpy(&real, at, sizeof real);
    switch (param->type) {
    case TYN_PARAM_FLOAT:
        json_add_float(settings, name, real);
        break;
    case TYN_PARAM_INT:
        cJSON_AddNumberToObject(settings, name, whole);
        break;
    case TYN_PARAM_BOOL:
        cJSON_AddBoolToObject(settings, name, whole != 0);
        break;
    case TYN_PARAM_ENUM:
        cJSON_AddStringToObject(settings, name, param->names[whole]);
        break;
    }
}

cJSON *stats_settings(const method *m, const tyn_view *view)
{
    cJSON *settings = cJSON_CreateObject();
    for (const tyn_pass_desc *const *pass = m->info.passes; *pass; pass++) {
        void *params = calloc(1, (*pass)->params_size ? (*pass)->params_size : 1);
        if (params) {
            tyn_settings_params(m->settings, *pass, params);
            for (uint32_t i = 0; i < (*pass)->num_params; i++) {
                add_param(settings, *pass, &(*pass)->params[i], params);
            }
            free(params);
        }
    }
    if (m->info.progressive) {
        cJSON_AddNumberToObject(settings, "spp", view->num_samples);
        cJSON_AddNumberToObject(settings, "max_depth", view->max_depth);
        cJSON_AddNumberToObject(settings, "rr_depth", view->rr_depth);
    }
    cJSON_AddNumberToObject(settings, "seed", view->seed);
    return settings;
}

static void add_hash(cJSON *object, const char *name, uint64_t hash)
{
    char text[17];
    snprintf(text, sizeof text, "%016llx", (unsigned long long)hash);
    cJSON_AddStringToObject(object, name, text);
}

cJSON *stats_inputs(const tyn_scene *scene, const char *const *paths, size_t num_paths)
{
    cJSON *inputs = cJSON_CreateObject();
    for (size_t i = 0; i < num_paths; i++) {
        void *data = NULL;
        size_t size = 0;
        if (paths[i] && tyn_file_read(paths[i], UINT64_C(1) << 32, &data, &size, NULL) == TYN_OK) {
            add_hash(inputs, paths[i], text_hash(data, size, 0));
        }
        free(data);
    }
    for (uint32_t i = 0; i < scene->num_volumes; i++) {
        char name[32];
        snprintf(name, sizeof name, "volume %u", i);
        add_hash(inputs, name, scene->volumes[i].hash);
    }
    for (uint32_t i = 0; i < scene->num_color_grids; i++) {
        char name[32];
        snprintf(name, sizeof name, "colours %u", i);
        add_hash(inputs, name, scene->color_grids[i].hash);
    }
    if (scene->environment.data) {
        add_hash(inputs, "environment", scene->environment.hash);
    }
    return inputs;
}

cJSON *stats_make(const stats *s)
{
    cJSON *root = cJSON_CreateObject();
    cJSON_AddStringToObject(root, "tyndall", tyn_version_string());
    cJSON_AddStringToObject(root, "device", s->device);
    cJSON_AddStringToObject(root, "method", s->method->info.name);
    int size[2] = {(int)s->view->width, (int)s->view->height};
    cJSON_AddItemToObject(root, "size", cJSON_CreateIntArray(size, 2));
    if (s->view->whole[0]) {
        const int crop[4] = {(int)s->view->corner[0], (int)s->view->corner[1],
                             (int)s->view->whole[0], (int)s->view->whole[1]};
        cJSON_AddItemToObject(root, "part_of", cJSON_CreateIntArray(crop, 4));
    }
    json_add_float(root, "setup_ms", s->setup_ms);
    cJSON *frame = cJSON_AddObjectToObject(root, "frame_ms");
    json_add_float(frame, "cold", s->cold_ms);
    json_add_float(frame, "camera_moved", s->camera_moved_ms);
    json_add_float(frame, "light_moved", s->light_moved_ms);
    json_add_float(frame, "sky_dimmed", s->sky_dimmed_ms);
    json_add_float(frame, "unchanged", s->unchanged_ms);
    cJSON *pipelines = cJSON_AddObjectToObject(root, "pipelines");
    cJSON_AddNumberToObject(pipelines, "compiled", s->pipelines.compiled);
    cJSON_AddNumberToObject(pipelines, "from_cache", s->pipelines.from_cache);
    json_add_float(pipelines, "seconds", s->pipelines.seconds);
    cJSON_AddItemToObject(root, "nodes", stats_report_nodes(s->report));
    cJSON *memory = cJSON_AddObjectToObject(root, "memory");
    cJSON_AddNumberToObject(memory, "persistent", (double)s->report->persistent_bytes);
    cJSON_AddNumberToObject(memory, "transient", (double)s->report->transient_bytes);
    cJSON *warnings = cJSON_AddArrayToObject(root, "warnings");
    for (uint32_t i = 0; i < s->scene->num_warnings; i++) {
        cJSON_AddItemToArray(warnings, cJSON_CreateString(s->scene->warnings[i]));
    }
    for (uint32_t i = 0; i < s->report->num_warnings; i++) {
        cJSON_AddItemToArray(warnings, cJSON_CreateString(s->report->warnings[i]));
    }
    for (size_t i = 0; i < ARRAY_SIZE(s->warnings); i++) {
        if (s->warnings[i]) {
            cJSON_AddItemToArray(warnings, cJSON_CreateString(s->warnings[i]));
        }
    }
    if (s->choice) {
        cJSON_AddItemToObject(root, "choice", cJSON_Duplicate(s->choice, true));
    }
    cJSON_AddItemToObject(root, "settings", stats_settings(s->method, s->view));
    cJSON_AddItemToObject(root, "inputs", stats_inputs(s->scene, s->inputs, ARRAY_SIZE(s->inputs)));
    return root;
}
