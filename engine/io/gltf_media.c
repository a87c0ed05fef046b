// gltf_media.c -- reads TYN_participating_media and TYN_environment_map.
#include "io/gltf_media.h"
#include "io/gltf_phase.h"
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "io/uri.h"
#include "io/volume.h"
#include "scene/matrix.h"

// ---- media ----------------------------------------------------------------------------------

static tyn_result read_medium(tyn_scene *scene, gltf_media *media, const json_doc *doc,
                              const cJSON *from)
{
    const char *name = NULL;
    if (scene->num_media == TYN_MAX_MEDIA) {
        return tyn_json_fault(doc, from, "there may be %d media", TYN_MAX_MEDIA);
    }
    tyn_medium *medium = &scene->media[scene->num_media];
    *medium = (tyn_medium){.volume = -1, .density_scale = 1.0f};
    TYN_TRY(tyn_json_string(doc, from, "name", &name));
    TYN_TRY(tyn_json_color(doc, from, "scattering", 0.0, FLT_MAX, ">= 0, in 1/m", medium->sigma_s));
    TYN_TRY(tyn_json_color(doc, from, "absorption", 0.0, FLT_MAX, ">= 0, in 1/m", medium->sigma_a));
    for (const tyn_phase_parameter *p = tyn_phase_parameters(); p->name; p++) {
        float values[3];
        tyn_phase_get(medium->phase, p, values);
        TYN_TRY(tyn_json_color(doc, from, p->key, p->lo, p->hi, p->right, values));
        tyn_phase_set(medium->phase, p, values);
    }
    TYN_TRY(tyn_gltf_read_phase(scene, doc, from, medium->phase));
    TYN_TRY(tyn_json_color(doc, from, "emission", 0.0, FLT_MAX, ">= 0, in W/(m^3 sr)",
                           medium->emission));
    TYN_TRY(tyn_gltf_read_grids(scene, medium, &media->grids[scene->num_media], doc, from));
    medium->name = name ? strdup(name) : NULL;
    scene->num_media++;
    return TYN_OK;
}

tyn_result tyn_gltf_read_media(tyn_scene *scene, gltf_media *media, const json_doc *doc)
{
    cJSON *extension, *list;
    const cJSON *element;
    memset(media, 0, sizeof *media);
    TYN_TRY(tyn_json_extension(doc, doc->root, "TYN_participating_media", &extension));
    TYN_TRY(tyn_json_array(doc, extension, "media", &list));
    cJSON_ArrayForEach(element, list)
    {
        if (!cJSON_IsObject(element)) {
            return tyn_json_fault(doc, element, "must be an object");
        }
        TYN_TRY(read_medium(scene, media, doc, element));
    }
    return TYN_OK;
}

// ---- shapes ---------------------------------------------------------------------------------

static tyn_result read_repeat(tyn_shape *shape, const json_doc *doc, const cJSON *extension)
{
    cJSON *repeat;
    TYN_TRY(tyn_json_array(doc, extension, "repeat", &repeat));
    if (!repeat) {
        return TYN_OK;
    }
    if (cJSON_GetArraySize(repeat) != 3 || shape->kind != TYN_SHAPE_BOX) {
        return tyn_json_fault(doc, repeat, "must be three of true or false, on a box");
    }
    for (int a = 0; a < 3; a++) {
        const cJSON *flag = cJSON_GetArrayItem(repeat, a);
        if (!cJSON_IsBool(flag)) {
            return tyn_json_fault(doc, flag, "must be true or false");
        }
        shape->repeat[a] = cJSON_IsTrue(flag);
    }
    return TYN_OK;
}

tyn_result tyn_gltf_read_shape(tyn_scene *scene, const gltf_media *media, const json_doc *doc,
                               const cJSON *node, const double to_world[16])
{
    cJSON *extension;
    const char *kind = "box";
    int64_t medium = 0;
    double m[16];
    TYN_TRY(tyn_json_extension(doc, node, "TYN_participating_media", &extension));
    if (!extension) {
        return TYN_OK;
    }
    const cJSON *index = tyn_json_member(extension, "medium");
    if (!index) {
        return tyn_json_fault(doc, extension, "medium is missing: an index of the list of media");
    }
    TYN_TRY(tyn_json_index(doc, index, scene->num_media, "media", &medium));
    TYN_TRY(tyn_json_string(doc, extension, "shape", &kind));
    if (scene->num_shapes == TYN_MAX_SHAPES) {
        return tyn_json_fault(doc, extension, "there may be %d nodes with a medium",
                              TYN_MAX_SHAPES);
    }
    tyn_shape *shape = &scene->shapes[scene->num_shapes];
    *shape = (tyn_shape){.medium = (uint32_t)medium};
    memcpy(m, to_world, sizeof m);
    if (strcmp(kind, "sphere") == 0) {
        shape->kind = TYN_SHAPE_SPHERE;
    } else if (strcmp(kind, "grid") == 0) {
        const gltf_grids *own = &media->grids[medium];
        if (!own->placed) {
            return tyn_json_fault(
                doc, tyn_json_member(extension, "shape"),
                "only media with a .vdb or .nvdb density have a grid of their own");
        }
        mat_mul(m, m, own->index_to_world);
        tyn_grid_box(m, m, own->size);
    } else if (strcmp(kind, "box") != 0) {
        return tyn_json_fault(doc, tyn_json_member(extension, "shape"),
                              "must be \"box\", \"sphere\" or \"grid\"");
    }
    if (!mat_invertible(m)) {
        return tyn_json_fault(doc, extension,
                              "the node's world matrix must be invertible, its determinant is %g",
                              mat_det3(m));
    }
    for (int i = 0; i < 16; i++) {
        shape->to_world[i] = (float)m[i];
    }
    TYN_TRY(read_repeat(shape, doc, extension));
    scene->num_shapes++;
    return TYN_OK;
}

// ---- environment ----------------------------------------------------------------------------

static tyn_result read_map(tyn_environment *env, const json_doc *doc, const cJSON *from)
{
    double q[4] = {0, 0, 0, 1};
    const cJSON *uri = tyn_json_member(from, "uri");
    TYN_TRY(
        tyn_json_color(doc, from, "radiance", 0.0, FLT_MAX, ">= 0, in W/(m^2 sr)", env->radiance));
    TYN_TRY(tyn_json_numbers(doc, from, "rotation", 4, -1.001, 1.001, "-1 to 1", q));
    double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(fabs(length - 1.0) < 0.01)) {
        return tyn_json_fault(doc, tyn_json_member(from, "rotation"),
                              "must be a unit quaternion x, y, z, w");
    }
    for (int i = 0; i < 4; i++) {
        env->rotation[i] = (float)(q[i] / length);
    }
    env->present = true;
    if (!uri) {
        return tyn_json_member(from, "radiance")
                   ? TYN_OK
                   : tyn_json_fault(doc, from, "needs a uri (.exr or .hdr), a radiance, or both");
    }
    char *path = tyn_uri_path(doc, uri);
    if (!path) {
        return TYN_ERR_PARAMS;
    }
    tyn_capture capture;
    tyn_capture_init(&capture);
    tyn_result r = tyn_environment_load(env, path, &capture.log);
    free(path);
    return r ? tyn_capture_fault(&capture, doc, uri, r) : TYN_OK;
}

tyn_result tyn_gltf_read_environment(tyn_scene *scene, const json_doc *doc, const cJSON *gltf_scene)
{
    cJSON *extension, *list;
    int64_t index = 0;
    TYN_TRY(tyn_json_extension(doc, gltf_scene, "TYN_environment_map", &extension));
    const cJSON *at = tyn_json_member(extension, "environment");
    if (!extension || !at) {
        return extension ? tyn_json_fault(doc, extension,
                                          "environment is missing: an index of the "
                                          "list of environments")
                         : TYN_OK;
    }
    TYN_TRY(tyn_json_extension(doc, doc->root, "TYN_environment_map", &extension));
    TYN_TRY(tyn_json_array(doc, extension, "environments", &list));
    TYN_TRY(tyn_json_index(doc, at, cJSON_GetArraySize(list), "environments", &index));
    const cJSON *from = cJSON_GetArrayItem(list, (int)index);
    if (!cJSON_IsObject(from)) {
        return tyn_json_fault(doc, from, "must be an object");
    }
    return read_map(&scene->environment, doc, from);
}

// ---- what is not known -----------------------------------------------------------------------

// The first member that is not known, and how many there are.
typedef struct unknown {
    const cJSON *first;
    const char *known; // of its object
    uint32_t count;
} unknown;

// `known`: names, separated and enclosed by blanks. Any object of glTF may have extensions, extras and, in a list, a
// name.
static void look(unknown *u, const cJSON *object, const char *known)
{
    const cJSON *member, *members = cJSON_IsObject(object) ? object : NULL;
    cJSON_ArrayForEach(member, members)
    {
        char word[64];
        const int length = snprintf(word, sizeof word, " %s ", member->string);
        const bool found = length < (int)sizeof word && !strchr(member->string, ' ') &&
                           (strstr(known, word) || strstr(" name extensions extras ", word));
        if (!found && u->count++ == 0) {
            u->first = member;
            u->known = known;
        }
    }
}

static const cJSON *extension_of(const cJSON *object, const char *name)
{
    return tyn_json_member(tyn_json_member(object, "extensions"), name);
}

static void look_at_all(unknown *u, const cJSON *list, const char *extension, const char *known)
{
    const cJSON *element;
    cJSON_ArrayForEach(element, list)
    {
        look(u, extension ? extension_of(element, extension) : element, known);
    }
}

// One phase function, or a list of them.
static void look_at_phase(unknown *u, const cJSON *phase)
{
    const cJSON *first = cJSON_IsArray(phase) ? phase->child : phase;
    for (const cJSON *p = first; p; p = cJSON_IsArray(phase) ? p->next : NULL) {
        look(u, p, TYN_GLTF_PHASE_MEMBERS);
        look_at_all(u, tyn_json_member(p, "lobes"), NULL, TYN_GLTF_LOBE_MEMBERS);
    }
}

void tyn_gltf_warn_unknown(tyn_scene *scene, const json_doc *doc)
{
    static const char media[] = "TYN_participating_media", maps[] = "TYN_environment_map";
    unknown u = {0};
    char coefficients[256] =
        " scattering absorption emission density temperature emission_density albedo phase ";
    for (const tyn_phase_parameter *p = tyn_phase_parameters(); p->name; p++) {
        const size_t used = strlen(coefficients);
        snprintf(coefficients + used, sizeof coefficients - used, "%s ", p->key);
    }
    const cJSON *at = extension_of(doc->root, media), *list = tyn_json_member(at, "media"), *medium;
    look(&u, at, " media ");
    look_at_all(&u, list, NULL, coefficients);
    cJSON_ArrayForEach(medium, list)
    {
        look(&u, tyn_json_member(medium, "density"), " uri grid scale size type ");
        look(&u, tyn_json_member(medium, "temperature"),
             " uri grid scale offset strength luminance size type ");
        look(&u, tyn_json_member(medium, "emission_density"),
             " uri grid scale size type channels ");
        look(&u, tyn_json_member(medium, "albedo"), " uri grid size type channels ");
        look_at_phase(&u, tyn_json_member(medium, "phase"));
    }
    look_at_all(&u, tyn_json_member(doc->root, "nodes"), media, " medium shape repeat ");
    at = extension_of(doc->root, maps);
    look(&u, at, " environments ");
    look_at_all(&u, tyn_json_member(at, "environments"), NULL, " uri radiance rotation ");
    look_at_all(&u, tyn_json_member(doc->root, "scenes"), maps, " environment ");
    if (u.count > 0) {
        char path[512], others[32] = "";
        tyn_json_path(doc, u.first, path, sizeof path);
        if (u.count > 1) {
            snprintf(others, sizeof others, " and %u more", u.count - 1);
        }
        tyn_scene_warn(scene, "%s%s: not known and left out; known here:%.*s", path, others,
                       (int)strlen(u.known) - 1, u.known);
    }
}
