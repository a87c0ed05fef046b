// gltf_extensions.c -- which extensions of glTF are understood, and what is said of the others.
#include "io/gltf_extensions.h"
#include <stdio.h>
#include <string.h>

static const char *const understood[] = {
    "TYN_participating_media", "TYN_environment_map",   "KHR_lights_punctual",
    "KHR_mesh_quantization",   "KHR_texture_transform", "KHR_materials_emissive_strength",
    "EXT_mesh_gpu_instancing", "KHR_materials_unlit",   "KHR_materials_pbrSpecularGlossiness",
};

// Those that pack what others leave plain, and the command that unpacks them (of npm's @gltf-transform/cli).
static const struct {
    const char *name, *packs, *command;
} packed[] = {
    {"KHR_draco_mesh_compression", "meshes", "cp"},
    {"EXT_meshopt_compression", "buffers", "cp"},
    {"KHR_meshopt_compression", "buffers", "cp"},
    {"EXT_texture_webp", "textures", "png"},
    {"EXT_texture_avif", "textures", "png"},
    {"KHR_texture_basisu", "textures", "ktxdecompress"},
};

static bool is_understood(const char *name)
{
    for (size_t i = 0; i < sizeof understood / sizeof *understood; i++) {
        if (strcmp(name, understood[i]) == 0) {
            return true;
        }
    }
    return false;
}

// Materials have what is understood of them beside their extensions: without one they look plainer, and that is warned
// of.
static bool is_of_materials(const char *name)
{
    return strncmp(name, "KHR_materials_", strlen("KHR_materials_")) == 0;
}

tyn_result tyn_gltf_check_required(const json_doc *doc)
{
    cJSON *array;
    const cJSON *element;
    TYN_TRY(tyn_json_array(doc, doc->root, "extensionsUsed", &array));
    TYN_TRY(tyn_json_array(doc, doc->root, "extensionsRequired", &array));
    cJSON_ArrayForEach(element, array)
    {
        const char *name = cJSON_IsString(element) ? element->valuestring : "";
        for (size_t i = 0; i < sizeof packed / sizeof *packed; i++) {
            if (strcmp(name, packed[i].name) == 0) {
                return tyn_json_fault(doc, element,
                                      "its %s are packed, which is not read; 'gltf-transform %s "
                                      "IN.glb OUT.glb' unpacks them",
                                      packed[i].packs, packed[i].command);
            }
        }
        if (!is_understood(name) && !is_of_materials(name)) {
            char known[512] = "";
            size_t used = 0;
            for (size_t i = 0; i < sizeof understood / sizeof *understood; i++) {
                used += (size_t)snprintf(known + used, sizeof known - used, "%s%s", i ? ", " : "",
                                         understood[i]);
            }
            return tyn_json_fault(doc, element, "this extension is not known; known are %s", known);
        }
    }
    return TYN_OK;
}

// ---- what is left out -------------------------------------------------------------------------

enum { MAX_UNKNOWN = 32 }; // extensions that are told of

typedef struct unknown {
    const char *name;
    const cJSON *first; // place
    uint32_t count;
} unknown;

typedef struct search {
    unknown found[MAX_UNKNOWN];
    uint32_t count;
} search;

static void look_at(search *s, const cJSON *extension)
{
    if (!extension->string || is_understood(extension->string)) {
        return;
    }
    uint32_t i = 0;
    while (i < s->count && strcmp(s->found[i].name, extension->string) != 0) {
        i++;
    }
    if (i < MAX_UNKNOWN) {
        if (i == s->count) {
            s->found[s->count++] = (unknown){extension->string, extension, 0};
        }
        s->found[i].count++;
    }
}

// Everything below: nesting is bounded (tyn_json_parse).
static void go_through(search *s, const cJSON *at)
{
    const cJSON *child;
    cJSON_ArrayForEach(child, at)
    {
        if (child->string && strcmp(child->string, "extras") == 0) {
            continue; // what anybody wants to say
        }
        if (child->string && strcmp(child->string, "extensions") == 0 && cJSON_IsObject(at)) {
            const cJSON *extension;
            cJSON_ArrayForEach(extension, child)
            {
                look_at(s, extension);
            }
        } else if (cJSON_IsObject(child) || cJSON_IsArray(child)) {
            go_through(s, child);
        }
    }
}

void tyn_gltf_warn_extensions(tyn_scene *scene, const json_doc *doc)
{
    search s = {0};
    go_through(&s, doc->root);
    for (uint32_t i = 0; i < s.count; i++) {
        const unknown *u = &s.found[i];
        char path[256], more[32] = "";
        tyn_json_path(doc, u->first, path, sizeof path);
        if (u->count > 1) {
            snprintf(more, sizeof more, " and %u more", u->count - 1);
        }
        tyn_scene_warn(scene, "%s%s: this extension is not understood and left out", path, more);
    }
}
