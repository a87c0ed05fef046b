// gltf.c -- from a glTF file to a scene: checks, tinygltf, then a walk over the nodes.
#include "io/gltf.h"
#include "io/gltf_json.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "io/gltf_animation.h"
#include "io/gltf_check.h"
#include "io/gltf_extensions.h"
#include "io/gltf_instances.h"
#include "io/gltf_light.h"
#include "io/gltf_media.h"
#include "io/gltf_mesh.h"
#include "io/gltf_shim.h"
#include "io/uri.h"
#include "scene/matrix.h"
#include "scene/surfaces.h"

// ---- the container --------------------------------------------------------------------------

static uint32_t load_u32(const uint8_t *p)
{
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

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
    if (is) {
        tyn_log_print(log, TYN_LOG_ERROR, "%s: is %s", file, is);
    }
    return is ? TYN_ERR_PARAMS : TYN_OK;
}

tyn_result tyn_gltf_find_json(const uint8_t *bytes, size_t size, const char *file,
                              const char **json, size_t *json_size, bool *glb, const tyn_log *log)
{
    tyn_result other = check_kind(bytes, size, file, log);
    if (other) {
        return other;
    }
    *glb = size >= 4 && memcmp(bytes, "glTF", 4) == 0;
    *json = (const char *)bytes;
    *json_size = size;
    if (size > 0x7fffffff) {
        tyn_log_print(log, TYN_LOG_ERROR, "%s: has %zu bytes, at most 2 GiB are read", file, size);
        return TYN_ERR_PARAMS;
    }
    if (!*glb) {
        return TYN_OK;
    }
    if (size < 20 || load_u32(bytes + 4) != 2) {
        tyn_log_print(log, TYN_LOG_ERROR, "%s: not a binary glTF of version 2", file);
        return TYN_ERR_PARAMS;
    }
    uint64_t total = load_u32(bytes + 8), chunk = load_u32(bytes + 12);
    if (total > size || 20 + chunk > total || memcmp(bytes + 16, "JSON", 4) != 0) {
        tyn_log_print(log, TYN_LOG_ERROR,
                      "%s: binary glTF of %llu bytes with %llu bytes of JSON, but the file has %zu",
                      file, (unsigned long long)total, (unsigned long long)chunk, size);
        return TYN_ERR_PARAMS;
    }
    *json = (const char *)bytes + 20;
    *json_size = (size_t)chunk;
    return TYN_OK;
}

// Paths of the buffers that are files, freed by free_paths.
static tyn_result buffer_files(const json_doc *doc, char ***paths, size_t *count)
{
    const cJSON *buffers = tyn_json_member(doc->root, "buffers"), *buffer;
    const int most = cJSON_GetArraySize(buffers);
    *count = 0;
    *paths = calloc((size_t)most + 1, sizeof **paths);
    if (!*paths) {
        return TYN_ERR_MEMORY;
    }
    cJSON_ArrayForEach(buffer, buffers)
    {
        const cJSON *uri = tyn_json_member(buffer, "uri");
        if (uri && strncmp(uri->valuestring, "data:", 5) != 0) {
            (*paths)[*count] = tyn_uri_path(doc, uri);
            if (!(*paths)[*count]) {
                return TYN_ERR_PARAMS;
            }
            ++*count;
        }
    }
    return TYN_OK;
}

static void free_paths(char **paths, size_t count)
{
    for (size_t i = 0; paths && i < count; i++) {
        free(paths[i]);
    }
    free(paths);
}

// tinygltf drops what it does not like, for instance an index written as 1.0: nothing may be
// missing.
static tyn_result check_model(const gltf_model *model, const json_doc *doc)
{
    const cJSON *node = NULL, *nodes = tyn_json_member(doc->root, "nodes");
    bool whole = (int)model->num_nodes == cJSON_GetArraySize(nodes);
    const gltf_node *read = model->nodes;
    if (whole) {
        cJSON_ArrayForEach(node, nodes)
        {
            if ((int)read->num_children != cJSON_GetArraySize(tyn_json_member(node, "children")) ||
                (read->camera >= 0) != (tyn_json_member(node, "camera") != NULL) ||
                (read->mesh >= 0) != (tyn_json_member(node, "mesh") != NULL)) {
                return tyn_json_fault(doc, node, "indices must be written without a decimal point");
            }
            read++;
        }
        return TYN_OK;
    }
    return tyn_json_fault(doc, doc->root, "nodes are damaged: only %u can be read",
                          model->num_nodes);
}

// ---- the walk -------------------------------------------------------------------------------

typedef struct walk {
    tyn_scene *scene;
    const gltf_model *model;
    const json_doc *doc;
    const gltf_media *media;
    const cJSON **nodes;    // JSON of every node
    double (*to_world)[16]; // of every node
    gltf_meshes meshes;
} walk;

static void local_matrix(double m[16], const gltf_node *node)
{
    if (node->has_matrix) {
        memcpy(m, node->matrix, 16 * sizeof *m);
    } else {
        tyn_gltf_trs(m, node->translation, node->rotation, node->scale);
    }
}

static char *name_or_null(const char *name)
{
    return name[0] ? strdup(name) : NULL;
}

static tyn_result add_camera(walk *w, uint32_t n)
{
    const gltf_camera *from = &w->model->cameras[w->model->nodes[n].camera];
    const double *m = w->to_world[n];
    double back[3] = {m[8], m[9], m[10]}, y[3] = {m[4], m[5], m[6]}, right[3], up[3];
    vec_cross(right, y, back);
    if (!vec_normalize(back) || !vec_normalize(right)) {
        return tyn_json_fault(w->doc, w->nodes[n], "the camera's node is flat: its axes are lost");
    }
    vec_cross(up, back, right);
    tyn_camera *grown =
        realloc(w->scene->cameras, (w->scene->num_cameras + 1) * sizeof *w->scene->cameras);
    if (!grown) {
        tyn_log_print(w->doc->log, TYN_LOG_ERROR, "%s: no memory for its cameras", w->doc->file);
        return TYN_ERR_MEMORY;
    }
    w->scene->cameras = grown;
    // By their place in the file's list, which is how they are asked for, then in the nodes' order.
    uint32_t index = (uint32_t)w->model->nodes[n].camera, at = w->scene->num_cameras++;
    for (; at > 0 && grown[at - 1].index > index; at--) {
        grown[at] = grown[at - 1];
    }
    tyn_camera *camera = &grown[at];
    *camera = (tyn_camera){
        .index = index,
        .name = name_or_null(w->model->nodes[n].name),
        .camera_name = name_or_null(from->name),
        .projection = from->orthographic ? TYN_ORTHOGRAPHIC : TYN_PERSPECTIVE,
        .yfov = from->orthographic ? 0.0f : (float)from->yfov,
        .ymag = from->orthographic ? (float)from->ymag : 0.0f,
        .aspect = (float)(from->orthographic ? from->xmag / from->ymag : from->aspect),
    };
    for (int a = 0; a < 3; a++) {
        camera->position[a] = (float)m[12 + a];
        camera->right[a] = (float)right[a];
        camera->up[a] = (float)up[a];
        camera->back[a] = (float)back[a];
    }
    return TYN_OK;
}

static tyn_result add_light(walk *w, uint32_t n)
{
    const cJSON *extensions = tyn_json_member(w->doc->root, "extensions");
    const cJSON *lights =
        tyn_json_member(tyn_json_member(extensions, "KHR_lights_punctual"), "lights");
    const cJSON *from = cJSON_GetArrayItem(lights, w->model->nodes[n].light);
    const cJSON *name = tyn_json_member(from, "name");
    const double *m = w->to_world[n];
    double direction[3] = {-m[8], -m[9], -m[10]};
    if (w->scene->num_lights == TYN_MAX_LIGHTS) {
        return tyn_json_fault(w->doc, w->nodes[n], "there may be %d lights", TYN_MAX_LIGHTS);
    }
    if (!vec_normalize(direction)) {
        return tyn_json_fault(w->doc, w->nodes[n], "the light's node is flat: its axis is lost");
    }
    tyn_light *light = &w->scene->lights[w->scene->num_lights++];
    TYN_TRY(tyn_gltf_read_light(light, w->doc, from));
    light->name = name_or_null(w->model->nodes[n].name[0] ? w->model->nodes[n].name
                               : cJSON_IsString(name)     ? name->valuestring
                                                          : "");
    for (int a = 0; a < 3; a++) {
        light->position[a] = (float)m[12 + a];
        light->direction[a] = (float)direction[a];
    }
    return TYN_OK;
}

// The node's mesh, or as many of it as EXT_mesh_gpu_instancing says.
static tyn_result add_meshes(walk *w, uint32_t n, const double m[16])
{
    const gltf_node *node = &w->model->nodes[n];
    gltf_instances instances;
    tyn_result r = tyn_gltf_instances_read(&instances, &w->meshes.data, w->nodes[n]);
    if (!r && !instances.count) {
        w->scene->num_meshes++;
        r = tyn_gltf_mesh_add(&w->meshes, w->nodes[n], node->mesh, m);
    }
    for (uint32_t i = 0; !r && i < instances.count; i++) {
        double local[16], at[16];
        tyn_gltf_instance_matrix(&instances, i, local);
        mat_mul(at, m, local);
        w->scene->num_meshes++;
        r = mat_invertible(at) ? tyn_gltf_mesh_add(&w->meshes, w->nodes[n], node->mesh, at)
                               : TYN_OK;
    }
    tyn_gltf_instances_finish(&instances);
    return r;
}

static tyn_result visit(walk *w, uint32_t n, const double parent[16])
{
    const gltf_node *node = &w->model->nodes[n];
    double local[16];
    local_matrix(local, node);
    mat_mul(w->to_world[n], parent, local);
    const double *m = w->to_world[n];
    if (m[3] != 0.0 || m[7] != 0.0 || m[11] != 0.0 || m[15] != 1.0) {
        return tyn_json_fault(w->doc, tyn_json_member(w->nodes[n], "matrix"),
                              "its last row must be 0, 0, 0, 1");
    }
    tyn_result r = tyn_gltf_read_shape(w->scene, w->media, w->doc, w->nodes[n], m);
    if (!r && node->mesh >= 0) {
        r = add_meshes(w, n, m);
    }
    if (!r && node->camera >= 0) {
        r = add_camera(w, n);
    }
    if (!r && node->light >= 0) {
        r = add_light(w, n);
    }
    return r;
}

static tyn_result walk_nodes(walk *w)
{
    const gltf_model *model = w->model;
    const cJSON *node;
    uint32_t *stack = calloc((size_t)model->num_nodes + 1, sizeof *stack), top = 0, i = 0;
    uint32_t *parents = calloc((size_t)model->num_nodes + 1, sizeof *parents);
    double identity[16];
    tyn_result r = TYN_OK;
    w->nodes = calloc((size_t)model->num_nodes + 1, sizeof *w->nodes);
    w->to_world = calloc((size_t)model->num_nodes + 1, sizeof *w->to_world);
    if (!stack || !parents || !w->nodes || !w->to_world) {
        tyn_log_print(w->doc->log, TYN_LOG_ERROR, "%s: no memory for its nodes", w->doc->file);
        r = TYN_ERR_MEMORY;
        goto done;
    }
    cJSON_ArrayForEach(node, tyn_json_member(w->doc->root, "nodes"))
    {
        w->nodes[i++] = node;
    }
    // Depth first, children in order; each node is pushed once because nodes form trees.
    mat_identity(identity);
    for (i = model->num_roots; i-- > 0;) {
        parents[model->roots[i]] = UINT32_MAX;
        stack[top++] = model->roots[i];
    }
    while (!r && top > 0) {
        uint32_t n = stack[--top];
        r = visit(w, n, parents[n] == UINT32_MAX ? identity : w->to_world[parents[n]]);
        for (i = model->nodes[n].num_children; i-- > 0;) {
            parents[model->nodes[n].children[i]] = n;
            stack[top++] = model->nodes[n].children[i];
        }
    }
done:
    free(stack);
    free(parents);
    free(w->nodes);
    free(w->to_world);
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

static tyn_result build_scene(tyn_scene *scene, const gltf_model *model, const json_doc *doc,
                              const char *environment, const tyn_moment *moment)
{
    gltf_media media;
    tyn_result r = tyn_gltf_read_media(scene, &media, doc);
    if (!r) {
        walk w = {.scene = scene, .model = model, .doc = doc, .media = &media};
        r = tyn_gltf_meshes_open(&w.meshes, doc, model, scene);
        if (!r && moment && moment->timed) {
            r = tyn_gltf_animate(model->nodes, model->num_nodes, moment->seconds, &w.meshes.data,
                                 scene);
        } else if (!r) {
            tyn_gltf_warn_of_animations(doc, scene);
        }
        r = r ? r : walk_nodes(&w);
        tyn_gltf_meshes_close(&w.meshes);
        scene->surfaces.hash = tyn_surfaces_hash(&scene->surfaces);
    }
    if (!r && environment) {
        r = tyn_environment_load(&scene->environment, environment, doc->log);
    } else if (!r && model->scene >= 0) {
        const cJSON *scenes = tyn_json_member(doc->root, "scenes");
        r = tyn_gltf_read_environment(scene, doc, cJSON_GetArrayItem(scenes, model->scene));
    }
    if (!r) {
        tyn_gltf_warn_unknown(scene, doc);
        tyn_gltf_warn_extensions(scene, doc);
    }
    scene->name = name_or_null(model->scene_name);
    read_generator(scene, doc);
    return r ? r : check_scene(scene, doc);
}

tyn_result tyn_gltf_parse(tyn_scene *scene, const void *bytes, size_t size, const char *file,
                          const char *environment, const tyn_moment *moment, const tyn_log *log)
{
    const char *text;
    size_t text_size;
    bool glb;
    json_doc doc = {0};
    gltf_model model = {0};
    char *directory = tyn_path_directory(file);
    tyn_result r = tyn_gltf_find_json(bytes, size, file, &text, &text_size, &glb, log);
    if (!r) {
        r = tyn_json_parse(&doc, text, text_size, file, log);
        doc.frame = moment && moment->numbered ? &moment->frame : NULL;
    }
    if (!r) {
        r = tyn_gltf_check(&doc, glb);
    }
    if (!r) {
        gltf_source source = {bytes, size, glb, NULL, 0, directory, file};
        char **paths = NULL;
        r = directory ? buffer_files(&doc, &paths, &source.num_buffer_files) : TYN_ERR_MEMORY;
        source.buffer_files = paths;
        r = r ? r : gltf_model_read(&model, &source, log);
        free_paths(paths, source.num_buffer_files);
    }
    if (!r) {
        r = check_model(&model, &doc);
    }
    if (!r) {
        r = build_scene(scene, &model, &doc, environment, moment);
    }
    if (r) {
        tyn_scene_finish(scene);
    }
    gltf_model_finish(&model);
    tyn_json_finish(&doc);
    free(directory);
    return r;
}
