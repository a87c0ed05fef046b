// gltf_model.c -- see gltf_model.h.
#include "io/gltf_model.h"
#include "io/gltf_check.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "io/uri.h"

// ---- buffers ----------------------------------------------------------------------------------

bool tyn_gltf_data_uri(const char *uri, void **bytes, size_t *size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    static const char marker[] = ";base64,";
    const char *text = strncmp(uri, "data:", 5) == 0 ? strstr(uri, marker) : NULL;
    text = text ? text + sizeof marker - 1 : "";
    const size_t length = strcspn(text, "=");
    uint8_t *out = malloc(length / 4 * 3 + 3);
    uint32_t bits = 0;
    bool good = out && length > 1;
    *size = 0;
    for (size_t i = 0; good && i < length; i++) {
        const char *digit = strchr(digits, text[i]);
        good = digit != NULL;
        bits = bits << 6 | (uint32_t)(good ? digit - digits : 0);
        if (i % 4) { // 4, 2 or 0 bits are left over
            out[(*size)++] = (uint8_t)(bits >> (6 - 2 * (i % 4)));
        }
    }
    if (!good) {
        free(out);
    }
    *bytes = good ? out : NULL;
    return good;
}

static tyn_result read_buffer(const json_doc *doc, const cJSON *buffer, const gltf_buffer *chunk,
                              gltf_buffer *out)
{
    const cJSON *uri = tyn_json_member(buffer, "uri");
    const size_t length = (size_t)tyn_json_whole(buffer, "byteLength", 0);
    if (!uri || !uri->valuestring[0]) {
        *out = (gltf_buffer){chunk->data, length, NULL};
        return length <= chunk->size
                   ? TYN_OK
                   : tyn_json_fault(doc, buffer,
                                    "the file's binary chunk has %zu bytes: byteLength "
                                    "must be at most that",
                                    chunk->size);
    }
    if (strncmp(uri->valuestring, "data:", 5) != 0) {
        TYN_TRY(tyn_uri_read(doc, uri, &out->owned, &out->size, NULL));
    } else if (!tyn_gltf_data_uri(uri->valuestring, &out->owned, &out->size)) {
        return tyn_json_fault(doc, uri, "must be base64 data");
    }
    out->data = out->owned;
    return out->size == length
               ? TYN_OK
               : tyn_json_fault(doc, uri, "has %zu bytes, byteLength is %zu", out->size, length);
}

// ---- nodes ------------------------------------------------------------------------------------

static tyn_result read_node(const json_doc *doc, const cJSON *json, gltf_node *node)
{
    static const char finite[] = "a finite number";
    const cJSON *matrix = tyn_json_member(json, "matrix");
    const cJSON *rotation = tyn_json_member(json, "rotation");
    node->json = json;
    node->parent = -1;
    node->has_matrix = matrix != NULL;
    node->rotation[3] = node->scale[0] = node->scale[1] = node->scale[2] = 1;
    TYN_TRY(tyn_json_numbers(doc, json, "matrix", 16, -1e15, 1e15, finite, node->matrix));
    TYN_TRY(tyn_json_numbers(doc, json, "translation", 3, -1e15, 1e15, finite, node->translation));
    TYN_TRY(tyn_json_numbers(doc, json, "scale", 3, -1e15, 1e15, finite, node->scale));
    TYN_TRY(tyn_json_numbers(doc, json, "rotation", 4, -1.001, 1.001, "-1 to 1", node->rotation));
    const double *q = node->rotation;
    if (fabs(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] - 1.0) > 0.01) {
        return tyn_json_fault(doc, rotation, "must be a unit quaternion x, y, z, w");
    }
    if (matrix &&
        (rotation || tyn_json_member(json, "translation") || tyn_json_member(json, "scale"))) {
        return tyn_json_fault(doc, matrix,
                              "a node has either a matrix or translation, rotation and scale");
    }
    return TYN_OK;
}

// Every node has at most one parent and is its own ancestor nowhere.
static tyn_result find_parents(gltf_node *nodes, int64_t count, const json_doc *doc)
{
    for (int64_t i = 0; i < count; i++) {
        const cJSON *child;
        cJSON_ArrayForEach(child, tyn_json_member(nodes[i].json, "children"))
        {
            gltf_node *node = &nodes[(int64_t)child->valuedouble];
            if (node->parent >= 0) {
                return tyn_json_fault(doc, child, "node %lld has two parents, %lld and %lld",
                                      (long long)(node - nodes), (long long)node->parent,
                                      (long long)i);
            }
            node->parent = i;
        }
    }
    for (int64_t i = 0; i < count; i++) { // upwards, as far as no walk has come
        int64_t k = i;
        for (; k >= 0 && !nodes[k].walk; k = nodes[k].parent) {
            nodes[k].walk = i + 1;
        }
        if (k >= 0 && nodes[k].walk == i + 1) {
            return tyn_json_fault(doc, tyn_json_member(nodes[k].json, "children"),
                                  "nodes form a cycle: node %lld is below itself", (long long)k);
        }
    }
    return TYN_OK;
}

// A scene's nodes are roots, each named once.
static tyn_result check_roots(gltf_model *model, const json_doc *doc)
{
    const json_list *scenes = &model->lists[GLTF_SCENES];
    for (int64_t s = 0; s < scenes->count; s++) {
        const cJSON *root;
        cJSON_ArrayForEach(root, tyn_json_member(scenes->items[s], "nodes"))
        {
            gltf_node *node = &model->nodes[(int64_t)root->valuedouble];
            if (node->parent >= 0 || node->walk == -1 - s) {
                return tyn_json_fault(doc, root, "must be a root node, named once");
            }
            node->walk = -1 - s;
        }
    }
    return TYN_OK;
}

tyn_result tyn_gltf_model_read(gltf_model *model, const json_doc *doc, const gltf_buffer *chunk)
{
    const json_list *nodes = &model->lists[GLTF_NODES], *buffers = &model->lists[GLTF_BUFFERS];
    *model = (gltf_model){0};
    TYN_TRY(tyn_gltf_check(doc, chunk != NULL, model));
    model->nodes = calloc((size_t)nodes->count + 1, sizeof *model->nodes);
    model->buffers = calloc((size_t)buffers->count + 1, sizeof *model->buffers);
    if (!model->nodes || !model->buffers) {
        return tyn_json_no_memory(doc, "nodes and buffers");
    }
    for (int64_t i = 0; i < nodes->count; i++) {
        TYN_TRY(read_node(doc, nodes->items[i], &model->nodes[i]));
    }
    TYN_TRY(find_parents(model->nodes, nodes->count, doc));
    TYN_TRY(check_roots(model, doc));
    for (int64_t i = 0; i < buffers->count; i++) {
        TYN_TRY(read_buffer(doc, buffers->items[i], chunk, &model->buffers[i]));
    }
    return TYN_OK;
}

void tyn_gltf_model_finish(gltf_model *model)
{
    for (int64_t i = 0; model->buffers && i < model->lists[GLTF_BUFFERS].count; i++) {
        free(model->buffers[i].owned);
    }
    for (int k = 0; k < GLTF_NUM_LISTS; k++) {
        free(model->lists[k].items);
    }
    free(model->buffers);
    free(model->views);
    free(model->accessors);
    free(model->nodes);
    *model = (gltf_model){0};
}

void tyn_gltf_note(gltf_note *note, const json_list *list, int64_t index, const char *none)
{
    if (note->count++ > 0) {
        return;
    }
    const cJSON *name = index < list->count ? tyn_json_member(list->items[index], "name") : NULL;
    if (cJSON_IsString(name)) {
        snprintf(note->name, sizeof note->name, "'%s'", name->valuestring);
    } else if (index < list->count) {
        snprintf(note->name, sizeof note->name, "%lld", (long long)index);
    } else {
        snprintf(note->name, sizeof note->name, "%s", none);
    }
}
