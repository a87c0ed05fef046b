// gltf_material.c -- materials of a glTF file as diffuse surfaces.
//
// Of the metallic-roughness model its diffuse part is kept: albedo = baseColor (1 - metallic). Of specular-glossiness
// (KHR_materials_pbrSpecularGlossiness) likewise: albedo = diffuse.
#include "io/gltf_material.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <tyndall/extend/hash.h>

// ---- open, close ------------------------------------------------------------------------------

static const char SPECULAR_GLOSSINESS[] = "KHR_materials_pbrSpecularGlossiness";

tyn_result tyn_gltf_materials_open(gltf_materials *m, const gltf_data *data, tyn_scene *scene)
{
    const json_doc *doc = data->doc;
    memset(m, 0, sizeof *m);
    m->scene = scene;
    m->list = &data->model->lists[GLTF_MATERIALS];
    TYN_TRY(tyn_gltf_textures_open(&m->textures, data, scene));
    m->loaded = calloc((size_t)m->list->count + 1, sizeof *m->loaded);
    m->is_loaded = calloc((size_t)m->list->count + 1, sizeof *m->is_loaded);
    if (!m->loaded || !m->is_loaded) {
        return tyn_json_no_memory(doc, "materials");
    }
    return TYN_OK;
}

static void close_picture(gltf_picture *picture)
{
    if (picture) {
        tyn_gltf_picture_finish(picture);
        free(picture);
    }
}

void tyn_gltf_materials_close(gltf_materials *m)
{
    static const char *const what[NUM_LACKS] = {
        [LACK_METAL] = "all metal (metallicFactor 1 is glTF's default): it reflects nothing, only "
                       "diffuse reflection is done",
        [LACK_METAL_TEXTURE] = "of metallicRoughnessTexture the mean metalness counts",
        [LACK_NORMAL_TEXTURE] = "normalTexture is not read",
        [LACK_ALPHA] = "it is opaque: of alphaMode only MASK is read, not BLEND",
        [LACK_UNLIT] = "KHR_materials_unlit: it is lit as others are",
        [LACK_GLOSS] = "of KHR_materials_pbrSpecularGlossiness the diffuse part is kept",
    };
    for (int i = 0; i < NUM_LACKS; i++) {
        const uint32_t others = m->lacks[i].count - 1;
        if (m->lacks[i].count == 1) {
            tyn_scene_warn(m->scene, "material %s: %s", m->lacks[i].name, what[i]);
        } else if (m->lacks[i].count) {
            tyn_scene_warn(m->scene, "material %s and %u more: %s", m->lacks[i].name, others,
                           what[i]);
        }
    }
    tyn_gltf_textures_close(&m->textures);
    for (int64_t i = 0; m->loaded && i <= m->list->count; i++) {
        close_picture(m->loaded[i].alpha);
        close_picture(m->loaded[i].glow);
    }
    free(m->loaded);
    free(m->painted);
    free(m->is_loaded);
}

static void lack(gltf_materials *m, int64_t index, gltf_material_lack which)
{
    tyn_gltf_note(&m->lacks[which], m->list, index, "of meshes without one");
}

// ---- reading ----------------------------------------------------------------------------------

static tyn_result read_place(const json_doc *doc, const cJSON *info, gltf_texture_place *out)
{
    int64_t texcoord = 0;
    double offset[2] = {0, 0}, scale[2] = {1, 1}, angle = 0;
    cJSON *transform;
    TYN_TRY(tyn_json_integer(doc, info, "texCoord", 0, 15, "a whole number, 0 to 15", &texcoord));
    TYN_TRY(tyn_json_extension(doc, info, "KHR_texture_transform", &transform));
    const char *finite = "a finite number";
    TYN_TRY(
        tyn_json_integer(doc, transform, "texCoord", 0, 15, "a whole number, 0 to 15", &texcoord));
    TYN_TRY(tyn_json_numbers(doc, transform, "offset", 2, -1e9, 1e9, finite, offset));
    TYN_TRY(tyn_json_numbers(doc, transform, "scale", 2, -1e9, 1e9, finite, scale));
    TYN_TRY(tyn_json_number(doc, transform, "rotation", -1e9, 1e9, finite, &angle));
    const double c = cos(angle), s = sin(angle);
    const double uv[2][3] = {{c * scale[0], s * scale[1], offset[0]},
                             {-s * scale[0], c * scale[1], offset[1]}};
    for (int i = 0; i < 6; i++) {
        out->uv[i / 3][i % 3] = (float)uv[i / 3][i % 3];
    }
    out->texcoord = (uint32_t)texcoord;
    return TYN_OK;
}

static tyn_result read_picture(gltf_materials *m, const cJSON *info, gltf_picture **out)
{
    tyn_texture texture;
    TYN_TRY(tyn_gltf_texture_read(&m->textures, info, &texture));
    *out = calloc(1, sizeof **out);
    if (!*out || !tyn_gltf_picture_make(*out, &texture)) {
        if (!*out) {
            free(texture.texels);
        }
        return tyn_json_fault(m->textures.data->doc, info, "no memory for its texture");
    }
    return TYN_OK;
}

// The factors of all fields, which are those but for textures and extensions.
static tyn_result read_factors(const json_doc *doc, const cJSON *json, double factors[][4])
{
    for (int k = 0; k < TYN_MATERIAL_NUM_FIELDS; k++) {
        const tyn_material_field *f = &tyn_material_fields[k];
        cJSON *object = NULL;
        for (int c = 0; c < 4; c++) {
            factors[k][c] = f->factor_def;
        }
        if (f->object) {
            TYN_TRY(tyn_json_object(doc, json, f->object, &object));
        }
        TYN_TRY(tyn_json_numbers(doc, f->object ? object : json, f->factor, f->factors, 0, 1,
                                 "between 0 and 1", factors[k]));
    }
    return TYN_OK;
}

// Of specular-glossiness its diffuse factor in place of the base colour's.
static tyn_result read_diffuse_factor(const json_doc *doc, const cJSON *json, double factor[4])
{
    cJSON *gloss;
    TYN_TRY(tyn_json_extension(doc, json, SPECULAR_GLOSSINESS, &gloss));
    if (!gloss) {
        return TYN_OK;
    }
    factor[0] = factor[1] = factor[2] = factor[3] = 1;
    return tyn_json_numbers(doc, gloss, "diffuseFactor", 4, 0, 1, "between 0 and 1", factor);
}

// The info of its diffuse texture, or of that of the base colour; NULL: there is none.
static tyn_result read_diffuse_texture(const json_doc *doc, const cJSON *json, cJSON **info)
{
    cJSON *gloss, *pbr;
    TYN_TRY(tyn_json_extension(doc, json, SPECULAR_GLOSSINESS, &gloss));
    if (gloss) {
        return tyn_json_object(doc, gloss, "diffuseTexture", info);
    }
    TYN_TRY(tyn_json_object(doc, json, "pbrMetallicRoughness", &pbr));
    return tyn_json_object(doc, pbr, "baseColorTexture", info);
}

// How much of a material is metal, which reflects nothing diffusely.
static tyn_result read_metallic(gltf_materials *m, int64_t index, const cJSON *json, double *out)
{
    const json_doc *doc = m->textures.data->doc;
    double mean;
    cJSON *pbr, *metal, *unlit, *gloss;
    TYN_TRY(tyn_json_extension(doc, json, SPECULAR_GLOSSINESS, &gloss));
    TYN_TRY(tyn_json_extension(doc, json, "KHR_materials_unlit", &unlit));
    if (gloss || unlit) {
        lack(m, index, gloss ? LACK_GLOSS : LACK_UNLIT);
        *out = 0;
        return TYN_OK;
    }
    *out = 1;
    TYN_TRY(tyn_json_object(doc, json, "pbrMetallicRoughness", &pbr));
    TYN_TRY(tyn_json_number(doc, pbr, "metallicFactor", 0, 1, "between 0 and 1", out));
    TYN_TRY(tyn_json_object(doc, pbr, "metallicRoughnessTexture", &metal));
    if (metal && *out > 0) { // metalness is in the blue channel, linear
        TYN_TRY(tyn_gltf_texture_mean(&m->textures, metal, 2, &mean));
        *out *= mean;
        lack(m, index, LACK_METAL_TEXTURE);
    }
    return TYN_OK;
}

static tyn_result read_albedo(gltf_materials *m, int64_t index, const cJSON *json,
                              gltf_material *out, double factor[4])
{
    const json_doc *doc = m->textures.data->doc;
    double metallic;
    cJSON *info;
    TYN_TRY(read_metallic(m, index, json, &metallic));
    TYN_TRY(read_diffuse_texture(doc, json, &info));
    if (info) {
        TYN_TRY(read_place(doc, info, &out->color));
        TYN_TRY(tyn_gltf_texture_get(&m->textures, info, &out->surface.texture));
    }
    if (metallic == 1 && factor[0] + factor[1] + factor[2] > 0) {
        lack(m, index, LACK_METAL);
    }
    for (int c = 0; c < 3; c++) {
        factor[c] *= 1 - metallic;
    }
    return TYN_OK;
}

static tyn_result read_emission(gltf_materials *m, const cJSON *json, gltf_material *out,
                                double factor[3])
{
    const json_doc *doc = m->textures.data->doc;
    double strength = 1;
    cJSON *strong, *info;
    TYN_TRY(tyn_json_extension(doc, json, "KHR_materials_emissive_strength", &strong));
    TYN_TRY(tyn_json_number(doc, strong, "emissiveStrength", 0, 1e30, "a number >= 0", &strength));
    TYN_TRY(tyn_json_object(doc, json, "emissiveTexture", &info));
    if (info && factor[0] + factor[1] + factor[2] > 0) {
        TYN_TRY(read_place(doc, info, &out->glow_place));
        TYN_TRY(read_picture(m, info, &out->glow));
    }
    for (int c = 0; c < 3; c++) {
        factor[c] *= strength;
    }
    return TYN_OK;
}

// alphaMode MASK; `factor` is that of the base colour.
static tyn_result read_mask(gltf_materials *m, int64_t index, const cJSON *json, gltf_material *out,
                            const double factor[4])
{
    const json_doc *doc = m->textures.data->doc;
    const char *mode = "OPAQUE";
    double cutoff = 0.5;
    cJSON *info;
    TYN_TRY(tyn_json_string(doc, json, "alphaMode", &mode));
    TYN_TRY(tyn_json_number(doc, json, "alphaCutoff", 0, 1e30, "a number >= 0", &cutoff));
    if (strcmp(mode, "BLEND") == 0) {
        lack(m, index, LACK_ALPHA);
    } else if (strcmp(mode, "MASK") == 0 && cutoff > 0) {
        out->cutoff = cutoff;
        out->opacity = factor[3];
        TYN_TRY(read_diffuse_texture(doc, json, &info));
        return info ? read_picture(m, info, &out->alpha) : TYN_OK;
    } else if (strcmp(mode, "MASK") != 0 && strcmp(mode, "OPAQUE") != 0) {
        return tyn_json_fault(doc, tyn_json_member(json, "alphaMode"),
                              "must be OPAQUE, MASK or BLEND");
    }
    return TYN_OK;
}

static void look_at_rest(gltf_materials *m, int64_t index, const cJSON *json)
{
    if (tyn_json_member(json, "normalTexture")) {
        lack(m, index, LACK_NORMAL_TEXTURE);
    }
}

// ---- into the scene ---------------------------------------------------------------------------

tyn_result tyn_gltf_material_get(gltf_materials *m, int64_t index, const gltf_material **out)
{
    const int64_t at = index < 0 ? m->list->count : index;
    gltf_material *loaded = &m->loaded[at];
    *out = loaded;
    if (m->is_loaded[at]) {
        return TYN_OK;
    }
    const gltf_texture_place plain = {0, {{1, 0, 0}, {0, 1, 0}}};
    *loaded = (gltf_material){
        .index = at, .surface.texture = TYN_NO_TEXTURE, .color = plain, .glow_place = plain};
    m->is_loaded[at] = true;
    if (at == m->list->count) { // albedo = 1 (1 - 1)
        lack(m, at, LACK_METAL);
        return TYN_OK;
    }
    const cJSON *json = m->list->items[at];
    double factors[TYN_MATERIAL_NUM_FIELDS][4];
    TYN_TRY(read_factors(m->textures.data->doc, json, factors));
    TYN_TRY(read_diffuse_factor(m->textures.data->doc, json, factors[TYN_MATERIAL_ALBEDO]));
    TYN_TRY(read_mask(m, at, json, loaded, factors[TYN_MATERIAL_ALBEDO]));
    TYN_TRY(read_albedo(m, at, json, loaded, factors[TYN_MATERIAL_ALBEDO]));
    TYN_TRY(read_emission(m, json, loaded, factors[TYN_MATERIAL_EMISSION]));
    for (int k = 0; k < TYN_MATERIAL_NUM_FIELDS; k++) {
        const tyn_material_field *f = &tyn_material_fields[k];
        float *v = (float *)((char *)&loaded->surface + f->offset);
        for (uint32_t c = 0; c < f->count; c++) {
            v[c] = (float)factors[k][c];
        }
    }
    look_at_rest(m, at, json);
    loaded->surface.flags =
        cJSON_IsTrue(tyn_json_member(json, "doubleSided")) ? TYN_SURFACE_EMITS_BOTH_SIDES : 0;
    return TYN_OK;
}

static tyn_result add(gltf_materials *m, const tyn_surface_material *material, uint32_t *index)
{
    tyn_surfaces *s = &m->scene->surfaces;
    const uint32_t n = s->num_materials;
    // Room for twice as many whenever there are a power of two.
    tyn_surface_material *grown =
        n & (n - 1) ? s->materials : realloc(s->materials, (n ? 2 * n : 1) * sizeof *grown);
    if (!grown) {
        return tyn_json_no_memory(m->textures.data->doc, "materials");
    }
    s->materials = grown;
    *index = s->num_materials;
    grown[s->num_materials++] = *material;
    return TYN_OK;
}

typedef struct gltf_painted_material {
    struct {
        int64_t index;
        float tint[3], glow[3];
    } key;
    uint32_t material; // + 1; 0: the place is free
} painted_material;

// Where it is, or is to be.
static painted_material *find(painted_material *table, uint32_t room, const painted_material *like)
{
    uint64_t h = tyn_hash_bytes(TYN_HASH_SEED, &like->key, sizeof like->key);
    uint32_t i = (uint32_t)(h >> 32) & (room - 1);
    while (table[i].material && memcmp(&table[i].key, &like->key, sizeof like->key) != 0) {
        i = (i + 1) & (room - 1);
    }
    return &table[i];
}

static bool make_room(gltf_materials *m)
{
    if (2 * m->num_painted < m->painted_room) {
        return true;
    }
    const uint32_t room = m->painted_room ? 2 * m->painted_room : 64;
    painted_material *grown = calloc(room, sizeof *grown);
    for (uint32_t i = 0; grown && i < m->painted_room; i++) {
        if (m->painted[i].material) {
            *find(grown, room, &m->painted[i]) = m->painted[i];
        }
    }
    if (grown) {
        free(m->painted);
        m->painted = grown;
        m->painted_room = room;
    }
    return grown != NULL;
}

tyn_result tyn_gltf_material_paint(gltf_materials *m, const gltf_material *material,
                                   const float tint[3], const float glow[3], uint32_t *index)
{
    painted_material wanted;
    memset(&wanted, 0, sizeof wanted); // padding is compared
    wanted.key.index = material->index;
    tyn_surface_material surface = material->surface;
    for (int c = 0; c < 3; c++) {
        wanted.key.tint[c] = tint[c];
        wanted.key.glow[c] = glow[c];
        surface.albedo[c] = fminf(fmaxf(surface.albedo[c] * tint[c], 0), 1);
        surface.emission[c] *= glow[c];
    }
    if (!make_room(m)) {
        return tyn_json_no_memory(m->textures.data->doc, "materials");
    }
    painted_material *found = find(m->painted, m->painted_room, &wanted);
    if (!found->material) {
        TYN_TRY(add(m, &surface, index));
        *found = wanted;
        found->material = *index + 1;
        m->num_painted++;
    }
    *index = found->material - 1;
    return TYN_OK;
}
