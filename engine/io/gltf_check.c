// gltf_check.c -- checks a glTF document, field by field.
#include "io/gltf_check.h"
#include "io/gltf_extensions.h"
#include "io/gltf_light.h"
#include <stdlib.h>
#include <string.h>

#define MAX_INT 2147483647

typedef struct checker {
    const json_doc *doc;
    bool glb;
    json_list buffers, buffer_views, accessors, materials, meshes, cameras, nodes, scenes, lights;
    json_list images, samplers, textures;
} checker;

static tyn_result check_index(const checker *c, const cJSON *parent, const char *name,
                              const json_list *of, const char *what)
{
    const cJSON *at = tyn_json_member(parent, name);
    int64_t unused;
    return at ? tyn_json_index(c->doc, at, of->count, what, &unused) : TYN_OK;
}

// Every element of an array of indices.
static tyn_result check_indices(const checker *c, const cJSON *parent, const char *name,
                                const json_list *of, const char *what)
{
    cJSON *array;
    const cJSON *element;
    int64_t unused;
    TYN_TRY(tyn_json_array(c->doc, parent, name, &array));
    cJSON_ArrayForEach(element, array)
    {
        TYN_TRY(tyn_json_index(c->doc, element, of->count, what, &unused));
    }
    return TYN_OK;
}

static tyn_result check_asset(const checker *c)
{
    cJSON *asset;
    const char *version = NULL;
    TYN_TRY(tyn_json_object(c->doc, c->doc->root, "asset", &asset));
    TYN_TRY(tyn_json_string(c->doc, asset, "version", &version));
    if (!version || strncmp(version, "2.", 2) != 0) {
        return tyn_json_fault(c->doc, asset ? asset : c->doc->root,
                              "asset.version must be \"2.0\": only glTF 2 is read");
    }
    return TYN_OK;
}

static tyn_result check_buffer(const checker *c, int64_t i)
{
    const cJSON *buffer = c->buffers.items[i];
    int64_t bytes = 0;
    const char *uri = NULL;
    TYN_TRY(tyn_json_integer(c->doc, buffer, "byteLength", 1, MAX_INT, "1 to 2147483647 bytes",
                             &bytes));
    TYN_TRY(tyn_json_string(c->doc, buffer, "uri", &uri));
    if (!bytes) {
        return tyn_json_fault(c->doc, buffer, "byteLength is missing");
    }
    if ((!uri || !*uri) && !(c->glb && i == 0)) {
        return tyn_json_fault(c->doc, buffer,
                              "uri is missing: only the first buffer of a .glb needs none");
    }
    return TYN_OK;
}

static tyn_result check_buffer_view(const checker *c, const cJSON *view)
{
    int64_t offset = 0, length = 0, total = 0, stride = 0, buffer = -1;
    const cJSON *index = tyn_json_member(view, "buffer");
    if (!index) {
        return tyn_json_fault(c->doc, view, "buffer is missing");
    }
    TYN_TRY(tyn_json_index(c->doc, index, c->buffers.count, "buffers", &buffer));
    TYN_TRY(tyn_json_integer(c->doc, view, "byteOffset", 0, MAX_INT, "an offset >= 0", &offset));
    TYN_TRY(
        tyn_json_integer(c->doc, view, "byteLength", 1, MAX_INT, "1 to 2147483647 bytes", &length));
    TYN_TRY(tyn_json_integer(c->doc, view, "byteStride", 4, 252, "4 to 252 bytes", &stride));
    TYN_TRY(
        tyn_json_integer(c->doc, c->buffers.items[buffer], "byteLength", 1, MAX_INT, "", &total));
    if (!length) {
        return tyn_json_fault(c->doc, view, "byteLength is missing");
    }
    if (offset + length > total) {
        return tyn_json_fault(c->doc, tyn_json_member(view, "byteLength"),
                              "reaches byte %lld, its buffer ends at %lld",
                              (long long)(offset + length), (long long)total);
    }
    return TYN_OK;
}

static int64_t component_bytes(int64_t type)
{
    return type == 5120 || type == 5121   ? 1
           : type == 5122 || type == 5123 ? 2
           : type == 5125 || type == 5126 ? 4
                                          : 0;
}

// `count` elements of `bytes` each, from byteOffset of `at` on, inside the view that `at` names.
static tyn_result check_extent(const checker *c, const cJSON *at, int64_t count, int64_t bytes)
{
    const cJSON *index = tyn_json_member(at, "bufferView");
    int64_t view = 0, offset = 0, length = 0, stride = bytes;
    if (!index) {
        return TYN_OK;
    }
    TYN_TRY(tyn_json_index(c->doc, index, c->buffer_views.count, "bufferViews", &view));
    TYN_TRY(tyn_json_integer(c->doc, at, "byteOffset", 0, MAX_INT, "an offset >= 0", &offset));
    const cJSON *v = c->buffer_views.items[view];
    TYN_TRY(tyn_json_integer(c->doc, v, "byteLength", 1, MAX_INT, "", &length));
    TYN_TRY(tyn_json_integer(c->doc, v, "byteStride", 4, 252, "4 to 252 bytes", &stride));
    if (offset + stride * (count - 1) + bytes > length) {
        return tyn_json_fault(c->doc, at, "reaches byte %lld, its bufferView ends at %lld",
                              (long long)(offset + stride * (count - 1) + bytes),
                              (long long)length);
    }
    return TYN_OK;
}

static tyn_result check_sparse(const checker *c, const cJSON *accessor, int64_t bytes)
{
    cJSON *sparse, *indices, *values;
    int64_t count = 0, type = 0;
    TYN_TRY(tyn_json_object(c->doc, accessor, "sparse", &sparse));
    if (!sparse) {
        return TYN_OK;
    }
    TYN_TRY(tyn_json_integer(c->doc, sparse, "count", 1, MAX_INT, "a count >= 1", &count));
    TYN_TRY(tyn_json_object(c->doc, sparse, "indices", &indices));
    TYN_TRY(tyn_json_object(c->doc, sparse, "values", &values));
    if (!count || !indices || !values || !tyn_json_member(indices, "bufferView") ||
        !tyn_json_member(values, "bufferView")) {
        return tyn_json_fault(c->doc, sparse, "needs count, indices and values with bufferViews");
    }
    TYN_TRY(tyn_json_integer(c->doc, indices, "componentType", 5121, 5125, "5121, 5123 or 5125",
                             &type));
    if (type != 5121 && type != 5123 && type != 5125) {
        return tyn_json_fault(c->doc, indices, "componentType must be 5121, 5123 or 5125");
    }
    TYN_TRY(check_extent(c, indices, count, component_bytes(type)));
    return check_extent(c, values, count, bytes);
}

static tyn_result check_accessor(const checker *c, const cJSON *accessor)
{
    static const struct {
        const char *name;
        int columns, rows;
    } types[] = {{"SCALAR", 1, 1}, {"VEC2", 1, 2}, {"VEC3", 1, 3}, {"VEC4", 1, 4},
                 {"MAT2", 2, 2},   {"MAT3", 3, 3}, {"MAT4", 4, 4}};
    int64_t count = 0, component = 0, bytes = 0;
    const char *type = "";
    TYN_TRY(tyn_json_integer(c->doc, accessor, "count", 1, MAX_INT, "a count >= 1", &count));
    TYN_TRY(tyn_json_integer(c->doc, accessor, "componentType", 5120, 5126, "5120 to 5126 but 5124",
                             &component));
    TYN_TRY(tyn_json_string(c->doc, accessor, "type", &type));
    for (size_t i = 0; i < sizeof types / sizeof types[0]; i++) {
        if (strcmp(type, types[i].name) == 0) {
            int64_t column = types[i].rows * component_bytes(component);
            // Columns of matrices start at multiples of four bytes.
            bytes = types[i].columns == 1 ? column : types[i].columns * ((column + 3) / 4 * 4);
        }
    }
    if (!count || !bytes) {
        return tyn_json_fault(c->doc, accessor, "needs count, componentType and type");
    }
    TYN_TRY(check_extent(c, accessor, count, bytes));
    return check_sparse(c, accessor, bytes);
}

static tyn_result check_image(const checker *c, const cJSON *image)
{
    const char *uri = NULL;
    TYN_TRY(tyn_json_string(c->doc, image, "uri", &uri));
    TYN_TRY(check_index(c, image, "bufferView", &c->buffer_views, "bufferViews"));
    if ((uri && *uri) == (tyn_json_member(image, "bufferView") != NULL)) {
        return tyn_json_fault(c->doc, image, "needs either a uri or a bufferView");
    }
    return TYN_OK;
}

static tyn_result check_sampler(const checker *c, const cJSON *sampler)
{
    static const char *const names[] = {"wrapS", "wrapT"};
    for (int i = 0; i < 2; i++) {
        int64_t mode = 10497;
        const char *right = "10497 (repeat), 33071 (clamp) or 33648 (mirror)";
        TYN_TRY(tyn_json_integer(c->doc, sampler, names[i], 0, 65535, right, &mode));
        if (mode != 10497 && mode != 33071 && mode != 33648) {
            return tyn_json_fault(c->doc, tyn_json_member(sampler, names[i]), "must be %s", right);
        }
    }
    return TYN_OK;
}

static tyn_result check_texture(const checker *c, const cJSON *texture)
{
    TYN_TRY(check_index(c, texture, "sampler", &c->samplers, "samplers"));
    return check_index(c, texture, "source", &c->images, "images");
}

static tyn_result check_texture_info(const checker *c, const cJSON *parent, const char *name)
{
    cJSON *info;
    TYN_TRY(tyn_json_object(c->doc, parent, name, &info));
    if (info && !tyn_json_member(info, "index")) {
        return tyn_json_fault(c->doc, info, "index is missing: an index of textures");
    }
    return info ? check_index(c, info, "index", &c->textures, "textures") : TYN_OK;
}

static tyn_result check_material(const checker *c, const cJSON *material)
{
    cJSON *pbr, *extensions, *gloss;
    TYN_TRY(tyn_json_object(c->doc, material, "extensions", &extensions));
    TYN_TRY(tyn_json_object(c->doc, extensions, "KHR_materials_pbrSpecularGlossiness", &gloss));
    TYN_TRY(check_texture_info(c, gloss, "diffuseTexture"));
    TYN_TRY(tyn_json_object(c->doc, material, "pbrMetallicRoughness", &pbr));
    TYN_TRY(check_texture_info(c, pbr, "baseColorTexture"));
    TYN_TRY(check_texture_info(c, pbr, "metallicRoughnessTexture"));
    TYN_TRY(check_texture_info(c, material, "normalTexture"));
    TYN_TRY(check_texture_info(c, material, "occlusionTexture"));
    return check_texture_info(c, material, "emissiveTexture");
}

static tyn_result check_mesh(const checker *c, const cJSON *mesh)
{
    json_list primitives = {0};
    tyn_result r = tyn_json_list(c->doc, mesh, "primitives", &primitives);
    for (int64_t i = 0; !r && i < primitives.count; i++) {
        const cJSON *p = primitives.items[i], *element;
        cJSON *attributes;
        int64_t unused;
        r = check_index(c, p, "indices", &c->accessors, "accessors");
        r = r ? r : check_index(c, p, "material", &c->materials, "materials");
        r = r ? r : tyn_json_object(c->doc, p, "attributes", &attributes);
        if (!r && attributes) {
            cJSON_ArrayForEach(element, attributes)
            {
                r = r ? r
                      : tyn_json_index(c->doc, element, c->accessors.count, "accessors", &unused);
            }
        }
        json_list targets = {0};
        r = r ? r : tyn_json_list(c->doc, p, "targets", &targets);
        for (int64_t t = 0; !r && t < targets.count; t++) {
            cJSON_ArrayForEach(element, targets.items[t])
            {
                r = r ? r
                      : tyn_json_index(c->doc, element, c->accessors.count, "accessors", &unused);
            }
        }
        free(targets.items);
    }
    free(primitives.items);
    return r;
}

static tyn_result check_camera(const checker *c, const cJSON *camera)
{
    static const char *const required[2][5] = {{"yfov", "znear"},
                                               {"xmag", "ymag", "zfar", "znear"}};
    const char *type = "";
    cJSON *lens;
    double unused;
    TYN_TRY(tyn_json_string(c->doc, camera, "type", &type));
    bool perspective = strcmp(type, "perspective") == 0;
    if (!perspective && strcmp(type, "orthographic") != 0) {
        return tyn_json_fault(c->doc, camera, "type must be \"perspective\" or \"orthographic\"");
    }
    TYN_TRY(tyn_json_object(c->doc, camera, type, &lens));
    if (!lens) {
        return tyn_json_fault(c->doc, camera, "%s is missing: an object with its lens", type);
    }
    for (const char *const *name = required[!perspective]; *name; name++) {
        if (!tyn_json_member(lens, *name)) {
            return tyn_json_fault(c->doc, lens, "%s is missing", *name);
        }
    }
    if (perspective) {
        TYN_TRY(tyn_json_number(c->doc, lens, "yfov", 1e-4, 3.1415, "between 0 and pi radians",
                                &unused));
        return tyn_json_number(c->doc, lens, "aspectRatio", 1e-6, 1e6, "> 0", &unused);
    }
    TYN_TRY(tyn_json_number(c->doc, lens, "ymag", 1e-30, 1e30, "> 0, metres", &unused));
    return tyn_json_number(c->doc, lens, "xmag", 1e-30, 1e30, "> 0, metres", &unused);
}

static tyn_result check_node(const checker *c, const cJSON *node)
{
    cJSON *extensions, *lights;
    const char *name;
    TYN_TRY(tyn_json_string(c->doc, node, "name", &name));
    TYN_TRY(check_index(c, node, "camera", &c->cameras, "cameras"));
    TYN_TRY(check_index(c, node, "mesh", &c->meshes, "meshes"));
    TYN_TRY(check_indices(c, node, "children", &c->nodes, "nodes"));
    TYN_TRY(tyn_json_object(c->doc, node, "extensions", &extensions));
    TYN_TRY(tyn_json_object(c->doc, extensions, "KHR_lights_punctual", &lights));
    return check_index(c, lights, "light", &c->lights, "lights");
}

// Every node has at most one parent and is its own ancestor nowhere.
static tyn_result check_trees(const checker *c, int64_t *parent, uint8_t *state)
{
    for (int64_t i = 0; i < c->nodes.count; i++) {
        parent[i] = -1;
    }
    for (int64_t i = 0; i < c->nodes.count; i++) {
        const cJSON *child;
        cJSON_ArrayForEach(child, tyn_json_member(c->nodes.items[i], "children"))
        {
            int64_t k = (int64_t)child->valuedouble;
            if (parent[k] >= 0) {
                return tyn_json_fault(c->doc, child, "node %lld has two parents, %lld and %lld",
                                      (long long)k, (long long)parent[k], (long long)i);
            }
            parent[k] = i;
        }
    }
    // Walk upwards; 1 = on this walk, 2 = known to end at a root.
    for (int64_t i = 0; i < c->nodes.count; i++) {
        int64_t k = i;
        for (; k >= 0 && !state[k]; k = parent[k]) {
            state[k] = 1;
        }
        if (k >= 0 && state[k] == 1) {
            return tyn_json_fault(c->doc, tyn_json_member(c->nodes.items[k], "children"),
                                  "nodes form a cycle: node %lld is below itself", (long long)k);
        }
        for (k = i; k >= 0 && state[k] == 1; k = parent[k]) {
            state[k] = 2;
        }
    }
    for (int64_t s = 0; s < c->scenes.count; s++) {
        const cJSON *root;
        TYN_TRY(check_indices(c, c->scenes.items[s], "nodes", &c->nodes, "nodes"));
        memset(state, 0, (size_t)c->nodes.count);
        cJSON_ArrayForEach(root, tyn_json_member(c->scenes.items[s], "nodes"))
        {
            int64_t k = (int64_t)root->valuedouble;
            if (parent[k] >= 0 || state[k]) {
                return tyn_json_fault(c->doc, root, "must be a root node, named once");
            }
            state[k] = 1;
        }
    }
    return TYN_OK;
}

static tyn_result check_nodes(const checker *c)
{
    for (int64_t i = 0; i < c->nodes.count; i++) {
        TYN_TRY(check_node(c, c->nodes.items[i]));
    }
    size_t count = (size_t)c->nodes.count + 1;
    int64_t *parent = calloc(count, sizeof *parent);
    uint8_t *state = calloc(count, 1);
    tyn_result r = TYN_ERR_MEMORY;
    if (parent && state) {
        r = check_trees(c, parent, state);
    } else {
        tyn_log_print(c->doc->log, TYN_LOG_ERROR, "%s: no memory for its nodes", c->doc->file);
    }
    free(parent);
    free(state);
    return r;
}

static tyn_result check_all(checker *c)
{
    const json_doc *doc = c->doc;
    cJSON *extensions, *lights;
    TYN_TRY(check_asset(c));
    TYN_TRY(tyn_gltf_check_required(doc));
    TYN_TRY(tyn_json_list(doc, doc->root, "buffers", &c->buffers));
    TYN_TRY(tyn_json_list(doc, doc->root, "bufferViews", &c->buffer_views));
    TYN_TRY(tyn_json_list(doc, doc->root, "accessors", &c->accessors));
    TYN_TRY(tyn_json_list(doc, doc->root, "images", &c->images));
    TYN_TRY(tyn_json_list(doc, doc->root, "samplers", &c->samplers));
    TYN_TRY(tyn_json_list(doc, doc->root, "textures", &c->textures));
    TYN_TRY(tyn_json_list(doc, doc->root, "materials", &c->materials));
    TYN_TRY(tyn_json_list(doc, doc->root, "meshes", &c->meshes));
    TYN_TRY(tyn_json_list(doc, doc->root, "cameras", &c->cameras));
    TYN_TRY(tyn_json_list(doc, doc->root, "nodes", &c->nodes));
    TYN_TRY(tyn_json_list(doc, doc->root, "scenes", &c->scenes));
    TYN_TRY(tyn_json_object(doc, doc->root, "extensions", &extensions));
    TYN_TRY(tyn_json_object(doc, extensions, "KHR_lights_punctual", &lights));
    TYN_TRY(tyn_json_list(doc, lights, "lights", &c->lights));
    for (int64_t i = 0; i < c->buffers.count; i++) {
        TYN_TRY(check_buffer(c, i));
    }
    for (int64_t i = 0; i < c->buffer_views.count; i++) {
        TYN_TRY(check_buffer_view(c, c->buffer_views.items[i]));
    }
    for (int64_t i = 0; i < c->accessors.count; i++) {
        TYN_TRY(check_accessor(c, c->accessors.items[i]));
    }
    for (int64_t i = 0; i < c->images.count; i++) {
        TYN_TRY(check_image(c, c->images.items[i]));
    }
    for (int64_t i = 0; i < c->samplers.count; i++) {
        TYN_TRY(check_sampler(c, c->samplers.items[i]));
    }
    for (int64_t i = 0; i < c->textures.count; i++) {
        TYN_TRY(check_texture(c, c->textures.items[i]));
    }
    for (int64_t i = 0; i < c->materials.count; i++) {
        TYN_TRY(check_material(c, c->materials.items[i]));
    }
    for (int64_t i = 0; i < c->meshes.count; i++) {
        TYN_TRY(check_mesh(c, c->meshes.items[i]));
    }
    for (int64_t i = 0; i < c->cameras.count; i++) {
        TYN_TRY(check_camera(c, c->cameras.items[i]));
    }
    for (int64_t i = 0; i < c->lights.count; i++) {
        tyn_light unused;
        TYN_TRY(tyn_gltf_read_light(&unused, c->doc, c->lights.items[i]));
    }
    TYN_TRY(check_index(c, doc->root, "scene", &c->scenes, "scenes"));
    return check_nodes(c);
}

tyn_result tyn_gltf_check(const json_doc *doc, bool glb)
{
    checker c = {.doc = doc, .glb = glb};
    tyn_result r = check_all(&c);
    const json_list *lists[] = {&c.buffers, &c.buffer_views, &c.accessors, &c.materials,
                                &c.meshes,  &c.cameras,      &c.nodes,     &c.scenes,
                                &c.lights,  &c.images,       &c.samplers,  &c.textures};
    for (size_t i = 0; i < sizeof lists / sizeof lists[0]; i++) {
        free(lists[i]->items);
    }
    return r;
}
