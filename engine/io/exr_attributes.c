// exr_attributes.c -- what an EXR file says of its image beside the pixels: text, numbers, matrices, primaries.
#include "io/exr_attributes.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_ATTRIBUTES = 256 }; // that are read of a file

static const struct {
    exr_attribute_type_t type;
    tyn_attribute_kind kind;
    int count; // of floats
} kinds[] = {
    {EXR_ATTR_STRING, TYN_ATTRIBUTE_TEXT, 0},
    {EXR_ATTR_INT, TYN_ATTRIBUTE_INTEGER, 1},
    {EXR_ATTR_FLOAT, TYN_ATTRIBUTE_NUMBER, 1},
    {EXR_ATTR_M44F, TYN_ATTRIBUTE_MATRIX, 16},
    {EXR_ATTR_CHROMATICITIES, TYN_ATTRIBUTE_CHROMATICITIES, 8},
};
enum { NUM_KINDS = sizeof kinds / sizeof *kinds };

// Of these every file has its own.
static const char *const required[] = {"pixelAspectRatio", "screenWindowWidth", "name", "type",
                                       "version",          "chunkCount"};

static bool is_required(const char *name)
{
    for (size_t i = 0; i < sizeof required / sizeof *required; i++) {
        if (strcmp(name, required[i]) == 0) {
            return true;
        }
    }
    return false;
}

// ---- in memory --------------------------------------------------------------------------------

const tyn_attribute *tyn_image_file_attribute(const tyn_image_file *image, const char *name)
{
    for (uint32_t i = 0; image && name && i < image->num_attributes; i++) {
        if (strcmp(image->attributes[i].name, name) == 0) {
            return &image->attributes[i];
        }
    }
    return NULL;
}

const char *tyn_image_file_text(const tyn_image_file *image, const char *name)
{
    const tyn_attribute *a = tyn_image_file_attribute(image, name);
    return a && a->kind == TYN_ATTRIBUTE_TEXT ? a->text : NULL;
}

// The attribute of that name, made if it is not there, without a value. NULL: no memory, or the name is too long.
static tyn_attribute *make_attribute(tyn_image_file *image, const char *name)
{
    for (uint32_t i = 0; i < image->num_attributes; i++) {
        if (strcmp(image->attributes[i].name, name) == 0) {
            free(image->attributes[i].text);
            image->attributes[i].text = NULL;
            return &image->attributes[i];
        }
    }
    tyn_attribute *grown =
        strlen(name) < sizeof grown->name
            ? realloc(image->attributes, (image->num_attributes + 1) * sizeof *image->attributes)
            : NULL;
    if (!grown) {
        return NULL;
    }
    image->attributes = grown;
    tyn_attribute *a = &grown[image->num_attributes++];
    *a = (tyn_attribute){0};
    snprintf(a->name, sizeof a->name, "%s", name);
    return a;
}

static bool set_text(tyn_image_file *image, const char *name, const char *text, size_t length)
{
    char *copy = calloc(length + 1, 1);
    tyn_attribute *a = copy ? make_attribute(image, name) : NULL;
    if (!a) {
        free(copy);
        return false;
    }
    memcpy(copy, text, length);
    a->kind = TYN_ATTRIBUTE_TEXT;
    a->text = copy;
    return true;
}

bool tyn_image_file_set_text(tyn_image_file *image, const char *name, const char *text)
{
    return image && name && text && set_text(image, name, text, strlen(text));
}

bool tyn_image_file_set_numbers(tyn_image_file *image, const char *name, tyn_attribute_kind kind,
                                const double *values)
{
    tyn_attribute *a =
        image && name && values && kind != TYN_ATTRIBUTE_TEXT && (unsigned)kind < NUM_KINDS
            ? make_attribute(image, name)
            : NULL;
    if (a) {
        a->kind = kind;
        memcpy(a->values, values, (size_t)kinds[kind].count * sizeof *values);
    }
    return a != NULL;
}

// ---- in files ---------------------------------------------------------------------------------

// False: no memory.
static bool take(tyn_image_file *image, const exr_attribute_t *from, int kind)
{
    double values[16] = {0};
    float floats[16] = {0};
    switch (kinds[kind].type) {
    case EXR_ATTR_STRING:
        return set_text(image, from->name, from->string->length > 0 ? from->string->str : "",
                        from->string->length > 0 ? (size_t)from->string->length : 0);
    case EXR_ATTR_INT:
        values[0] = from->i;
        return tyn_image_file_set_numbers(image, from->name, kinds[kind].kind, values);
    case EXR_ATTR_FLOAT:
        floats[0] = from->f;
        break;
    case EXR_ATTR_M44F:
        memcpy(floats, from->m44f, sizeof *from->m44f);
        break;
    default:
        memcpy(floats, from->chromaticities, sizeof *from->chromaticities);
        break;
    }
    for (int i = 0; i < kinds[kind].count; i++) {
        values[i] = (double)floats[i];
    }
    return tyn_image_file_set_numbers(image, from->name, kinds[kind].kind, values);
}

tyn_result tyn_exr_read_attributes(exr_context_t context, tyn_image_file *image)
{
    int32_t count = 0;
    if (exr_get_screen_window_width(context, 0, &image->screen_width) != EXR_ERR_SUCCESS) {
        image->screen_width = 1;
    }
    if (exr_get_attribute_count(context, 0, &count) != EXR_ERR_SUCCESS) {
        return TYN_OK; // nothing to tell
    }
    for (int32_t i = 0; i < count && image->num_attributes < MAX_ATTRIBUTES; i++) {
        const exr_attribute_t *a = NULL;
        if (exr_get_attribute_by_index(context, 0, EXR_ATTR_LIST_FILE_ORDER, i, &a) !=
                EXR_ERR_SUCCESS ||
            is_required(a->name) || strlen(a->name) >= sizeof image->attributes->name) {
            continue;
        }
        const double envmap = a->uc; // how directions lie in a map, an integer here
        if (a->type == EXR_ATTR_ENVMAP &&
            !tyn_image_file_set_numbers(image, a->name, TYN_ATTRIBUTE_INTEGER, &envmap)) {
            return TYN_ERR_MEMORY;
        }
        for (int k = 0; k < NUM_KINDS; k++) {
            if (kinds[k].type == a->type && !take(image, a, k)) {
                return TYN_ERR_MEMORY;
            }
        }
    }
    return TYN_OK;
}

static exr_result_t write_attribute(exr_context_t context, const tyn_attribute *a)
{
    exr_attr_m44f_t matrix;
    exr_attr_chromaticities_t c;
    float floats[16];
    for (int i = 0; i < 16; i++) {
        floats[i] = (float)a->values[i];
    }
    memcpy(&matrix, floats, sizeof matrix);
    memcpy(&c, floats, sizeof c);
    switch (a->kind) {
    case TYN_ATTRIBUTE_TEXT:
        return exr_attr_set_string(context, 0, a->name, a->text ? a->text : "");
    case TYN_ATTRIBUTE_INTEGER:
        if (strcmp(a->name, "envmap") == 0) {
            return exr_attr_set_envmap(context, 0, a->name, (exr_envmap_t)a->values[0]);
        }
        return exr_attr_set_int(context, 0, a->name, (int32_t)a->values[0]);
    case TYN_ATTRIBUTE_NUMBER:
        return exr_attr_set_float(context, 0, a->name, (float)a->values[0]);
    case TYN_ATTRIBUTE_MATRIX:
        return exr_attr_set_m44f(context, 0, a->name, &matrix);
    case TYN_ATTRIBUTE_CHROMATICITIES:
        return exr_attr_set_chromaticities(context, 0, a->name, &c);
    }
    return EXR_ERR_INVALID_ARGUMENT;
}

exr_result_t tyn_exr_write_attributes(exr_context_t context, const tyn_image_file *image)
{
    exr_result_t e = image->screen_width > 0
                         ? exr_set_screen_window_width(context, 0, image->screen_width)
                         : EXR_ERR_SUCCESS;
    for (uint32_t i = 0; !e && i < image->num_attributes; i++) {
        e = write_attribute(context, &image->attributes[i]);
    }
    return e;
}
