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
    const json_list *lists; // the model's, by gltf_kind
    gltf_model *model;
    int64_t index; // of what is checked, in its list
} checker;

static tyn_result check_index(const checker *c, const cJSON *parent, const char *name, gltf_kind of)
{
    const cJSON *at = tyn_json_member(parent, name);
    int64_t unused;
    return at ? tyn_json_index(c->doc, at, c->lists[of].count, tyn_gltf_lists[of], &unused)
              : TYN_OK;
}

// Every element of an array of indices.
static tyn_result check_indices(const checker *c, const cJSON *parent, const char *name,
                                gltf_kind of)
{
    cJSON *array;
    const cJSON *element;
    int64_t unused;
    TYN_TRY(tyn_json_array(c->doc, parent, name, &array));
    cJSON_ArrayForEach(element, array)
    {
        TYN_TRY(tyn_json_index(c->doc, element, c->lists[of].count, tyn_gltf_lists[of], &unused));
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

static tyn_result check_buffer(const checker *c, const cJSON *buffer)
{
    int64_t bytes = 0;
    const char *uri = NULL;
    TYN_TRY(tyn_json_integer(c->doc, buffer, "byteLength", 1, MAX_INT, "1 to 2147483647 bytes",
                             &bytes));
    TYN_TRY(tyn_json_string(c->doc, buffer, "uri", &uri));
    if (!bytes) {
        return tyn_json_fault(c->doc, buffer, "byteLength is missing");
    }
    if ((!uri || !*uri) && !(c->glb && c->index == 0)) {
        return tyn_json_fault(c->doc, buffer,
                              "uri is missing: only the first buffer of a .glb needs none");
    }
    return TYN_OK;
}

static tyn_result check_buffer_view(const checker *c, const cJSON *view)
{
    gltf_view *v = &c->model->views[c->index];
    const cJSON *index = tyn_json_member(view, "buffer");
    if (!index) {
        return tyn_json_fault(c->doc, view, "buffer is missing");
    }
    TYN_TRY(tyn_json_index(c->doc, index, c->lists[GLTF_BUFFERS].count, "buffers", &v->buffer));
    TYN_TRY(tyn_json_integer(c->doc, view, "byteOffset", 0, MAX_INT, "an offset >= 0", &v->offset));
    TYN_TRY(tyn_json_integer(c->doc, view, "byteLength", 1, MAX_INT, "1 to 2147483647 bytes",
                             &v->length));
    TYN_TRY(tyn_json_integer(c->doc, view, "byteStride", 4, 252, "4 to 252 bytes", &v->stride));
    const int64_t total = tyn_json_whole(c->lists[GLTF_BUFFERS].items[v->buffer], "byteLength", 0);
    if (!v->length) {
        return tyn_json_fault(c->doc, view, "byteLength is missing");
    }
    if (v->offset + v->length > total) {
        return tyn_json_fault(c->doc, tyn_json_member(view, "byteLength"),
                              "reaches byte %lld, its buffer ends at %lld",
                              (long long)(v->offset + v->length), (long long)total);
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
static tyn_result check_extent(const checker *c, const cJSON *at, int64_t count, int64_t bytes,
                               gltf_elements *out)
{
    const cJSON *index = tyn_json_member(at, "bufferView");
    *out = (gltf_elements){-1, 0, bytes};
    if (!index) {
        return TYN_OK;
    }
    TYN_TRY(tyn_json_index(c->doc, index, c->lists[GLTF_BUFFER_VIEWS].count, "bufferViews",
                           &out->view));
    TYN_TRY(tyn_json_integer(c->doc, at, "byteOffset", 0, MAX_INT, "an offset >= 0", &out->offset));
    const gltf_view *view = &c->model->views[out->view];
    out->stride = view->stride ? view->stride : bytes;
    const int64_t end = out->offset + out->stride * (count - 1) + bytes;
    return end <= view->length
               ? TYN_OK
               : tyn_json_fault(c->doc, at, "reaches byte %lld, its bufferView ends at %lld",
                                (long long)end, (long long)view->length);
}

static tyn_result check_sparse(const checker *c, const cJSON *accessor, int64_t bytes,
                               gltf_accessor *a)
{
    cJSON *sparse, *indices, *values;
    TYN_TRY(tyn_json_object(c->doc, accessor, "sparse", &sparse));
    if (!sparse) {
        return TYN_OK;
    }
    TYN_TRY(tyn_json_integer(c->doc, sparse, "count", 1, MAX_INT, "a count >= 1", &a->num_sparse));
    TYN_TRY(tyn_json_object(c->doc, sparse, "indices", &indices));
    TYN_TRY(tyn_json_object(c->doc, sparse, "values", &values));
    if (!a->num_sparse || !indices || !values || !tyn_json_member(indices, "bufferView") ||
        !tyn_json_member(values, "bufferView")) {
        return tyn_json_fault(c->doc, sparse, "needs count, indices and values with bufferViews");
    }
    TYN_TRY(tyn_json_integer(c->doc, indices, "componentType", 5121, 5125, "5121, 5123 or 5125",
                             &a->index_type));
    if (a->index_type != 5121 && a->index_type != 5123 && a->index_type != 5125) {
        return tyn_json_fault(c->doc, indices, "componentType must be 5121, 5123 or 5125");
    }
    TYN_TRY(check_extent(c, indices, a->num_sparse, component_bytes(a->index_type), &a->indices));
    return check_extent(c, values, a->num_sparse, bytes, &a->values);
}

static tyn_result check_accessor(const checker *c, const cJSON *accessor)
{
    static const struct {
        const char *name;
        uint32_t columns, rows;
    } types[] = {{"SCALAR", 1, 1}, {"VEC2", 1, 2}, {"VEC3", 1, 3}, {"VEC4", 1, 4},
                 {"MAT2", 2, 2},   {"MAT3", 3, 3}, {"MAT4", 4, 4}};
    gltf_accessor *a = &c->model->accessors[c->index];
    int64_t bytes = 0;
    const char *type = "";
    TYN_TRY(tyn_json_integer(c->doc, accessor, "count", 1, MAX_INT, "a count >= 1", &a->count));
    TYN_TRY(tyn_json_integer(c->doc, accessor, "componentType", 5120, 5126, "5120 to 5126 but 5124",
                             &a->type));
    TYN_TRY(tyn_json_string(c->doc, accessor, "type", &type));
    for (size_t i = 0; i < sizeof types / sizeof types[0]; i++) {
        if (strcmp(type, types[i].name) == 0) {
            int64_t column = types[i].rows * component_bytes(a->type);
            // Columns of matrices start at multiples of four bytes.
            bytes = types[i].columns == 1 ? column : types[i].columns * ((column + 3) / 4 * 4);
            a->components = types[i].columns == 1 ? types[i].rows : 0;
        }
    }
    if (!a->count || !bytes) {
        return tyn_json_fault(c->doc, accessor, "needs count, componentType and type");
    }
    a->normalized = cJSON_IsTrue(tyn_json_member(accessor, "normalized"));
    TYN_TRY(check_extent(c, accessor, a->count, bytes, &a->elements));
    return check_sparse(c, accessor, bytes, a);
}

static tyn_result check_image(const checker *c, const cJSON *image)
{
    const char *uri = NULL;
    TYN_TRY(tyn_json_string(c->doc, image, "uri", &uri));
    TYN_TRY(check_index(c, image, "bufferView", GLTF_BUFFER_VIEWS));
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
    TYN_TRY(check_index(c, texture, "sampler", GLTF_SAMPLERS));
    return check_index(c, texture, "source", GLTF_IMAGES);
}

static tyn_result check_texture_info(const checker *c, const cJSON *parent, const char *name)
{
    cJSON *info;
    TYN_TRY(tyn_json_object(c->doc, parent, name, &info));
    if (info && !tyn_json_member(info, "index")) {
        return tyn_json_fault(c->doc, info, "index is missing: an index of textures");
    }
    return info ? check_index(c, info, "index", GLTF_TEXTURES) : TYN_OK;
}

static tyn_result check_material(const checker *c, const cJSON *material)
{
    cJSON *pbr, *gloss;
    TYN_TRY(tyn_json_extension(c->doc, material, "KHR_materials_pbrSpecularGlossiness", &gloss));
    TYN_TRY(check_texture_info(c, gloss, "diffuseTexture"));
    TYN_TRY(tyn_json_object(c->doc, material, "pbrMetallicRoughness", &pbr));
    TYN_TRY(check_texture_info(c, pbr, "baseColorTexture"));
    TYN_TRY(check_texture_info(c, pbr, "metallicRoughnessTexture"));
    TYN_TRY(check_texture_info(c, material, "normalTexture"));
    TYN_TRY(check_texture_info(c, material, "occlusionTexture"));
    return check_texture_info(c, material, "emissiveTexture");
}

// An object all of whose members are indices of accessors; NULL: it is not there.
static tyn_result check_attributes(const checker *c, const cJSON *attributes)
{
    const cJSON *element;
    cJSON_ArrayForEach(element, attributes)
    {
        TYN_TRY(check_index(c, attributes, element->string, GLTF_ACCESSORS));
    }
    return TYN_OK;
}

static tyn_result check_primitive(const checker *c, const cJSON *primitive)
{
    cJSON *attributes;
    json_list targets = {0};
    TYN_TRY(check_index(c, primitive, "indices", GLTF_ACCESSORS));
    TYN_TRY(check_index(c, primitive, "material", GLTF_MATERIALS));
    TYN_TRY(tyn_json_object(c->doc, primitive, "attributes", &attributes));
    TYN_TRY(check_attributes(c, attributes));
    tyn_result r = tyn_json_list(c->doc, primitive, "targets", &targets);
    for (int64_t t = 0; !r && t < targets.count; t++) {
        r = check_attributes(c, targets.items[t]);
    }
    free(targets.items);
    return r;
}

static tyn_result check_mesh(const checker *c, const cJSON *mesh)
{
    json_list primitives = {0};
    tyn_result r = tyn_json_list(c->doc, mesh, "primitives", &primitives);
    for (int64_t i = 0; !r && i < primitives.count; i++) {
        r = check_primitive(c, primitives.items[i]);
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
    cJSON *lights;
    const char *name;
    TYN_TRY(tyn_json_string(c->doc, node, "name", &name));
    TYN_TRY(check_index(c, node, "camera", GLTF_CAMERAS));
    TYN_TRY(check_index(c, node, "mesh", GLTF_MESHES));
    TYN_TRY(check_indices(c, node, "children", GLTF_NODES));
    TYN_TRY(tyn_json_extension(c->doc, node, "KHR_lights_punctual", &lights));
    return check_index(c, lights, "light", GLTF_LIGHTS);
}

static tyn_result check_scene(const checker *c, const cJSON *scene)
{
    return check_indices(c, scene, "nodes", GLTF_NODES);
}

static tyn_result check_light(const checker *c, const cJSON *light)
{
    tyn_light unused;
    return tyn_gltf_read_light(&unused, c->doc, light);
}

// ---- all --------------------------------------------------------------------------------------

const char *const tyn_gltf_lists[GLTF_NUM_LISTS] = {
    [GLTF_BUFFERS] = "buffers",     [GLTF_BUFFER_VIEWS] = "bufferViews",
    [GLTF_ACCESSORS] = "accessors", [GLTF_IMAGES] = "images",
    [GLTF_SAMPLERS] = "samplers",   [GLTF_TEXTURES] = "textures",
    [GLTF_MATERIALS] = "materials", [GLTF_MESHES] = "meshes",
    [GLTF_CAMERAS] = "cameras",     [GLTF_LIGHTS] = "lights",
    [GLTF_SCENES] = "scenes",       [GLTF_NODES] = "nodes",
};

static tyn_result (*const checks[GLTF_NUM_LISTS])(const checker *c, const cJSON *element) = {
    [GLTF_BUFFERS] = check_buffer,     [GLTF_BUFFER_VIEWS] = check_buffer_view,
    [GLTF_ACCESSORS] = check_accessor, [GLTF_IMAGES] = check_image,
    [GLTF_SAMPLERS] = check_sampler,   [GLTF_TEXTURES] = check_texture,
    [GLTF_MATERIALS] = check_material, [GLTF_MESHES] = check_mesh,
    [GLTF_CAMERAS] = check_camera,     [GLTF_LIGHTS] = check_light,
    [GLTF_SCENES] = check_scene,       [GLTF_NODES] = check_node,
};

tyn_result tyn_gltf_check(const json_doc *doc, bool glb, gltf_model *model)
{
    json_list *lists = model->lists;
    checker c = {.doc = doc, .glb = glb, .lists = lists, .model = model};
    cJSON *lights;
    TYN_TRY(check_asset(&c));
    TYN_TRY(tyn_gltf_check_required(doc));
    TYN_TRY(tyn_json_extension(doc, doc->root, "KHR_lights_punctual", &lights));
    for (int k = 0; k < GLTF_NUM_LISTS; k++) {
        TYN_TRY(tyn_json_list(doc, k == GLTF_LIGHTS ? lights : doc->root, tyn_gltf_lists[k],
                              &lists[k]));
    }
    model->views = calloc((size_t)lists[GLTF_BUFFER_VIEWS].count + 1, sizeof *model->views);
    model->accessors = calloc((size_t)lists[GLTF_ACCESSORS].count + 1, sizeof *model->accessors);
    if (!model->views || !model->accessors) {
        return tyn_json_no_memory(doc, "accessors");
    }
    for (int k = 0; k < GLTF_NUM_LISTS; k++) {
        for (c.index = 0; c.index < lists[k].count; c.index++) {
            TYN_TRY(checks[k](&c, lists[k].items[c.index]));
        }
    }
    return check_index(&c, doc->root, "scene", GLTF_SCENES);
}
