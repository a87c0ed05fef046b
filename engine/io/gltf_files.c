// gltf_files.c -- which files a glTF scene names.
#include "io/gltf.h"
#include "io/gltf_json.h"
#include "io/uri.h"
#include <stdlib.h>
#include <string.h>
#include <strings.h>

bool tyn_is_gltf(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot && (strcasecmp(dot, ".gltf") == 0 || strcasecmp(dot, ".glb") == 0);
}

static void tell_uris(const json_doc *doc, const cJSON *json, tyn_file_found found, void *user)
{
    for (const cJSON *item = json ? json->child : NULL; item; item = item->next) {
        const bool names_file = item->string && strcmp(item->string, "uri") == 0 &&
                                cJSON_IsString(item) && strncmp(item->valuestring, "data:", 5) != 0;
        char *path = names_file ? tyn_uri_path(doc, item) : NULL;
        if (path) {
            found(user, path);
        }
        free(path);
        tell_uris(doc, item, found, user);
    }
}

tyn_result tyn_scene_files(const char *path, const uint32_t *frame, tyn_file_found found,
                           void *user, const tyn_log *log)
{
    const tyn_log nobody = {0};
    if (!path || !found) {
        return TYN_ERR_PARAMS;
    }
    found(user, path);
    if (!tyn_is_gltf(path)) {
        return TYN_OK;
    }
    void *bytes = NULL;
    size_t size = 0;
    gltf_container container;
    json_doc doc = {0};
    tyn_result r = tyn_file_read(path, 0x7fffffff, &bytes, &size, log);
    if (!r) {
        r = tyn_gltf_open(&container, bytes, size, path, log);
    }
    if (!r) {
        r = tyn_json_parse(&doc, container.json, container.json_size, path, log);
    }
    if (!r) {
        doc.frame = frame;
        doc.log = &nobody; // what is no name of a file is left out
        tell_uris(&doc, doc.root, found, user);
    }
    tyn_json_finish(&doc);
    free(bytes);
    return r;
}
