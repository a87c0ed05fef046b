// gltf.c -- from a glTF file to a scene: checks, nodes and buffers, then a walk over the nodes.
#include "io/gltf.h"
#include "base/bytes.h"
#include "io/gltf_json.h"
#include <stdlib.h>
#include <string.h>
#include "io/gltf_animation.h"
#include "io/gltf_extensions.h"
#include "io/gltf_instances.h"
#include "io/gltf_light.h"
#include "io/gltf_media.h"
#include "io/gltf_mesh.h"
#include "io/uri.h"
#include "scene/matrix.h"
#include "scene/surfaces.h"

// ---- the container --------------------------------------------------------------------------

// What is often found in place of a file that was to be downloaded.
static tyn_result check_kind(const uint8_t *bytes, size_t size, const char *file,
                             const tyn_log *log)
{
    static const char lfs[] = "version https://git-lfs.github.com/";
    size_t start = size >= 3 && memcmp(bytes, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
    while (start < size && start < 256 && strchr(" \t\r\n", bytes[start]) && bytes[start]) {
        start++;
    }
    const char *is = NULL;
    if (start < size && bytes[start] == '<') {
        is = "a page of HTML or XML, not glTF: download the file itself (on GitHub: \"raw\")";
    } else if (size >= sizeof lfs - 1 && memcmp(bytes, lfs, sizeof lfs - 1) == 0) {
        is = "a pointer of Git LFS, not the file it stands for: 'git lfs pull' fetches it";
    } else if (size >= 2 && memcmp(bytes, "PK", 2) == 0) {
        is = "a zip archive, not glTF: unpack it";
    }
    return is ? TYN_FAULT(log, TYN_ERR_PARAMS, "%s: is %s", file, is) : TYN_OK;
}

// The chunk behind the JSON of a binary file.
static tyn_result find_binary(gltf_container *c, const uint8_t *bytes, uint64_t total,
                              const char *file, const tyn_log *log)
{
    const uint64_t at = 20 + c->json_size;
    if (at == total) {
        return TYN_OK;
    }
    const uint64_t chunk = at + 8 <= total ? tyn_load(bytes + at, 4) : UINT64_MAX;
    if (chunk > total - at - 8 || memcmp(bytes + at + 4, "BIN", 4) != 0) {
        return TYN_FAULT(log, TYN_ERR_PARAMS,
                         "%s: binary glTF: the %llu bytes behind its JSON are no chunk of type BIN",
                         file, (unsigned long long)(total - at));
    }
    c->binary = (gltf_buffer){.data = bytes + at + 8, .size = (size_t)chunk};
    return TYN_OK;
}

tyn_result tyn_gltf_open(gltf_container *out, const uint8_t *bytes, size_t size, const char *file,
                         const tyn_log *log)
{
    TYN_TRY(check_kind(bytes, size, file, log));
    *out = (gltf_container){.json = (const char *)bytes,
                            .json_size = size,
                            .glb = size >= 4 && memcmp(bytes, "glTF", 4) == 0};
    if (size > 0x7fffffff) {
        return TYN_FAULT(log, TYN_ERR_PARAMS, "%s: has %zu bytes, at most 2 GiB are read", file,
                         size);
    }
    if (!out->glb) {
        return TYN_OK;
    }
    if (size < 20 || tyn_load(bytes + 4, 4) != 2) {
        return TYN_FAULT(log, TYN_ERR_PARAMS, "%s: not a binary glTF of version 2", file);
    }
    uint64_t total = tyn_load(bytes + 8, 4), chunk = tyn_load(bytes + 12, 4);
    if (total > size || 20 + chunk > total || memcmp(bytes + 16, "JSON", 4) != 0) {
        return TYN_FAULT(
            log, TYN_ERR_PARAMS,
            "%s: binary glTF of %llu bytes with %llu bytes of JSON, but the file has %zu", file,
            (unsigned long long)total, (unsigned long long)chunk, size);
    }
    out->json = (const char *)bytes + 20;
    out->json_size = (size_t)chunk;
    return find_binary(out, bytes, total, file, log);
}

// ---- the walk -------------------------------------------------------------------------------

typedef struct walk {
    tyn_scene *scene;
    gltf_model *model;
    const json_doc *doc;
    const gltf_media *media;
    gltf_meshes meshes;
} walk;

// NULL: it has none.
static char *name_of(const cJSON *json)
{
    const cJSON *name = tyn_json_member(json, "name");
    return cJSON_IsString(name) && name->valuestring[0] ? strdup(name->valuestring) : NULL;
}

// A number that has been checked; 0 where it is not there.
static double number_of(const cJSON *json, const char *name)
{
    const cJSON *at = tyn_json_member(json, name);
    return at ? at->valuedouble : 0;
}

static tyn_result add_camera(walk *w, const gltf_node *node, int64_t index)
{
    const cJSON *from = w->model->lists[GLTF_CAMERAS].items[index];
    const char *type = tyn_json_member(from, "type")->valuestring;
    const bool orthographic = strcmp(type, "orthographic") == 0;
    const cJSON *lens = tyn_json_member(from, type);
    const double *m = node->to_world, ymag = number_of(lens, "ymag");
    double back[3] = {m[8], m[9], m[10]}, y[3] = {m[4], m[5], m[6]}, right[3], up[3];
    vec_cross(right, y, back);
    if (!vec_normalize(back) || !vec_normalize(right)) {
        return tyn_json_fault(w->doc, node->json, "the camera's node is flat: its axes are lost");
    }
    vec_cross(up, back, right);
    tyn_camera *grown =
        realloc(w->scene->cameras, (w->scene->num_cameras + 1) * sizeof *w->scene->cameras);
    if (!grown) {
        return tyn_json_no_memory(w->doc, "cameras");
    }
    w->scene->cameras = grown;
    // By their place in the file's list, which is how they are asked for, then in the nodes' order.
    uint32_t at = w->scene->num_cameras++;
    for (; at > 0 && grown[at - 1].index > (uint32_t)index; at--) {
        grown[at] = grown[at - 1];
    }
    tyn_camera *camera = &grown[at];
    *camera = (tyn_camera){
        .index = (uint32_t)index,
        .name = name_of(node->json),
        .camera_name = name_of(from),
        .projection = orthographic ? TYN_ORTHOGRAPHIC : TYN_PERSPECTIVE,
        .yfov = (float)number_of(lens, "yfov"),
        .ymag = (float)ymag,
        .aspect =
            (float)(orthographic ? number_of(lens, "xmag") / ymag : number_of(lens, "aspectRatio")),
    };
    for (int a = 0; a < 3; a++) {
        camera->position[a] = (float)m[12 + a];
        camera->right[a] = (float)right[a];
        camera->up[a] = (float)up[a];
        camera->back[a] = (float)back[a];
    }
    return TYN_OK;
}

static tyn_result add_light(walk *w, const gltf_node *node, int64_t index)
{
    const cJSON *from = w->model->lists[GLTF_LIGHTS].items[index];
    const double *m = node->to_world;
    double direction[3] = {-m[8], -m[9], -m[10]};
    if (w->scene->num_lights == TYN_MAX_LIGHTS) {
        return tyn_json_fault(w->doc, node->json, "there may be %d lights", TYN_MAX_LIGHTS);
    }
    if (!vec_normalize(direction)) {
        return tyn_json_fault(w->doc, node->json, "the light's node is flat: its axis is lost");
    }
    tyn_light *light = &w->scene->lights[w->scene->num_lights++];
    TYN_TRY(tyn_gltf_read_light(light, w->doc, from));
    light->name = name_of(node->json);
    light->name = light->name ? light->name : name_of(from);
    for (int a = 0; a < 3; a++) {
        light->position[a] = (float)m[12 + a];
        light->direction[a] = (float)direction[a];
    }
    return TYN_OK;
}

// The node's mesh, or as many of it as EXT_mesh_gpu_instancing says.
static tyn_result add_meshes(walk *w, const gltf_node *node, int64_t mesh)
{
    gltf_instances instances;
    tyn_result r = tyn_gltf_instances_read(&instances, &w->meshes.data, node->json);
    if (!r && !instances.count) {
        w->scene->num_meshes++;
        r = tyn_gltf_mesh_add(&w->meshes, node->json, mesh, node->to_world);
    }
    for (uint32_t i = 0; !r && i < instances.count; i++) {
        double local[16], at[16];
        tyn_gltf_instance_matrix(&instances, i, local);
        mat_mul(at, node->to_world, local);
        w->scene->num_meshes++;
        r = mat_invertible(at) ? tyn_gltf_mesh_add(&w->meshes, node->json, mesh, at) : TYN_OK;
    }
    tyn_gltf_instances_finish(&instances);
    return r;
}

static tyn_result visit(walk *w, gltf_node *node)
{
    double local[16], *m = node->to_world;
    const cJSON *extensions = tyn_json_member(node->json, "extensions");
    const int64_t mesh = tyn_json_whole(node->json, "mesh", -1);
    const int64_t camera = tyn_json_whole(node->json, "camera", -1);
    const int64_t light =
        tyn_json_whole(tyn_json_member(extensions, "KHR_lights_punctual"), "light", -1);
    if (!node->has_matrix) {
        tyn_gltf_trs(local, node->translation, node->rotation, node->scale);
    }
    mat_identity(m);
    mat_mul(m, node->parent < 0 ? m : w->model->nodes[node->parent].to_world,
            node->has_matrix ? node->matrix : local);
    if (m[3] != 0.0 || m[7] != 0.0 || m[11] != 0.0 || m[15] != 1.0) {
        return tyn_json_fault(w->doc, tyn_json_member(node->json, "matrix"),
                              "its last row must be 0, 0, 0, 1");
    }
    TYN_TRY(tyn_gltf_read_shape(w->scene, w->media, w->doc, node->json, m));
    if (mesh >= 0) {
        TYN_TRY(add_meshes(w, node, mesh));
    }
    if (camera >= 0) {
        TYN_TRY(add_camera(w, node, camera));
    }
    return light >= 0 ? add_light(w, node, light) : TYN_OK;
}

// The scene that is shown: the one that the document names, else the first. NULL: it has none, and every root is shown.
static const cJSON *shown_scene(const json_doc *doc, const gltf_model *model)
{
    const json_list *scenes = &model->lists[GLTF_SCENES];
    return scenes->count ? scenes->items[tyn_json_whole(doc->root, "scene", 0)] : NULL;
}

// Puts the nodes of a list on the stack, the first on top.
static void push_all(const cJSON *list, int64_t *stack, int64_t *top)
{
    const cJSON *node;
    const int64_t count = cJSON_GetArraySize(list);
    int64_t i = 0;
    cJSON_ArrayForEach(node, list)
    {
        stack[*top + count - ++i] = (int64_t)node->valuedouble;
    }
    *top += count;
}

// Depth first, children in order; each node is pushed once because nodes form trees.
static tyn_result walk_nodes(walk *w)
{
    const gltf_model *model = w->model;
    const cJSON *shown = shown_scene(w->doc, model);
    const int64_t count = model->lists[GLTF_NODES].count;
    int64_t *stack = calloc((size_t)count + 1, sizeof *stack), top = 0;
    tyn_result r = TYN_OK;
    if (!stack) {
        return tyn_json_no_memory(w->doc, "nodes");
    }
    push_all(tyn_json_member(shown, "nodes"), stack, &top);
    for (int64_t i = count; !shown && i-- > 0;) {
        if (model->nodes[i].parent < 0) {
            stack[top++] = i;
        }
    }
    while (!r && top > 0) {
        gltf_node *node = &model->nodes[stack[--top]];
        r = visit(w, node);
        push_all(tyn_json_member(node->json, "children"), stack, &top);
    }
    free(stack);
    return r;
}

// ---- all together ---------------------------------------------------------------------------

static tyn_result check_scene(const tyn_scene *scene, const json_doc *doc)
{
    tyn_capture capture;
    tyn_capture_init(&capture);
    tyn_result r = tyn_scene_check(scene, &capture.log);
    return r ? tyn_capture_fault(&capture, doc, doc->root, r) : TYN_OK;
}

// KHR_lights_punctual has candela and lux, and exporters write them (Blender's: watts times 683 lm/W). This project's own
// programs, and files that no program signed, have watts.
static void read_generator(tyn_scene *scene, const json_doc *doc)
{
    static const char own[] = "tyndall";
    const cJSON *text = tyn_json_member(tyn_json_member(doc->root, "asset"), "generator");
    if (cJSON_IsString(text) && text->valuestring[0]) {
        scene->generator = strdup(text->valuestring);
        if (strncmp(text->valuestring, own, sizeof own - 1) != 0) {
            tyn_scene_take_lights_as(scene, TYN_LIGHTS_PHOTOMETRIC);
        }
    }
}

static tyn_result build_scene(tyn_scene *scene, gltf_model *model, const json_doc *doc,
                              const char *environment, const tyn_moment *moment)
{
    const cJSON *shown = shown_scene(doc, model);
    gltf_media media;
    tyn_result r = tyn_gltf_read_media(scene, &media, doc);
    if (!r) {
        walk w = {.scene = scene, .model = model, .doc = doc, .media = &media};
        r = tyn_gltf_meshes_open(&w.meshes, doc, model, scene);
        if (!r && moment && moment->timed) {
            r = tyn_gltf_animate(model, moment->seconds, &w.meshes.data, scene);
        } else if (!r) {
            tyn_gltf_warn_of_animations(doc, scene);
        }
        r = r ? r : walk_nodes(&w);
        tyn_gltf_meshes_close(&w.meshes);
        scene->surfaces.hash = tyn_surfaces_hash(&scene->surfaces);
    }
    if (!r && environment) {
        r = tyn_environment_load(&scene->environment, environment, doc->log);
    } else if (!r) {
        r = tyn_gltf_read_environment(scene, doc, shown);
    }
    if (!r) {
        tyn_gltf_warn_unknown(scene, doc);
        tyn_gltf_warn_extensions(scene, doc);
    }
    scene->name = name_of(shown);
    read_generator(scene, doc);
    return r ? r : check_scene(scene, doc);
}

static tyn_result parse(tyn_scene *scene, json_doc *doc, gltf_model *model,
                        const gltf_container *container, const char *environment,
                        const tyn_moment *moment)
{
    TYN_TRY(tyn_json_parse(doc, container->json, container->json_size, doc->file, doc->log));
    doc->frame = moment && moment->numbered ? &moment->frame : NULL;
    TYN_TRY(tyn_gltf_model_read(model, doc, container->glb ? &container->binary : NULL));
    return build_scene(scene, model, doc, environment, moment);
}

tyn_result tyn_gltf_parse(tyn_scene *scene, const void *bytes, size_t size, const char *file,
                          const char *environment, const tyn_moment *moment, const tyn_log *log)
{
    gltf_container container;
    json_doc doc = {.file = file, .log = log};
    gltf_model model = {0};
    TYN_TRY(tyn_gltf_open(&container, bytes, size, file, log));
    const tyn_result r = parse(scene, &doc, &model, &container, environment, moment);
    if (r) {
        tyn_scene_finish(scene);
    }
    tyn_gltf_model_finish(&model);
    tyn_json_finish(&doc);
    return r;
}
