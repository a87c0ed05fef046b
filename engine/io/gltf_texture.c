// gltf_texture.c -- textures of a glTF file, read when a material wants them.
#include "io/gltf_texture.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "io/picture.h"
#include "io/uri.h"

tyn_result tyn_gltf_textures_open(gltf_textures *t, const gltf_data *data, tyn_scene *scene)
{
    const json_doc *doc = data->doc;
    const json_list *lists = data->model->lists;
    *t = (gltf_textures){.data = data,
                         .scene = scene,
                         .surfaces = &scene->surfaces,
                         .textures = &lists[GLTF_TEXTURES],
                         .images = &lists[GLTF_IMAGES],
                         .samplers = &lists[GLTF_SAMPLERS]};
    t->loaded = malloc(((size_t)t->textures->count + 1) * sizeof *t->loaded);
    t->missing = calloc((size_t)t->textures->count + 1, sizeof *t->missing);
    if (!t->loaded || !t->missing) {
        return tyn_json_no_memory(doc, "textures");
    }
    for (int64_t i = 0; i < t->textures->count; i++) {
        t->loaded[i] = TYN_NO_TEXTURE;
    }
    return TYN_OK;
}

static char *texture_name(const gltf_textures *t, const cJSON *texture)
{
    const cJSON *source = tyn_json_member(texture, "source");
    const cJSON *at[2] = {texture, source ? t->images->items[(int64_t)source->valuedouble] : NULL};
    for (int i = 0; i < 2; i++) {
        const cJSON *name = tyn_json_member(at[i], "name");
        if (cJSON_IsString(name) && name->valuestring[0]) {
            return strdup(name->valuestring);
        }
    }
    const cJSON *uri = tyn_json_member(at[1], "uri");
    return cJSON_IsString(uri) && strncmp(uri->valuestring, "data:", 5) ? strdup(uri->valuestring)
                                                                        : NULL;
}

static void warn_of_missing(const gltf_textures *t)
{
    uint32_t count = 0;
    int64_t first = -1;
    for (int64_t i = 0; t->missing && i < t->textures->count; i++) {
        count += t->missing[i];
        first = t->missing[i] && first < 0 ? i : first;
    }
    if (!count) {
        return;
    }
    char *name = texture_name(t, t->textures->items[first]), more[32] = "";
    if (count > 1) {
        snprintf(more, sizeof more, " and %u more", count - 1);
    }
    tyn_scene_warn(t->scene,
                   "texture %lld%s%s%s%s: there is no such picture; a mean grey stands for it",
                   (long long)first, name ? " '" : "", name ? name : "", name ? "'" : "", more);
    free(name);
}

void tyn_gltf_textures_close(gltf_textures *t)
{
    if (t->scene) {
        warn_of_missing(t);
    }
    free(t->loaded);
    free(t->missing);
}

// ---- images -----------------------------------------------------------------------------------

static tyn_result decode(const gltf_data *data, const cJSON *at, const uint8_t *bytes, size_t size,
                         tyn_texture *out)
{
    const char *reason;
    out->texels = tyn_picture_decode(bytes, size, out->size, &reason);
    return out->texels ? TYN_OK
                       : tyn_json_fault(data->doc, at, "must be a PNG or JPEG picture: %s", reason);
}

// Stands for what is not there: 0.5 in all channels, as light (0.5 is 188 in sRGB).
static tyn_result grey(tyn_texture *out)
{
    out->size[0] = out->size[1] = 1;
    out->texels = malloc(4);
    if (out->texels) {
        memcpy(out->texels, (uint8_t[4]){188, 188, 188, 255}, 4);
    }
    return out->texels ? TYN_OK : TYN_ERR_MEMORY;
}

// A file that is not there gives a grey one, and *missing.
static tyn_result read_image(const gltf_data *data, const cJSON *image, tyn_texture *out,
                             bool *missing)
{
    const cJSON *uri = tyn_json_member(image, "uri"), *view = tyn_json_member(image, "bufferView");
    void *bytes;
    size_t size;
    if (view) {
        const uint8_t *in_view = tyn_gltf_view_bytes(data, (int64_t)view->valuedouble, &size);
        return decode(data, image, in_view, size, out);
    }
    if (strncmp(uri->valuestring, "data:", 5) != 0) {
        TYN_TRY(tyn_uri_read(data->doc, uri, &bytes, &size, missing));
    } else if (!tyn_gltf_data_uri(uri->valuestring, &bytes, &size)) {
        return tyn_json_fault(data->doc, uri, "must be base64 data of a PNG or JPEG picture");
    }
    if (!bytes) {
        return grey(out);
    }
    tyn_result r = decode(data, uri, bytes, size, out);
    free(bytes);
    return r;
}

// ---- textures ---------------------------------------------------------------------------------

static tyn_wrap wrap_mode(const cJSON *sampler, const char *name)
{
    const cJSON *at = tyn_json_member(sampler, name);
    const int mode = at ? (int)at->valuedouble : 10497;
    return mode == 33071 ? TYN_WRAP_CLAMP : mode == 33648 ? TYN_WRAP_MIRROR : TYN_WRAP_REPEAT;
}

static tyn_result read_texture(const gltf_textures *t, int64_t index, tyn_texture *out)
{
    const cJSON *texture = t->textures->items[index], *source = tyn_json_member(texture, "source");
    const cJSON *sampler = tyn_json_member(texture, "sampler");
    *out = (tyn_texture){0};
    if (!source && !tyn_json_member(texture, "extensions")) {
        return tyn_json_fault(t->data->doc, texture, "source is missing: an index of images");
    }
    if (!source) {
        t->missing[index] = true; // it may be what an extension reads
        return grey(out);
    }
    if (sampler) {
        const cJSON *modes = t->samplers->items[(int64_t)sampler->valuedouble];
        out->wrap[0] = wrap_mode(modes, "wrapS");
        out->wrap[1] = wrap_mode(modes, "wrapT");
    }
    return read_image(t->data, t->images->items[(int64_t)source->valuedouble], out,
                      &t->missing[index]);
}

static int64_t texture_index(const cJSON *info)
{
    return (int64_t)tyn_json_member(info, "index")->valuedouble;
}

tyn_result tyn_gltf_texture_get(gltf_textures *t, const cJSON *info, uint32_t *index)
{
    const int64_t from = texture_index(info);
    tyn_surfaces *s = t->surfaces;
    if (t->loaded[from] == TYN_NO_TEXTURE) {
        tyn_texture texture;
        TYN_TRY(read_texture(t, from, &texture));
        tyn_texture *grown = realloc(s->textures, (s->num_textures + 1) * sizeof *grown);
        if (!grown) {
            free(texture.texels);
            return tyn_json_fault(t->data->doc, info, "no memory for its texture");
        }
        texture.name = texture_name(t, t->textures->items[from]);
        s->textures = grown;
        t->loaded[from] = s->num_textures;
        grown[s->num_textures++] = texture;
    }
    *index = t->loaded[from];
    return TYN_OK;
}

tyn_result tyn_gltf_texture_read(gltf_textures *t, const cJSON *info, tyn_texture *out)
{
    return read_texture(t, texture_index(info), out);
}

tyn_result tyn_gltf_texture_mean(gltf_textures *t, const cJSON *info, int channel, double *mean)
{
    tyn_texture texture;
    TYN_TRY(read_texture(t, texture_index(info), &texture));
    const size_t texels = (size_t)texture.size[0] * texture.size[1];
    uint64_t histogram[256] = {0};
    for (size_t i = 0; i < texels; i++) {
        histogram[texture.texels[4 * i + (size_t)channel]]++;
    }
    *mean = 0;
    for (int v = 0; v < 256; v++) {
        *mean += v / 255.0 * (double)histogram[v] / (double)texels;
    }
    free(texture.texels);
    return TYN_OK;
}
